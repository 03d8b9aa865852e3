/**
 * `<gain-slider>`: a slider with the same value as a number field beside it.
 *
 * Attributes as `<number-field>`, plus `min` and `max` of the slider's usual range (a typed value beyond it
 * widens the range by decades), `linear` for an even scale (logarithmic otherwise) and `hard` where min and max
 * are limits of the value itself, and `step` for what one arrow key moves. Arrow keys step, Shift makes a step ten, Home and End go to the ends.
 * Property `marks`: values worth a tick, with what they are. Events "value-input" (moving), "value-change" (rest).
 */

import { formatWithUnit } from "../core/format.js";
import { createScale, widen } from "../core/scale.js";
import { h } from "./dom.js";
import "./number-field.js";
import { SYMBOLS } from "./symbol.js";

const RESOLUTION = 1000;
/** The keys of a slider come in bursts; the value rests when none has come for this long. */
const KEY_REST_MS = 400;

/** @typedef {{value: number, label: string}} Mark */

export class GainSlider extends HTMLElement {
  #value = 1;
  #moving = false;
  #rest = 0;
  #usual = { min: 0.01, max: 100 };
  #scale = createScale({ min: 0.01, max: 100, log: true });
  /** @type {Mark[]} */
  #marks = [];
  #range = h("input", { type: "range", min: 0, max: RESOLUTION, step: 1 });
  #ticks = h("span", { class: "slider-marks", "aria-hidden": "true" });
  /** @type {import("./number-field.js").NumberField | null} */
  #field = null;

  connectedCallback() {
    if (this.#field) return;
    const name = this.getAttribute("name") ?? "";
    const unit = this.getAttribute("unit") ?? "";
    this.#usual = { min: Number(this.getAttribute("min") ?? 0.01), max: Number(this.getAttribute("max") ?? 100) };
    const field = document.createElement("number-field");
    for (const attribute of ["name", "label", "unit", "above"]) {
      const value = this.getAttribute(attribute);
      if (value !== null) field.setAttribute(attribute, value);
    }
    if (this.hasAttribute("hard")) {
      field.setAttribute("min", String(this.#usual.min));
      field.setAttribute("max", String(this.#usual.max));
    }
    this.#field = field;
    this.#range.setAttribute("aria-label", `${this.getAttribute("label") ?? SYMBOLS[name]?.spoken ?? name} slider`);
    this.#range.dataset["unit"] = unit;
    this.append(field, h("span", { class: "slider-track" }, this.#ticks, this.#range));

    this.#range.addEventListener("input", () => this.#move(this.#scale.toValue(Number(this.#range.value) / RESOLUTION)));
    this.#range.addEventListener("change", () => this.#settle());
    this.#range.addEventListener("keydown", (event) => this.#key(event));
    this.#range.addEventListener("keyup", () => this.#settleSoon());
    this.#range.addEventListener("blur", () => this.#settle());
    field.addEventListener("value-input", (event) => {
      event.stopPropagation();
      this.#take(/** @type {CustomEvent<{value: number}>} */ (event).detail.value, "value-input");
    });
    field.addEventListener("value-change", (event) => {
      event.stopPropagation();
      this.#take(/** @type {CustomEvent<{value: number}>} */ (event).detail.value, "value-change");
      this.#fit();
    });
    this.#fit();
  }

  get value() {
    return this.#value;
  }
  set value(value) {
    if (value === this.#value) return;
    this.#value = value;
    this.#rescale();
    this.#show();
  }

  /** @param {Mark[]} marks */
  set marks(marks) {
    if (JSON.stringify(marks) === JSON.stringify(this.#marks)) return;
    this.#marks = marks;
    this.#showMarks();
  }

  /** A range that holds the value: never while it moves, or the thumb would slip from under the finger. */
  #rescale() {
    if (this.#moving) return;
    const log = !this.hasAttribute("linear");
    const range = this.hasAttribute("hard") ? this.#usual : log ? widen(this.#value, this.#usual) : { min: Math.min(this.#value, this.#usual.min), max: Math.max(this.#value, this.#usual.max) };
    this.#scale = createScale({ ...range, log, step: Number(this.getAttribute("step")) || null });
  }

  #fit() {
    this.#rescale();
    this.#show();
  }

  #show() {
    const position = this.#scale.toPosition(this.#value);
    const at = String(Math.round(position * RESOLUTION));
    if (this.#range.value !== at && !this.#moving) this.#range.value = at;
    this.#range.style.setProperty("--position", String(position));
    this.#range.setAttribute("aria-valuetext", formatWithUnit(this.#value, this.#range.dataset["unit"] ?? ""));
    if (this.#field) this.#field.value = this.#value;
    this.#showMarks();
  }

  #showMarks() {
    this.#ticks.replaceChildren(
      ...this.#marks
        .filter(({ value }) => value >= this.#scale.min && value <= this.#scale.max)
        .map(({ value, label }) => {
          const tick = h("span", { class: "slider-mark", title: label });
          tick.style.setProperty("--position", String(this.#scale.toPosition(value)));
          return tick;
        }),
    );
  }

  /** @param {number} value @param {"value-input" | "value-change"} event */
  #take(value, event) {
    this.#value = value;
    this.#show();
    this.dispatchEvent(new CustomEvent(event, { bubbles: true, detail: { value } }));
  }

  /** @param {number} value */
  #move(value) {
    this.#moving = true;
    this.#take(value, "value-input");
  }

  #settle() {
    clearTimeout(this.#rest);
    if (!this.#moving) return;
    this.#moving = false;
    this.#take(this.#value, "value-change");
  }

  #settleSoon() {
    clearTimeout(this.#rest);
    if (this.#moving) this.#rest = window.setTimeout(() => this.#settle(), KEY_REST_MS);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const big = event.shiftKey ? 10 : 1;
    /** @type {Record<string, number>} */
    const steps = { ArrowRight: big, ArrowUp: big, ArrowLeft: -big, ArrowDown: -big, PageUp: 10, PageDown: -10 };
    const step = steps[event.key];
    let value;
    if (step !== undefined) value = this.#scale.step(this.#value, step);
    else if (event.key === "Home") value = this.#scale.min;
    else if (event.key === "End") value = this.#scale.max;
    else return;
    event.preventDefault();
    this.#move(value);
    this.#range.value = String(Math.round(this.#scale.toPosition(value) * RESOLUTION));
    this.#settleSoon();
  }
}

customElements.define("gain-slider", GainSlider);
