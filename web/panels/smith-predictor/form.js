/** The model in the predictor, how robust the loops shall be, and how the plant differs. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {MismatchAxis, SmithAnswer, SmithState} from "../../core/design/smith.js" */

import { sentence } from "../../core/format.js";
import { AXES, MISMATCH, MS, SMITH_PRESETS } from "../../core/design/smith.js";
import { h } from "../../components/dom.js";
import { createExpressionField } from "../../components/expression-field.js";
import "../../components/gain-slider.js";
import { smithDiagram } from "../../components/smith-diagram.js";

/** @type {Record<MismatchAxis, string>} */
const NAMES = { K: "Gain", tau: "Time constants", theta: "Dead time" };

/** @param {HTMLElement} host @param {DesignBench<SmithState, SmithAnswer>} bench */
export function mount(host, bench) {
  const model = createExpressionField({ id: "smith-model", symbol: "G", hint: "With its dead time, as exp(-4s).", commit: (text) => bench.set({ model: text }) });
  const presets = SMITH_PRESETS.map((preset) =>
    h("button", { type: "button", class: "button small", title: preset.teaches, onclick: () => bench.set({ model: preset.model, Ms: preset.Ms, signal: preset.signal, mismatch: { K: 0, tau: 0, theta: 0 } }) }, preset.name),
  );
  /** @param {Record<string, string | number | boolean>} attributes @param {(value: number, moving: boolean) => void} onValue */
  const slider = (attributes, onValue) => {
    const element = /** @type {import("../../components/gain-slider.js").GainSlider} */ (h("gain-slider", { ...attributes, linear: true, hard: true }));
    for (const [event, moving] of /** @type {const} */ ([["value-input", true], ["value-change", false]])) {
      element.addEventListener(event, (told) => onValue(/** @type {CustomEvent<{value: number}>} */ (told).detail.value, moving));
    }
    return element;
  };
  const sliders = AXES.map((axis) => ({
    axis,
    element: slider({ label: NAMES[axis], unit: "%", step: 1, ...MISMATCH[axis] }, (value, moving) => bench.set({ mismatch: { ...bench.state.mismatch, [axis]: value } }, { moving })),
  }));
  for (const { element } of sliders) element.marks = [{ value: 0, label: "as the model" }];
  const Ms = slider({ label: "Ms of all three", step: 0.01, ...MS }, (value, moving) => bench.set({ Ms: value }, { moving }));
  const reset = h("button", { type: "button", class: "button small", onclick: () => bench.set({ mismatch: { K: 0, tau: 0, theta: 0 } }) }, "Plant as the model");
  const message = h("p", { class: "analysis-message wrong", role: "status", hidden: true });

  host.append(
    h("div", { class: "diagram" }, smithDiagram()),
    h("section", { class: "design-card-form", "aria-label": "Model" }, h("h2", {}, "Model"), model.root, h("div", { class: "design-presets", role: "group", "aria-label": "Examples" }, ...presets), message, Ms),
    h("section", { class: "design-card-form", "aria-label": "Mismatch" }, h("h2", {}, "The plant differs by"), ...sliders.map(({ element }) => element), h("div", { class: "design-links" }, reset)),
  );

  function show() {
    const { state, error } = bench;
    model.show(state.model);
    const typed = error?.path?.startsWith("model.") ? error : null;
    model.complain(typed);
    const other = error && !typed ? error : null;
    message.hidden = other === null;
    message.textContent = other ? [sentence(other.message), sentence(other.hint)].join(" ").trim() : "";
    for (const { axis, element } of sliders) element.value = Number(state.mismatch[axis].toFixed(2));
    Ms.value = state.Ms;
  }
  bench.subscribe(show);
  show();
}
