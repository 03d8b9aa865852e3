/** The plant on its page: what it is set to, where it starts, and the address that says so. */

/** @import {OperatingPoint, PlantAnswer, Quantity, Values} from "./types.js" */

import { toInput } from "../format.js";

/** @typedef {ReturnType<typeof createPlantBench>} PlantBench */
/** @typedef {{moving: boolean, restart: boolean}} Change  restart: the run begins anew */

const PREFIX = { inputs: "u.", parameters: "p.", start: "x." };

/** The ends of a slider: the declared range, or one about the value. @param {Quantity} quantity */
export function usualRange({ value, min, max }) {
  const reach = Math.abs(value) || 1;
  const low = min ?? Math.min(0, value - reach);
  const high = max ?? value + reach;
  // A range of many decades beside the value is that of a limit, not of a knob.
  return { min: low, max: max !== undefined && reach > 0 && high > 20 * reach && low >= 0 ? 20 * reach : high };
}

/**
 * Where a state is worth looking at: about its operating points and its start, with room on both sides.
 * @param {PlantAnswer} answer @param {string} name
 * @returns {{low: number, high: number}}
 */
export function usualWindow(answer, name) {
  const { values } = answer;
  const model = answer.document;
  const state = model.states.find((each) => each.name === name);
  const known = [values[name] ?? 0, ...(model.operating_points ?? []).flatMap(({ near }) => near?.[name] ?? [])];
  const [least, most] = [Math.min(...known), Math.max(...known)];
  const room = 0.4 * (most - least) || 0.5 * Math.abs(most) || 1;
  const tidy = (/** @type {number} */ value) => Number(value.toPrecision(3));
  // A slack bound below zero is there for rounding.
  const floor = Math.abs(state?.min ?? -Infinity) < 0.01 * room ? 0 : (state?.min ?? -Infinity);
  return { low: tidy(Math.max(floor, least - room)), high: tidy(Math.min(state?.max ?? Infinity, most + room)) };
}

/** @param {Quantity[]} quantities @returns {Values} */
function nominal(quantities) {
  return Object.fromEntries(quantities.map(({ name, value }) => [name, value]));
}

/** @param {PlantAnswer} answer @param {string} search  the query of the address */
export function createPlantBench(answer, search = "") {
  const model = answer.document;
  const parameters = model.parameters ?? [];
  const inputs = model.inputs ?? [];
  const outputs = model.outputs ?? model.states;
  const own = { inputs: nominal(inputs), parameters: nominal(parameters) };
  /** @type {{inputs: Values, parameters: Values, start: Values}} */
  const setting = { inputs: { ...own.inputs }, parameters: { ...own.parameters }, start: {} };
  /** @type {Set<(change: Change) => void>} */
  const listeners = new Set();

  const query = new URLSearchParams(search);
  /** @param {keyof typeof PREFIX} kind @param {{name: string, min?: number, max?: number}[]} known */
  const read = (kind, known) => {
    for (const { name, min = -Infinity, max = Infinity } of known) {
      const text = query.get(PREFIX[kind] + name);
      const value = text === null || text.trim() === "" ? NaN : Number(text);
      if (Number.isFinite(value) && value >= min && value <= max) setting[kind][name] = value;
    }
  };
  read("inputs", inputs);
  read("parameters", parameters);
  read("start", model.states);

  /** @param {Change} change */
  const tell = (change) => {
    for (const listener of listeners) listener(change);
  };
  /** @param {Values} values @param {Values} usual */
  const changed = (values, usual) => Object.fromEntries(Object.entries(values).filter(([name, value]) => value !== usual[name]));
  const all = [...parameters, ...inputs, ...(model.variables ?? []), ...outputs, ...model.states];

  return {
    answer,
    model,
    parameters,
    inputs,
    outputs,
    timeUnit: model.time_unit ?? "s",
    setting,
    /** @param {string} name */
    unit: (name) => all.find((each) => each.name === name)?.unit?.replace(/^-$/, "").replaceAll("^2", "²").replaceAll("^3", "³") ?? "",
    /** What is not nominal, as every route of the plant takes it. */
    request: () => ({ inputs: changed(setting.inputs, own.inputs), parameters: changed(setting.parameters, own.parameters) }),
    /** @param {{inputs?: Values, parameters?: Values}} patch @param {{moving?: boolean}} [how] */
    set(patch, { moving = false } = {}) {
      Object.assign(setting.inputs, patch.inputs);
      Object.assign(setting.parameters, patch.parameters);
      tell({ moving, restart: false });
    },
    /** Begins a run at these states; at the plant's own where there are none. @param {Values} start @param {{inputs?: Values}} [patch] */
    startFrom(start, patch = {}) {
      setting.start = { ...start };
      Object.assign(setting.inputs, patch.inputs);
      tell({ moving: false, restart: true });
    },
    /** @param {OperatingPoint | null} point  null: all nominal */
    goTo(point) {
      setting.inputs = { ...own.inputs, ...point?.inputs };
      setting.parameters = { ...own.parameters, ...point?.parameters };
      setting.start = { ...point?.near };
      tell({ moving: false, restart: true });
    },
    query() {
      const out = new URLSearchParams();
      const { inputs: u, parameters: p } = this.request();
      for (const [kind, values] of /** @type {const} */ ([["inputs", u], ["parameters", p], ["start", setting.start]])) {
        for (const [name, value] of Object.entries(values)) out.set(PREFIX[kind] + name, toInput(value));
      }
      return out.toString();
    },
    /** @param {(change: Change) => void} listener @returns {() => void} */
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}
