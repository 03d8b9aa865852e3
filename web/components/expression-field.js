/**
 * A transfer function typed as text: tells its text when the typing rests, and shows what is wrong with it and where.
 * One visit to the field is one run of changes, for undo.
 */

import { sentence } from "../core/format.js";
import { h, set, setText } from "./dom.js";

const TYPING_MS = 250;
const MAX_TEXT = 500;

/**
 * @typedef {object} ExpressionField
 * @property {HTMLElement} root
 * @property {(text: string) => void} show  the text of the design; what is being typed is left alone
 * @property {(error: any) => void} complain  an error of the server, or null
 * @property {() => void} dispose
 */

/**
 * @param {{id: string, symbol: string, hint: string, commit: (text: string, run: string) => void}} options
 * @returns {ExpressionField}
 */
export function createExpressionField({ id, symbol, hint: words, commit }) {
  const input = h("input", { type: "text", id, class: "expression", maxlength: MAX_TEXT, autocomplete: "off", autocapitalize: "off", spellcheck: "false", "aria-describedby": `${id}-error ${id}-hint` });
  const caret = h("span", { class: "caret-line", "aria-hidden": "true" });
  const message = h("p", { class: "field-message", id: `${id}-error`, role: "alert" });
  const hint = h("p", { class: "field-hint", id: `${id}-hint` }, words);
  const root = h("div", { class: "expression-field" }, h("label", { for: id }, h("i", {}, symbol), "(s) ="), h("div", { class: "expression-box" }, input, caret), message, hint);

  let typing = 0;
  let typed = "";
  let visits = 0;
  let run = "";

  function take() {
    clearTimeout(typing);
    if (input.value === typed) return;
    typed = input.value;
    commit(input.value, run);
  }
  input.addEventListener("input", () => {
    clearTimeout(typing);
    typing = window.setTimeout(take, TYPING_MS);
  });
  input.addEventListener("change", take);
  input.addEventListener("focus", () => {
    run = `${id}-${(visits += 1)}`;
  });

  return {
    root,
    show(text) {
      if (text === typed && document.activeElement === input) return;
      typed = text;
      if (input.value !== text) input.value = text;
    },
    complain(error) {
      set(input, { "aria-invalid": error ? "true" : null });
      setText(message, error ? [error.message, error.hint].map(sentence).filter(Boolean).join(" ") : "");
      const column = error?.column ?? null;
      setText(caret, column === null ? "" : `${"\u00a0".repeat(Math.max(0, column - 1))}▲`);
      hint.hidden = Boolean(error);
    },
    dispose: () => clearTimeout(typing),
  };
}
