/** One route of the API: what it does, what it takes, and a place to try it. */

/** @import {ApiRoute} from "../core/openapi.js" */

import { asCurl, asPython } from "../core/openapi.js";
import { h, uniqueId } from "./dom.js";
import "./segmented-control.js";
import { toast } from "./status-toast.js";

const MOST_SHOWN = 20000;

/** @param {ApiRoute} route @returns {HTMLElement} */
export function apiRoute(route) {
  const { id, method, path, summary, description, fields, examples } = route;
  const open = !path.includes("{");
  return h(
    "section",
    { class: "api-route", id, "aria-label": `${method} ${path}` },
    h("h2", {}, h("span", { class: `method method-${method.toLowerCase()}` }, method), h("code", {}, path)),
    h("p", { class: "api-summary" }, summary),
    ...paragraphs(description),
    fields.length > 0 ? fieldTable(route) : null,
    method === "POST" ? trial(route, JSON.stringify(examples[0]?.value ?? {}, null, 2), open) : trial(route, "", open),
  );
}

/** Paragraphs of the description, with `code` in them set as code. @param {string} text */
function paragraphs(text) {
  return text
    .split(/\n\s*\n/)
    .filter((part) => part.trim())
    .map((part) => h("p", {}, ...part.split("`").map((piece, i) => (i % 2 ? h("code", {}, piece) : piece))));
}

/** @param {ApiRoute} route */
function fieldTable({ fields, path }) {
  const head = ["Field", "Type", "If left out", "Meaning"].map((name) => h("th", { scope: "col" }, name));
  const rows = fields.map(({ name, type, fallback, description }) =>
    h("tr", {}, h("th", { scope: "row" }, h("code", {}, name)), h("td", {}, type), h("td", {}, fallback), h("td", {}, description.split("\n\n")[0] ?? "")),
  );
  return h(
    "div",
    { class: "api-fields", tabindex: 0, role: "region", "aria-label": `Fields of ${path}` },
    h("table", {}, h("thead", {}, h("tr", {}, ...head)), h("tbody", {}, ...rows)),
  );
}

/** @param {ApiRoute} route @param {string} example @param {boolean} sendable */
function trial(route, example, sendable) {
  const boxId = uniqueId("api-body");
  const box = h("textarea", { id: boxId, spellcheck: "false", rows: Math.min(18, example.split("\n").length + 1) });
  box.value = example;
  const code = h("pre", { tabindex: 0, role: "region", "aria-label": `Code for ${route.path}` });
  const language = h("segmented-control", { label: "Language", class: "small" });
  language.options = [
    { value: "curl", label: "curl" },
    { value: "python", label: "Python" },
  ];
  language.value = "curl";
  const answer = h("pre", { class: "api-answer", tabindex: 0, role: "region", "aria-label": `Answer of ${route.path}`, hidden: true });
  const status = h("span", { class: "api-status", role: "status" });
  const send = h("button", { type: "button", class: "button primary" }, "Send");
  const copy = h("button", { type: "button", class: "button" }, "Copy");

  function showCode() {
    code.textContent = (language.value === "curl" ? asCurl : asPython)(route, box.value, location.origin);
  }
  box.addEventListener("input", showCode);
  language.addEventListener("value-change", showCode);
  copy.addEventListener("click", () => {
    navigator.clipboard.writeText(code.textContent ?? "").then(
      () => toast().say("Code copied."),
      () => toast().say("The browser does not allow copying."),
    );
  });
  send.addEventListener("click", async () => {
    send.disabled = true;
    const since = performance.now();
    try {
      const request = route.method === "POST" ? { method: "POST", headers: { "Content-Type": "application/json" }, body: box.value } : {};
      const response = await fetch(route.path, request);
      const text = await response.text();
      status.textContent = `${response.status} ${response.statusText}, ${text.length} bytes in ${Math.round(performance.now() - since)} ms`;
      answer.textContent = pretty(text);
    } catch {
      status.textContent = "The server cannot be reached.";
      answer.textContent = "";
    }
    answer.hidden = answer.textContent === "";
    send.disabled = false;
  });
  showCode();
  return h(
    "div",
    { class: "api-trial" },
    route.method === "POST" ? h("label", { for: boxId }, "Request") : null,
    route.method === "POST" ? box : null,
    h("div", { class: "row" }, sendable ? send : null, status),
    answer,
    h("div", { class: "row spread" }, language, copy),
    code,
  );
}

/** @param {string} text */
function pretty(text) {
  try {
    const whole = JSON.stringify(JSON.parse(text), null, 2).replace(/\[\s+(-?[\d.][^[\]{}"]*?)\s+\]/g, (_, numbers) => `[${numbers.replace(/\s+/g, " ")}]`);
    return whole.length > MOST_SHOWN ? `${whole.slice(0, MOST_SHOWN)}\n… ${whole.length - MOST_SHOWN} more characters` : whole;
  } catch {
    return text;
  }
}
