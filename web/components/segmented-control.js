/**
 * `<segmented-control label="...">`: one of a few, all in sight. Radio buttons underneath, so arrow keys work.
 * Set `options` once; property `value`; event "value-change" with detail `{value}`.
 */

import { h, uniqueId } from "./dom.js";

/** @typedef {{value: string, label: string | Node, title?: string}} SegmentOption */

export class SegmentedControl extends HTMLElement {
  #group = uniqueId("segment");
  #value = "";

  connectedCallback() {
    this.setAttribute("role", "radiogroup");
    if (this.hasAttribute("label")) this.setAttribute("aria-label", this.getAttribute("label") ?? "");
  }

  /** @param {SegmentOption[]} options */
  set options(options) {
    this.replaceChildren(
      ...options.map(({ value, label, title }) => {
        // Who steers by voice says the word in sight: the name begins with it.
        const name = title && typeof label === "string" && !title.toLowerCase().startsWith(label.toLowerCase()) ? `${label}: ${title}` : title;
        const input = h("input", { type: "radio", name: this.#group, value, "aria-label": name });
        input.addEventListener("change", () => {
          this.#value = value;
          this.dispatchEvent(new CustomEvent("value-change", { bubbles: true, detail: { value } }));
        });
        return h("label", { title }, input, h("span", {}, label));
      }),
    );
    this.value = this.#value;
  }

  get value() {
    return this.#value;
  }
  set value(value) {
    this.#value = value;
    for (const input of this.querySelectorAll("input")) input.checked = input.value === value;
  }
}

customElements.define("segmented-control", SegmentedControl);
