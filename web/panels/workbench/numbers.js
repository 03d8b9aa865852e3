/** Margins and metrics as a table; what does not exist shows a dash and says why. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { MARGIN_FIELDS, MEANING, METRIC_FIELDS, PLOT_HELP } from "../../core/explain.js";
import { formatFixed, formatNumber } from "../../core/format.js";
import { toCsv } from "../../core/csv.js";
import { download } from "../../components/data-table.js";
import { h, setText } from "../../components/dom.js";
import { attachHint } from "../../components/hint.js";
import { icon } from "../../components/icons.js";
import { termHead, valueCell } from "../../components/value-cell.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  /** @type {Map<string, ReturnType<typeof valueCell>>} */
  const cells = new Map();
  /** @param {string} key */
  const cell = (key) => {
    const made = valueCell();
    cells.set(key, made);
    return made.root;
  };
  /** @param {string} field */
  const unit = (field) => h("td", { class: "unit", "data-unit": MEANING[field]?.unit ?? "" });

  const margins = h(
    "table",
    { class: "numbers" },
    h("caption", {}, "Margins of the open loop"),
    h("tbody", {}, ...MARGIN_FIELDS.map((field) => h("tr", {}, termHead(field), cell(`margin.${field}`), unit(field)))),
  );
  const metrics = h(
    "table",
    { class: "numbers" },
    h("caption", {}, "Step responses"),
    h("thead", {}, h("tr", {}, h("td"), h("th", { scope: "col" }, "Setpoint"), h("th", { scope: "col" }, "Load"), h("td"))),
    h("tbody", {}, ...METRIC_FIELDS.map((field) => h("tr", {}, termHead(field), cell(`setpoint.${field}`), cell(`load.${field}`), unit(field)))),
  );
  const help = h("button", { type: "button", class: "icon-button", "aria-label": "How to read the numbers" }, icon("help"));
  const save = h("button", { type: "button", class: "icon-button", "aria-label": "Download the numbers as CSV", title: "Download" }, icon("download"));
  const expand = h("button", { type: "button", class: "icon-button expand", "aria-label": "Enlarge Numbers", title: "Enlarge" }, icon("expand"));
  const root = h(
    "section",
    { class: "panel numbers-panel", id: "panel-numbers", "aria-label": "Numbers" },
    h("header", { class: "panel-header" }, h("h2", {}, "Numbers"), h("div", { class: "panel-tools" }, help, save, expand)),
    h("div", { class: "numbers-body" }, margins, metrics),
  );
  host.append(root);
  attachHint(help, () => ({ title: "Numbers", text: PLOT_HELP["numbers"] ?? "" }));
  save.addEventListener("click", () => download("looplab-numbers.csv", toCsv(table())));
  expand.addEventListener("click", () => root.dispatchEvent(new CustomEvent("panel-expand", { bubbles: true, detail: { id: "numbers" } })));

  /** @param {string} field @param {number | null | undefined} value */
  const text = (field, value) => {
    const decimals = MEANING[field]?.decimals;
    return decimals === undefined ? formatNumber(value) : formatFixed(value, decimals);
  };

  function show() {
    root.classList.toggle("stale", answers.error !== null);
    const { margins: m, metrics: s } = answers.panels;
    for (const field of MARGIN_FIELDS) {
      const value = /** @type {Record<string, any>} */ (m ?? {})[field];
      cells.get(`margin.${field}`)?.show(text(field, value), m?.reasons[field] ?? null);
    }
    for (const signal of /** @type {const} */ (["setpoint", "load"])) {
      const values = /** @type {Record<string, any> | undefined} */ (s?.[signal]);
      for (const field of METRIC_FIELDS) cells.get(`${signal}.${field}`)?.show(text(field, values?.[field]), values?.["reasons"][field] ?? null);
    }
    for (const node of root.querySelectorAll(".unit")) {
      setText(node, (node instanceof HTMLElement ? (node.dataset["unit"] ?? "") : "").replace("time", answers.time_unit));
    }
  }

  function table() {
    const { margins: m, metrics: s } = answers.panels;
    const of = (/** @type {any} */ values, /** @type {string} */ field) => values?.[field] ?? null;
    return {
      header: ["what", "value or setpoint step", "load step"],
      rows: [...MARGIN_FIELDS.map((f) => [f, of(m, f), null]), ...METRIC_FIELDS.map((f) => [f, of(s?.setpoint, f), of(s?.load, f)])],
    };
  }

  const release = answers.want(["margins", "metrics"]);
  const stop = answers.subscribe(show);
  show();
  return () => {
    release();
    stop();
    root.remove();
  };
}
