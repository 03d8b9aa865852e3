/**
 * `<plant-schematic>`: a live drawing of a plant, given as JSON and moved by the values of the plant's signals.
 *
 * Properties: `drawing` (as the server's schema of a schematic has it), `values` ({signal: number}, as often as every
 * frame; signals left out keep their value), `units` ({signal: unit}), `still` (nothing turns or runs), `problems`
 * (what could not be drawn, and where; the rest is). Event: "schematic-problems" after a drawing that has some.
 */

import { set, setText, svg, h } from "./dom.js";
import { buildAll, KIND_NAMES } from "./schematic/build.js";
import { Scene } from "./schematic/scene.js";

/** Size of text on the screen, in px: that of the drawing, but never too small to read nor too loud. */
const TEXT = { smallest: 11, drawn: 14, largest: 17 };
/** ms between two descriptions while values move, and of rest before it is spoken. */
const DESCRIBE_EVERY = 1000;
const SPEAK_AFTER = 1500;

export class PlantSchematic extends HTMLElement {
  static kinds = KIND_NAMES;

  /** @type {any} */
  #drawing = null;
  /** @type {Scene | null} */
  #scene = null;
  /** @type {Record<string, number>} */
  #values = {};
  /** @type {Record<string, string>} */
  #units = {};
  #still = false;
  #svg = svg("svg", { role: "img", class: "schematic", preserveAspectRatio: "xMidYMid meet" });
  #status = h("span", { class: "visually-hidden", role: "status" });
  #calm = matchMedia("(prefers-reduced-motion: reduce)");
  #resized = new ResizeObserver(() => this.#fitText());
  #textSize = 0;
  #describing = 0;
  #speaking = 0;
  /** What was read when the drawing was met is not spoken again. */
  #met = false;
  #onCalm = () => this.#settle();

  connectedCallback() {
    if (!this.#svg.isConnected) this.append(this.#svg, this.#status);
    this.#resized.observe(this);
    this.#calm.addEventListener("change", this.#onCalm);
    if (this.#drawing && !this.#scene) this.#build();
  }

  disconnectedCallback() {
    this.#resized.disconnect();
    this.#calm.removeEventListener("change", this.#onCalm);
    clearTimeout(this.#describing);
    clearTimeout(this.#speaking);
    this.#describing = 0;
    this.#scene?.dispose();
    this.#scene = null;
  }

  set drawing(drawing) {
    this.#drawing = drawing;
    if (this.isConnected) this.#build();
  }
  get drawing() {
    return this.#drawing;
  }

  /** @param {Record<string, number>} values */
  set values(values) {
    Object.assign(this.#values, values);
    if (!this.#scene) return;
    this.#scene.show(values);
    this.#describing ||= window.setTimeout(() => this.#describe(), DESCRIBE_EVERY);
    clearTimeout(this.#speaking);
    this.#speaking = window.setTimeout(() => this.#speak(), SPEAK_AFTER);
  }
  get values() {
    return { ...this.#values };
  }

  /** @param {Record<string, string>} units */
  set units(units) {
    this.#units = units;
    this.#scene?.onUnits.forEach((tell) => tell(units));
    this.#describe();
  }
  get units() {
    return this.#units;
  }

  /** @param {boolean} still */
  set still(still) {
    this.#still = still;
    this.#settle();
  }
  get still() {
    return this.#still;
  }

  get problems() {
    const problems = [...(this.#scene?.problems ?? [])];
    if (Object.keys(this.#values).length === 0) return problems;
    for (const [signal, path] of this.#scene?.named ?? []) {
      if (!Object.hasOwn(this.#values, signal)) problems.push({ path, message: `no signal is called "${signal}"` });
    }
    return problems;
  }

  #settle() {
    if (this.#scene) this.#scene.still = this.#still || this.#calm.matches;
  }

  #build() {
    this.#scene?.dispose();
    const scene = new Scene();
    this.#scene = scene;
    this.#settle();
    const view = this.#drawing?.view;
    const [width, height] = Array.isArray(view) && view.length === 2 && view.every((side) => Number.isFinite(side) && side > 0) ? view : [480, 320];
    if (view?.[0] !== width || view?.[1] !== height) scene.problems.push({ path: "view", message: "must be the width and the height of the drawing" });
    set(this.#svg, { viewBox: `0 0 ${width} ${height}` });
    this.#svg.style.aspectRatio = `${width} / ${height}`;
    this.#svg.replaceChildren(...buildAll(this.#drawing?.shapes, scene, "shapes"));
    scene.show(this.#values);
    scene.onUnits.forEach((tell) => tell(this.#units));
    this.#textSize = 0;
    this.#fitText();
    this.#describe();
    if (scene.problems.length > 0) this.dispatchEvent(new CustomEvent("schematic-problems", { bubbles: true, detail: { problems: scene.problems } }));
  }

  /** Text keeps a readable size on the screen, whatever the width of the drawing. */
  #fitText() {
    const width = this.#svg.getBoundingClientRect().width;
    const [wide] = this.#drawing?.view ?? [];
    // what is not shown cannot be measured: it is when it comes into sight
    if (!width) this.#textSize = 0;
    if (!width || !wide) return;
    const rem = parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
    const scale = width / wide;
    const size = Math.min(TEXT.largest * rem, Math.max(TEXT.smallest * rem, TEXT.drawn * scale)) / scale;
    if (Math.abs(size - this.#textSize) < 0.05) return;
    this.#textSize = size;
    this.#svg.style.fontSize = `${size.toFixed(2)}px`;
    this.#scene?.onTextSize.forEach((tell) => tell(size));
  }

  get #description() {
    const title = this.#drawing?.title ?? this.getAttribute("label") ?? "Drawing of the plant";
    const readings = this.#scene?.readouts.map(({ describe }) => describe()) ?? [];
    return readings.length > 0 ? `${title}: ${readings.join(", ")}` : title;
  }

  #describe() {
    this.#describing = 0;
    set(this.#svg, { "aria-label": this.#description });
  }

  /** Spoken once the values have come to rest, not while they move. */
  #speak() {
    if (this.#met) setText(this.#status, this.#description);
    this.#met = true;
  }
}

customElements.define("plant-schematic", PlantSchematic);
