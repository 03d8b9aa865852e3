/** Fields of a form that keep their value until it is asked for. */

import { h } from "./dom.js";
import "./number-field.js";
import "./segmented-control.js";
import { createSelectField } from "./select-field.js";

/**
 * @param {string} label
 * @param {{value: string, label: string}[]} choices
 * @param {() => void} onChange
 */
export function choice(label, choices, onChange) {
  let value = choices[0]?.value ?? "";
  const field = createSelectField({
    label,
    groups: [{ label: null, choices }],
    onChoice(next) {
      value = next;
      onChange();
    },
  });
  return {
    root: field.root,
    get value() {
      return value;
    },
    set value(next) {
      value = next;
      field.show(next);
    },
  };
}

/**
 * @param {string} label
 * @param {{value: number | null, unit?: string, min?: number, above?: number, optional?: boolean}} options
 * @param {() => void} onChange
 */
export function number(label, { value, unit, min, above, optional = false }, onChange) {
  const field = document.createElement("number-field");
  for (const [key, text] of Object.entries({ label, unit: unit || undefined, min, above })) if (text !== undefined) field.setAttribute(key, String(text));
  if (optional) field.setAttribute("optional", "");
  field.value = value;
  field.addEventListener("value-change", onChange);
  return field;
}

/** Fields side by side where there is room. @param {...(HTMLElement | null)} fields */
export function fieldRow(...fields) {
  return h("div", { class: "field-row" }, ...fields);
}
