/** The body of a design: what stands on the bench is the answer; each specification is drawn as measured against its limit. */

/** @import {Check, LabExercise, LabSpecification, Settings, Verdict} from "../core/lab/types.js" */

import { h, setText } from "./dom.js";
import { icon } from "./icons.js";
import { showHtml } from "./rich-text.js";

/**
 * @typedef {object} BenchOfDesign
 * @property {() => Settings} settings
 * @property {() => string} inWords
 * @property {(settings: Settings) => void} apply
 * @property {(listener: () => void) => void} onChange
 * @property {() => void} goTo  brings the bench into sight
 */

/** @param {LabExercise} exercise @param {{bench: BenchOfDesign}} context */
export function designBody({ specifications = [] }, { bench }) {
  const now = h("strong", {});
  const rows = specifications.map(row);
  const unstable = h("div", { class: "answer-said" });
  const stale = h("p", { class: "design-stale", hidden: true }, "The bench has changed since. Check again.");
  const said = h("div", { "aria-live": "polite" }, unstable, h("ul", { class: "specifications" }, ...rows.map(({ element }) => element)));
  /** @type {string | null} */
  let checked = null;

  function follow() {
    setText(now, bench.inWords());
    const moved = checked !== null && checked !== JSON.stringify(bench.settings());
    stale.hidden = !moved;
    said.classList.toggle("stale", moved);
  }
  bench.onChange(follow);
  follow();

  return {
    element: h(
      "div",
      { class: "design" },
      h("p", { class: "design-now" }, "On your bench: ", now, " ", h("button", { type: "button", class: "link to-bench", onclick: bench.goTo }, "Go to the bench")),
      said,
      stale,
    ),
    answer: () => bench.settings(),
    /** @param {any} answer  the bench itself remembers where it stood */
    restore(answer) {
      void answer;
    },
    /** @param {Verdict} verdict */
    show({ status, checks, feedback_html }) {
      checked = JSON.stringify(bench.settings());
      const loose = status === "unreadable" || status === "blank" || checks[0]?.passed === false;
      unstable.className = "answer-said wrong";
      showHtml(unstable, loose ? feedback_html : "");
      for (const { name, show } of rows) show(checks.find((check) => check.name === name) ?? null);
      follow();
    },
    clear() {},
    focus: bench.goTo,
  };
}

/** @param {LabSpecification} specification */
function row({ name, relation, limit, text }) {
  const mark = h("span", { class: "spec-mark" });
  const words = h("span", { class: "spec-text" }, capital(text));
  const fill = h("span", { class: "spec-fill" });
  const bar = h("span", { class: `spec-bar ${relation === "<=" ? "at-most" : "at-least"}`, hidden: true, "aria-hidden": "true" }, fill, h("span", { class: "spec-limit" }));
  const said = h("div", { class: "answer-said wrong" });
  const element = h("li", { class: "specification" }, mark, words, bar, said);

  /** @param {Check | null} check */
  function show(check) {
    element.className = `specification ${check ? (check.passed ? "met" : "missed") : ""}`;
    mark.replaceChildren(...(check ? [icon(check.passed ? "stable" : "unstable")] : []));
    setText(words, check ? check.text : capital(text));
    showHtml(said, check?.feedback_html ?? "");
    bar.hidden = check?.measured == null;
    if (check?.measured == null) return;
    // The limit stands at two thirds of the bar, or further left where the value needs the room.
    const span = Math.max(1.5 * Math.abs(limit), 1.05 * Math.abs(check.measured)) || 1;
    bar.style.setProperty("--measured", String(Math.max(0, check.measured) / span));
    bar.style.setProperty("--limit", String(Math.abs(limit) / span));
  }
  return { name, element, show };
}

/** @param {string} text */
function capital(text) {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}
