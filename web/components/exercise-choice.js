/** The body of an exercise that offers answers to choose from; the feedback stands under the one that was picked. */

/** @import {LabExercise, Verdict} from "../core/lab/types.js" */

import { h, uniqueId } from "./dom.js";
import { showHtml } from "./rich-text.js";

/** @param {LabExercise} exercise @param {{onEdit: () => void}} context */
export function choiceBody({ title, options = [], several = false }, { onEdit }) {
  const group = uniqueId("choice");
  const rows = options.map(({ id, html }) => {
    const input = h("input", { type: several ? "checkbox" : "radio", name: group, value: id, onchange: onEdit });
    const words = h("span", { class: "option-text" });
    showHtml(words, html);
    const element = h("li", {}, h("label", { class: "option" }, input, words));
    return { id, input, element };
  });
  const said = h("div", { class: "answer-said", "aria-live": "polite" });
  const list = h("ul", { class: "options" }, ...rows.map(({ element }) => element));
  const picked = () => rows.filter(({ input }) => input.checked).map(({ id }) => id);
  const mark = (/** @type {string} */ kind) => {
    for (const { element, input } of rows) element.className = input.checked ? kind : "";
  };
  return {
    element: h("fieldset", { class: "choice" }, h("legend", { class: "visually-hidden" }, title), list, said),
    answer: () => (several ? picked() : (picked()[0] ?? null)),
    /** @param {any} answer */
    restore(answer) {
      for (const { id, input } of rows) input.checked = Array.isArray(answer) ? answer.includes(id) : answer === id;
    },
    /** @param {Verdict} verdict */
    show({ status, correct, feedback_html }) {
      mark(correct ? "right" : "wrong");
      said.className = `answer-said ${correct ? "right" : status}`;
      showHtml(said, feedback_html);
      // One picked answer has its feedback right beneath it; several share the end of the list.
      const holder = several ? null : rows.find(({ input }) => input.checked)?.element;
      if (holder) holder.append(said);
      else list.after(said);
    },
    clear() {
      mark("");
      said.replaceChildren();
    },
    focus: () => rows[0]?.input.focus(),
  };
}
