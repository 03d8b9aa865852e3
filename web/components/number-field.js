/**
 * `<number-field>`: a typed number with its symbol, unit and limits.
 *
 * Attributes: `name` (of the nomenclature), `label` (where there is no symbol for it), `unit`, `min`, `max`,
 * `above` (an open lower limit), `optional` (may be left empty). Property `value`, a number or null.
 * Events: "value-input" while it is typed and good, "value-change" when it is done; both bubble, detail `{value}`.
 */

import { parseNumber, toInput } from "../core/format.js";
import { h, uniqueId } from "./dom.js";
import { symbol, SYMBOLS } from "./symbol.js";

export class NumberField extends HTMLElement {
  /** @type {number | null} */
  #value = null;
  #input = h("input", { type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", id: uniqueId("number") });
  #message = h("span", { class: "field-message", id: uniqueId("number-message") });
  /** What has been told already, so that leaving the field unchanged is no change. @type {number | null} */
  #told = null;

  connectedCallback() {
    if (this.#input.isConnected) return;
    const name = this.getAttribute("name") ?? "";
    const unit = this.getAttribute("unit");
    const label = this.getAttribute("label");
    this.#input.setAttribute("aria-label", (label ?? SYMBOLS[name]?.spoken ?? name) + (unit ? `, in ${unit}` : ""));
    this.#input.setAttribute("aria-describedby", this.#message.id);
    if (this.hasAttribute("placeholder")) this.#input.placeholder = this.getAttribute("placeholder") ?? "";
    this.append(
      h("label", { for: this.#input.id, class: "field-label" }, label ?? symbol(name)),
      h("span", { class: "field-box" }, this.#input, unit ? h("span", { class: "field-unit", "aria-hidden": "true" }, unit) : null),
      this.#message,
    );
    this.#input.addEventListener("input", () => this.#typed());
    this.#input.addEventListener("change", () => this.#done());
    this.#input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.#done();
      if (event.key === "Escape") this.#show();
    });
    this.#input.addEventListener("focus", () => this.#input.select());
    this.#show();
  }

  get value() {
    return this.#value;
  }
  set value(value) {
    // The echo of what is being typed is no news: that it is done has still to be told.
    if (value !== this.#value) this.#told = value;
    this.#value = value;
    // Never rewrite what someone is typing.
    if (document.activeElement !== this.#input || this.#parsed().value !== value) this.#show();
  }

  #show() {
    const text = this.#value === null ? "" : toInput(this.#value);
    if (this.#input.value !== text) this.#input.value = text;
    this.#complain("");
  }

  /** @returns {{value: number | null, wrong: string}} */
  #parsed() {
    const text = this.#input.value;
    if (text.trim() === "") {
      return this.hasAttribute("optional") ? { value: null, wrong: "" } : { value: null, wrong: "Type a number." };
    }
    const value = parseNumber(text);
    if (value === null) return { value: null, wrong: "Not a number: type it like 0.5 or 2e-3." };
    const min = this.#limit("min");
    const max = this.#limit("max");
    const above = this.#limit("above");
    if (above !== null && value <= above) return { value: null, wrong: `Must be above ${toInput(above)}.` };
    if (min !== null && value < min) return { value: null, wrong: `Must be at least ${toInput(min)}.` };
    if (max !== null && value > max) return { value: null, wrong: `Must be at most ${toInput(max)}.` };
    return { value, wrong: "" };
  }

  /** @param {string} name */
  #limit(name) {
    const text = this.getAttribute(name);
    return text === null ? null : Number(text);
  }

  #typed() {
    const { value, wrong } = this.#parsed();
    this.#complain(wrong);
    if (wrong || value === this.#value) return;
    this.#value = value;
    this.dispatchEvent(new CustomEvent("value-input", { bubbles: true, detail: { value } }));
  }

  #done() {
    const { value, wrong } = this.#parsed();
    this.#complain(wrong);
    if (wrong || value === this.#told) return;
    this.#value = value;
    this.#told = value;
    this.dispatchEvent(new CustomEvent("value-change", { bubbles: true, detail: { value } }));
  }

  /** @param {string} text */
  #complain(text) {
    if (this.#message.textContent !== text) this.#message.textContent = text;
    if (text) this.#input.setAttribute("aria-invalid", "true");
    else this.#input.removeAttribute("aria-invalid");
  }
}

customElements.define("number-field", NumberField);
