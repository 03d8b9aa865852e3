/** One of several, in a list that opens; native, so that keys, screen readers and phones know it. */

import { h, uniqueId } from "./dom.js";

/** @typedef {{value: string, label: string}} Choice */

/**
 * @param {{label: string, groups: {label: string | null, choices: Choice[]}[], onChoice: (value: string) => void}} options  a group without a label lies open
 */
export function createSelectField({ label, groups, onChoice }) {
  const id = uniqueId("select");
  const select = h(
    "select",
    { id },
    ...groups.flatMap(({ label: name, choices }) => {
      const entries = choices.map((choice) => h("option", { value: choice.value }, choice.label));
      return name === null ? entries : [h("optgroup", { label: name }, ...entries)];
    }),
  );
  select.addEventListener("change", () => onChoice(select.value));
  const root = h("div", { class: "select-field" }, h("label", { for: id, class: "field-label" }, label), select);
  return {
    root,
    /** @param {string} value */
    show(value) {
      if (select.value !== value) select.value = value;
    },
  };
}
