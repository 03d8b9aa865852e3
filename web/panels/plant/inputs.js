/** What can be done to the plant: a slider for each input, steps at a click, operating points to start from. */

/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {Quantity} from "../../core/plant/types.js" */

import { round125 } from "../../core/plant/pace.js";
import { usualRange } from "../../core/plant/bench.js";
import { formatWithUnit } from "../../core/format.js";
import { formatShort } from "../../core/roots.js";
import { h } from "../../components/dom.js";
import "../../components/gain-slider.js";

/** A step at a click, as part of the slider's range. */
const STEP = 0.05;

/** @param {HTMLElement} host @param {PlantBench} bench */
export function mount(host, bench) {
  /** @type {Map<string, import("../../components/gain-slider.js").GainSlider>} */
  const sliders = new Map();
  const points = bench.model.operating_points ?? [];
  const root = h(
    "section",
    { class: "plant-card", "aria-labelledby": "inputs-title" },
    h("h2", { id: "inputs-title" }, "Inputs"),
    ...bench.inputs.map(control),
    h("h3", {}, "Start at"),
    h(
      "div",
      { class: "row" },
      h("button", { type: "button", class: "button small", onclick: () => bench.goTo(null) }, "nominal start"),
      ...points.map((point) => h("button", { type: "button", class: "button small", onclick: () => bench.goTo(point) }, point.title ?? point.name)),
    ),
  );
  host.append(root);

  /** @param {Quantity} input */
  function control(input) {
    const { name, value, min, max, meaning } = input;
    const range = usualRange(input);
    const step = round125(STEP * (range.max - range.min));
    const slider = document.createElement("gain-slider");
    const attributes = { name, label: `${name}, ${meaning ?? "input"}`, unit: bench.unit(name), min: range.min, max: range.max, step: round125(step / 10), linear: "" };
    for (const [key, text] of Object.entries(attributes)) slider.setAttribute(key, String(text));
    if (range.min === min && range.max === max) slider.setAttribute("hard", "");
    slider.value = bench.setting.inputs[name] ?? value;
    for (const [event, moving] of /** @type {const} */ ([["value-input", true], ["value-change", false]])) {
      slider.addEventListener(event, (told) => bench.set({ inputs: { [name]: /** @type {CustomEvent<{value: number}>} */ (told).detail.value } }, { moving }));
    }
    sliders.set(name, slider);
    /** @param {number} by */
    const nudge = (by) => {
      const next = Number(((bench.setting.inputs[name] ?? value) + by).toPrecision(10));
      bench.set({ inputs: { [name]: Math.min(max ?? Infinity, Math.max(min ?? -Infinity, next)) } });
    };
    const size = formatWithUnit(step, bench.unit(name), 2);
    return h(
      "div",
      { class: "plant-input" },
      slider,
      h(
        "div",
        { class: "plant-input-more" },
        h("span", {}, `nominal ${formatShort(value)}${min !== undefined && max !== undefined ? `, from ${formatShort(min)} to ${formatShort(max)}` : ""}`),
        h("button", { type: "button", class: "button small", "aria-label": `Step ${name} down by ${size}`, title: `Step down by ${size}`, onclick: () => nudge(-step) }, "Step −"),
        h("button", { type: "button", class: "button small", "aria-label": `Step ${name} up by ${size}`, title: `Step up by ${size}`, onclick: () => nudge(step) }, "Step +"),
      ),
    );
  }

  return {
    root,
    refresh() {
      for (const [name, slider] of sliders) slider.value = bench.setting.inputs[name] ?? slider.value;
    },
  };
}
