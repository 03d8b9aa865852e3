/** Input signals: which there are, what each is set by, and how they stand in an address. */

/** @import {InputShape} from "./types.js" */

import { listText, parseList } from "./lists.js";

/**
 * @typedef {object} InputField
 * @property {string} name  as the API has it
 * @property {string} label
 * @property {number} value  what it starts at
 * @property {number} [above]
 * @property {number} [min]
 * @property {string} [unit]  "time" stands for the model's time unit
 */

/** @type {InputField} */
const AMPLITUDE = { name: "amplitude", label: "Amplitude", value: 1 };
/** @type {InputField} */
const START = { name: "start", label: "Begins at", value: 0, min: 0, unit: "time" };
/** @type {InputField} */
const OMEGA = { name: "omega", label: "ω", value: 2, above: 0, unit: "rad/time" };

/** @type {Record<string, {label: string, fields: InputField[]}>} */
export const INPUTS = {
  step: { label: "Step", fields: [AMPLITUDE, START] },
  impulse: { label: "Impulse", fields: [{ name: "area", label: "Area", value: 1 }, START] },
  ramp: { label: "Ramp", fields: [{ name: "slope", label: "Slope", value: 1 }, START] },
  sine: { label: "Sine", fields: [AMPLITUDE, OMEGA, { name: "phase_deg", label: "Phase", value: 0, unit: "°" }, START] },
  pulse: { label: "Pulse", fields: [AMPLITUDE, { name: "width", label: "Width", value: 1, above: 0, unit: "time" }, START] },
  sampled: { label: "Samples", fields: [] },
};

/** Inputs with a rational transform; they begin at t = 0. @type {Record<string, {label: string, fields: InputField[]}>} */
export const TRANSFORMS = {
  step: { label: "Step", fields: [AMPLITUDE] },
  impulse: { label: "Impulse", fields: [{ name: "area", label: "Area", value: 1 }] },
  ramp: { label: "Ramp", fields: [{ name: "slope", label: "Slope", value: 1 }] },
  sine: { label: "Sine", fields: [AMPLITUDE, OMEGA] },
  exponential: { label: "Exponential", fields: [AMPLITUDE, { name: "rate", label: "Rate", value: -1, unit: "1/time" }] },
};

/** @type {InputShape} */
const STAIRCASE = { type: "sampled", times: [0, 3, 6], values: [1, 3, 2], hold: "zero" };

/** @param {string} type @param {typeof INPUTS} known @returns {InputShape} */
export function startingInput(type, known) {
  if (type === "sampled") return STAIRCASE;
  return { type, ...Object.fromEntries((known[type]?.fields ?? []).map(({ name, value }) => [name, value])) };
}

/** Whether it is made of steps, so that the answer is a sum of steps too. @param {InputShape} input */
export function isStaircase({ type, hold }) {
  return type === "step" || type === "pulse" || (type === "sampled" && hold === "zero");
}

/** @param {URLSearchParams} query @param {string} prefix @param {InputShape} input */
export function inputToQuery(query, prefix, input) {
  query.set(`${prefix}.input`, input.type);
  for (const [name, value] of Object.entries(input)) {
    if (name !== "type") query.set(`${prefix}.${name}`, Array.isArray(value) ? listText(value, ",") : String(value));
  }
}

/**
 * The input that the address names, with what it leaves out as it starts; null where it names none.
 * @param {URLSearchParams} query
 * @param {string} prefix
 * @param {typeof INPUTS} known
 * @returns {InputShape | null}
 */
export function inputFromQuery(query, prefix, known) {
  const type = query.get(`${prefix}.input`) ?? "";
  if (!(type in known)) return null;
  const input = { ...startingInput(type, known) };
  const list = (/** @type {string} */ name) => parseList(query.get(`${prefix}.${name}`) ?? "");
  if (type === "sampled") {
    const [times, values] = [list("times"), list("values")];
    const hold = query.get(`${prefix}.hold`) === "linear" ? "linear" : "zero";
    return times?.length && times.length === values?.length ? { type, times, values, hold } : { ...input, hold };
  }
  for (const { name, min = -Infinity, above = -Infinity } of known[type]?.fields ?? []) {
    const [value] = list(name) ?? [];
    if (value !== undefined && value >= min && value > above) input[name] = value;
  }
  return input;
}
