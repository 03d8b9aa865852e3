/** A field for a list of numbers: told when it is done and good, complains below itself when it is not. */

import { listText, parseList } from "../core/lists.js";
import { h, set, setText, uniqueId } from "./dom.js";

/**
 * @param {{label: string, hint?: string, placeholder?: string, optional?: boolean, check?: (values: number[]) => string, onValues: (values: number[]) => void}} options
 */
export function createListField({ label, hint, placeholder, optional = false, check = () => "", onValues }) {
  const message = h("span", { class: "field-message", id: uniqueId("list-message") });
  const input = h("input", { type: "text", id: uniqueId("list"), class: "list-input", autocomplete: "off", autocapitalize: "off", spellcheck: "false", placeholder, "aria-describedby": message.id, title: hint });
  const root = h("div", { class: "list-field" }, h("label", { for: input.id, class: "field-label" }, label), input, message);
  let told = "";

  function done() {
    const values = parseList(input.value);
    const wrong = values === null ? "Type numbers, separated by commas or spaces." : values.length === 0 && !optional ? "Type at least one number." : check(values);
    setText(message, wrong);
    set(input, { "aria-invalid": wrong ? "true" : null });
    if (wrong || values === null || JSON.stringify(values) === told) return;
    told = JSON.stringify(values);
    onValues(values);
  }
  input.addEventListener("change", done);
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") done();
  });

  return {
    root,
    /** @param {number[]} values */
    show(values) {
      const now = JSON.stringify(values);
      if (now === told && document.activeElement === input) return;
      if (now !== told || input.value === "") input.value = listText(values);
      told = now;
      setText(message, "");
      set(input, { "aria-invalid": null });
    },
  };
}
