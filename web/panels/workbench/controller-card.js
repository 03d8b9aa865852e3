/** The controller: its type, its form, and a slider for each of its parameters. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {ControllerState, MarginsPanel} from "../../core/types.js" */

import { formatNumber } from "../../core/format.js";
import { fromParallel, hasDerivative, hasIntegral, parallelGains } from "../../core/workbench/loop.js";
import { createCard } from "../../components/card.js";
import { h } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { showMath } from "../../components/mathml.js";
import "../../components/segmented-control.js";

/**
 * @typedef {object} Knob
 * @property {string} name
 * @property {number} min
 * @property {number} max
 * @property {boolean} [time]
 * @property {boolean} [hard]
 * @property {boolean} [linear]  an even scale, on which zero and less are values too
 * @property {boolean} [aside]  among the things that are seldom set
 * @property {(c: ControllerState) => boolean} shown
 * @property {(c: ControllerState) => number} read
 * @property {(c: ControllerState, value: number) => Partial<ControllerState>} write
 */

/** @param {"Kc" | "tau_I" | "tau_D" | "alpha" | "beta"} name @returns {Pick<Knob, "name" | "read" | "write">} */
const plain = (name) => ({ name, read: (c) => c[name], write: (_, value) => ({ [name]: value }) });
/** @param {"Kp" | "Ki" | "Kd"} name @returns {Pick<Knob, "name" | "read" | "write">} */
const parallel = (name) => ({ name, read: (c) => parallelGains(c)[name], write: (c, value) => fromParallel(c, { [name]: value }) });

/** @type {Knob[]} */
const KNOBS = [
  { ...plain("Kc"), min: 0.1, max: 100, shown: (c) => c.form !== "parallel" },
  { ...plain("tau_I"), min: 0.1, max: 100, time: true, shown: (c) => c.form !== "parallel" && hasIntegral(c.type) },
  { ...plain("tau_D"), min: 0.01, max: 10, time: true, shown: (c) => c.form !== "parallel" && hasDerivative(c.type) },
  { ...parallel("Kp"), min: 0.1, max: 100, shown: (c) => c.form === "parallel" },
  { ...parallel("Ki"), min: 0.01, max: 100, shown: (c) => c.form === "parallel" && hasIntegral(c.type) },
  { ...parallel("Kd"), min: 0.01, max: 100, shown: (c) => c.form === "parallel" && hasDerivative(c.type) },
  { ...plain("beta"), min: 0, max: 1, linear: true, aside: true, shown: () => true },
  { ...plain("alpha"), min: 0.01, max: 1, hard: true, shown: (c) => hasDerivative(c.type) },
];

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const card = createCard(host, { id: "card-controller", title: "Controller" });

  /** @param {string} label @param {{value: string, label: string, title?: string}[]} options @param {(value: any) => Partial<ControllerState>} change */
  const choice = (label, options, change) => {
    const control = h("segmented-control", { label });
    control.options = options;
    control.addEventListener("value-change", () => store.setController(change(control.value)));
    return control;
  };
  const type = choice("Controller type", ["P", "PI", "PD", "PID"].map((value) => ({ value, label: value })), (value) => ({ type: value }));
  const form = choice(
    "Form",
    [
      { value: "ideal", label: "Ideal", title: "Kc (1 + 1/(τI s) + τD s/(α τD s + 1))" },
      { value: "series", label: "Series", title: "Kc (1 + 1/(τI s)) (τD s + 1)/(α τD s + 1)" },
      { value: "parallel", label: "Parallel", title: "Kp + Ki/s + Kd s/(α Kd/Kp s + 1)" },
    ],
    (value) => ({ form: value }),
  );
  const action = choice(
    "Action",
    [
      { value: "reverse", label: "Reverse", title: "u falls when y rises: for a plant with positive gain" },
      { value: "direct", label: "Direct", title: "u rises when y rises: for a plant with negative gain" },
    ],
    (value) => ({ action: value }),
  );

  const knobs = KNOBS.map((knob) => {
    const slider = h("gain-slider", { name: knob.name, min: knob.min, max: knob.max, above: knob.linear ? null : "0", linear: knob.linear ?? false, step: knob.linear ? 0.01 : null, hard: knob.hard ?? false, unit: knob.time ? answers.time_unit : null });
    const take = (/** @type {boolean} */ moving) => (/** @type {Event} */ event) => {
      const { value } = /** @type {CustomEvent<{value: number}>} */ (event).detail;
      store.setController(knob.write(store.get().controller, value), { moving });
    };
    slider.addEventListener("value-input", take(true));
    slider.addEventListener("value-change", take(false));
    return { knob, slider };
  });

  const math = h("div", { class: "math-display small" });
  card.body.append(
    type,
    h("div", { class: "knobs" }, ...knobs.filter(({ knob }) => !knob.aside).map(({ slider }) => slider)),
    h(
      "details",
      { class: "more" },
      h("summary", {}, "Form, action, setpoint weight"),
      h("div", { class: "row labelled" }, h("span", {}, "Form"), form),
      h("div", { class: "row labelled" }, h("span", {}, "Action"), action),
      h("div", { class: "knobs" }, ...knobs.filter(({ knob }) => knob.aside).map(({ slider }) => slider)),
      math,
    ),
  );

  function show() {
    const { controller } = store.get();
    type.value = controller.type;
    form.value = controller.form;
    action.value = controller.action;
    for (const { knob, slider } of knobs) {
      slider.hidden = !knob.shown(controller);
      if (!slider.hidden) slider.value = knob.read(controller);
    }
    card.summarise(`${controller.type}, Kc ${formatNumber(controller.Kc)}`);
  }

  /** Ticks on the gain where the loop is on the edge of stability: they do not move with the gain. */
  function showLimits() {
    showMath(math, answers.controller?.mathml);
    const { Kc } = store.get().controller;
    const marks = limits(answers.panels.margins ?? null).map((ratio) => ({ value: Kc * ratio, label: `limit of stability: ${formatNumber(Kc * ratio)}` }));
    for (const { knob, slider } of knobs) if (knob.name === "Kc") slider.marks = marks;
  }

  const stopStore = store.subscribe(show);
  const stopAnswers = answers.subscribe(({ moving }) => {
    if (!moving) showLimits();
  });
  show();
  return () => {
    stopStore();
    stopAnswers();
    card.root.remove();
  };
}

/**
 * The gains, as multiples of the one set, between which the loop is stable. Dead time makes ever more crossings:
 * only those next to a stable gain are limits, and of an unstable loop the lowest.
 * @param {MarginsPanel | null} margins
 */
function limits(margins) {
  const ratios = (margins?.phase_crossovers ?? []).map(({ GM }) => GM).toSorted((a, b) => a - b);
  if (!margins?.closed_loop_stable) return ratios.slice(0, 1);
  return [ratios.findLast((ratio) => ratio < 1), ratios.find((ratio) => ratio > 1)].filter((ratio) => ratio !== undefined);
}
