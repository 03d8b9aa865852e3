/** The knobs of a lab's bench: a slider each, with a switch where the action can be taken out of the loop. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {LabBench, LabSlider} from "../../core/lab/types.js" */
/** @import {GainSlider} from "../../components/gain-slider.js" */

import { formatNumber } from "../../core/format.js";
import { isOn, withSettings } from "../../core/lab/bench.js";
import { h } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { showMath } from "../../components/mathml.js";

const ACTIONS = { tau_I: "Integral action", tau_D: "Derivative action" };

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} _api
 * @param {LabBench} bench
 * @returns {() => void}
 */
export function mount(host, store, _api, bench) {
  const blocks = [
    { name: "Actuator", mathml: bench.actuator_mathml },
    { name: "Process", mathml: bench.plant_mathml },
    { name: "Sensor", mathml: bench.sensor_mathml },
  ].flatMap(({ name, mathml }) => (mathml === null ? [] : [block(name, mathml)]));
  const knobs = bench.sliders.map((slider) => knob(slider, store));
  const root = h(
    "section",
    { class: "bench-knobs", "aria-label": "Controller" },
    h("p", { class: "bench-process" }, ...blocks),
    h("div", { class: "knob-row" }, ...knobs.map(({ element }) => element)),
  );
  host.append(root);

  function show() {
    for (const one of knobs) one.show();
  }

  /** Ticks on the gain where the loop is on the edge of stability: they do not move with the gain. */
  function showLimits() {
    const { Kc } = store.get().controller;
    const marks = (store.answers.panels.margins?.phase_crossovers ?? []).map(({ GM }) => ({ value: Kc * GM, label: `limit of stability: ${formatNumber(Kc * GM)}` }));
    for (const { name, slider } of knobs) if (name === "Kc") slider.marks = marks;
  }
  const stop = store.subscribe(show);
  const stopAnswers = store.answers.subscribe(({ moving }) => {
    if (!moving) showLimits();
  });
  show();
  return () => {
    stop();
    stopAnswers();
    root.remove();
  };
}

/** @param {string} name @param {string} mathml */
function block(name, mathml) {
  const formula = h("span", { class: "bench-plant" });
  showMath(formula, mathml);
  return h("span", { class: "bench-block" }, h("span", { class: "bench-caption" }, name), " ", formula);
}

/** @param {LabSlider} slider @param {Store} store */
function knob({ knob: name, label, unit, min, max, step, scale, can_be_off }, store) {
  const slider = /** @type {GainSlider} */ (h("gain-slider", { name, unit: unit || null, min, max, step, hard: true, linear: scale === "linear" }));
  const take = (/** @type {boolean} */ moving) => (/** @type {Event} */ event) => {
    const { value } = /** @type {CustomEvent<{value: number}>} */ (event).detail;
    store.setController({ [name]: value }, { moving });
  };
  slider.addEventListener("value-input", take(true));
  slider.addEventListener("value-change", take(false));

  const toggle = h("input", { type: "checkbox", role: "switch" });
  toggle.addEventListener("change", () => {
    const { controller } = store.get();
    store.setController(withSettings(controller, { [name]: toggle.checked ? controller[name] : null }));
  });
  const words = can_be_off ? (/** @type {Record<string, string>} */ (ACTIONS)[name] ?? label) : label;
  const heading = can_be_off ? h("label", { class: "switch" }, toggle, h("span", { class: "switch-box", "aria-hidden": "true" }), words) : h("span", { class: "knob-name" }, words);
  const element = h("div", { class: "knob" }, heading, slider);

  return {
    name,
    slider,
    element,
    show() {
      const { controller } = store.get();
      const on = isOn(controller, name);
      toggle.checked = on;
      element.classList.toggle("off", !on);
      slider.inert = !on;
      slider.value = controller[name];
    },
  };
}
