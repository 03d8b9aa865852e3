/** Rows of figures that explain themselves: what a name means, and why a figure does not exist. */

import { MEANING } from "../core/explain.js";
import { formatAbsent, sentence, UNDEFINED } from "../core/format.js";
import { h, setText } from "./dom.js";
import { attachHint } from "./hint.js";

/**
 * A number with its reason: plain text where it exists, a button that explains where it does not.
 * @returns {{root: HTMLElement, show: (text: string, reason: string | null) => void}}
 */
export function valueCell() {
  const value = h("span", { class: "value" });
  const why = h("button", { type: "button", class: "why", hidden: true });
  const root = h("td", {}, value, why);
  let reason = "";
  const hint = attachHint(why, () => ({ title: "Undefined", text: reason }));
  return {
    root,
    show(figure, because) {
      const text = figure === UNDEFINED ? formatAbsent(because) : figure;
      const absent = figure === UNDEFINED;
      reason = sentence(because ?? "this figure does not exist for this loop");
      setText(value, absent ? "" : text);
      setText(why, text);
      why.hidden = !absent;
      if (absent) hint.describe();
    },
  };
}

/** The name of a figure, which explains itself on hover and focus. @param {string} field */
export function termHead(field) {
  const meaning = MEANING[field];
  const button = h("button", { type: "button", class: "term" }, meaning?.name ?? field);
  const head = h("th", { scope: "row" }, button);
  attachHint(button, () => ({ title: meaning?.name ?? field, text: meaning?.text ?? "" }));
  return head;
}
