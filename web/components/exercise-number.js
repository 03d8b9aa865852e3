/** The body of an exercise that asks for numbers: a field each, with its feedback beneath. */

/** @import {LabExercise, LabField, Verdict} from "../core/lab/types.js" */

import { h, set, uniqueId } from "./dom.js";
import { showMath } from "./mathml.js";
import { showHtml } from "./rich-text.js";

/** @param {LabExercise} exercise @param {{onEdit: () => void}} context */
export function numberBody({ fields = [] }, { onEdit }) {
  const rows = fields.map((field) => row(field, onEdit));
  return {
    element: h("div", { class: "answer-fields" }, ...rows.map(({ element }) => element)),
    answer: () => Object.fromEntries(rows.map(({ id, input }) => [id, input.value.trim()])),
    /** @param {any} answer */
    restore(answer) {
      for (const { id, input } of rows) input.value = String(answer?.[id] ?? "");
    },
    /** @param {Verdict} verdict */
    show({ status, checks, feedback_html }) {
      for (const { id, input, said } of rows) {
        const check = checks.find(({ name }) => name === id);
        const wrong = check ? !check.passed : status === "blank";
        set(input, { "aria-invalid": wrong ? "true" : null });
        said.className = `answer-said ${check ? (check.passed ? "right" : "wrong") : status}`;
        // All blank: one word at the first field is enough.
        showHtml(said, check ? check.feedback_html : id === rows[0]?.id ? feedback_html : "");
      }
    },
    clear() {
      for (const { input, said } of rows) {
        set(input, { "aria-invalid": null });
        said.replaceChildren();
      }
    },
    focus: () => (rows.find(({ input }) => input.getAttribute("aria-invalid")) ?? rows[0])?.input.focus(),
  };
}

/** @param {LabField} field @param {() => void} onEdit */
function row({ id, label, symbol_mathml, unit, tolerance_text }, onEdit) {
  const inputId = uniqueId("answer");
  const saidId = uniqueId("said");
  const tolerance = h("small", { class: "tolerance", id: uniqueId("tolerance") }, tolerance_text);
  const input = h("input", {
    type: "text",
    inputmode: "decimal",
    id: inputId,
    name: id,
    autocomplete: "off",
    spellcheck: "false",
    maxlength: 60,
    "aria-describedby": `${tolerance.id} ${saidId}`,
    "aria-label": label + (unit ? `, in ${unit}` : ""),
    oninput: onEdit,
  });
  const symbol = h("span", { class: "answer-symbol", "aria-hidden": "true" });
  if (symbol_mathml) showMath(symbol, symbol_mathml);
  const said = h("div", { class: "answer-said", id: saidId, "aria-live": "polite" });
  const element = h(
    "div",
    { class: "answer-field" },
    h("label", { for: inputId }, label, symbol_mathml ? " " : "", symbol_mathml ? symbol : ""),
    h("span", { class: "field-box" }, input, unit ? h("span", { class: "field-unit", "aria-hidden": "true" }, unit) : null),
    tolerance,
    said,
  );
  return { id, input, said, element };
}
