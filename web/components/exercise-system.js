/** The body of an exercise that asks for a transfer function: typed, typeset as it is understood, compared as a system. */

/** @import {LabExercise, Verdict} from "../core/lab/types.js" */

import { h, set, uniqueId } from "./dom.js";
import { showMath } from "./mathml.js";
import { showHtml } from "./rich-text.js";

const TYPING_MS = 250;

/**
 * @param {LabExercise} exercise
 * @param {{onEdit: () => void, typeset: (text: string) => Promise<string | null>}} context
 */
export function systemBody({ symbol_mathml, tolerance_text }, { onEdit, typeset }) {
  const saidId = uniqueId("said");
  const input = h("input", {
    type: "text",
    class: "expression",
    id: uniqueId("answer"),
    autocomplete: "off",
    autocapitalize: "off",
    spellcheck: "false",
    maxlength: 500,
    "aria-describedby": saidId,
    "aria-label": "Transfer function in s",
    oninput: () => {
      onEdit();
      previewSoon();
    },
  });
  const symbol = h("span", { class: "answer-symbol" });
  if (symbol_mathml) showMath(symbol, symbol_mathml);
  const preview = h("div", { class: "system-preview", "aria-live": "off" });
  const said = h("div", { class: "answer-said", id: saidId, "aria-live": "polite" });
  const facts = h("ul", { class: "facts-found" });

  let timer = 0;
  let asked = 0;
  function previewSoon() {
    clearTimeout(timer);
    timer = window.setTimeout(() => void showPreview(), TYPING_MS);
  }
  async function showPreview() {
    const now = ++asked;
    const text = input.value.trim();
    const mathml = text === "" ? null : await typeset(text);
    if (now === asked) showMath(preview, mathml);
  }

  return {
    element: h(
      "div",
      { class: "system-answer" },
      h("label", { for: input.id }, symbol_mathml ? symbol : "Transfer function", symbol_mathml ? h("span", { "aria-hidden": "true" }, " =") : ""),
      h("div", { class: "system-input" }, input, h("div", { class: "system-under" }, preview, h("small", { class: "tolerance" }, tolerance_text ?? ""))),
      said,
      facts,
    ),
    answer: () => input.value.trim(),
    /** @param {any} answer */
    restore(answer) {
      input.value = typeof answer === "string" ? answer : "";
      void showPreview();
    },
    /** @param {Verdict} verdict */
    show({ status, correct, checks, feedback_html }) {
      set(input, { "aria-invalid": correct ? null : "true" });
      said.className = `answer-said ${correct ? "right" : status}`;
      showHtml(said, feedback_html);
      facts.replaceChildren(...(correct ? [] : checks.map(({ passed, text }) => h("li", { class: passed ? "right" : "wrong" }, text))));
    },
    clear() {
      set(input, { "aria-invalid": null });
      said.replaceChildren();
      facts.replaceChildren();
    },
    focus: () => input.focus(),
  };
}
