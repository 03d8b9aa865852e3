/**
 * One colour and one dash for each signal, everywhere. Colours are style tokens `--signal-<name>`, chosen for
 * colour-blind eyes in light and dark; the dash tells them apart without colour.
 */

/** @import {Response, Theme} from "../core/types.js" */

/**
 * @typedef {object} Signal
 * @property {string} label
 * @property {string} name
 * @property {"solid" | "dash" | "dot" | "dashdot" | "longdash"} dash
 * @property {number} width
 */

/** @type {Record<string, Signal>} */
export const SIGNALS = {
  r: { label: "r", name: "setpoint", dash: "dash", width: 1.5 },
  y: { label: "y", name: "process output", dash: "solid", width: 2.5 },
  y_m: { label: "yₘ", name: "measured output", dash: "dash", width: 1.75 },
  u: { label: "u", name: "controller output", dash: "solid", width: 2 },
  d: { label: "d", name: "load disturbance", dash: "dashdot", width: 2 },
  n: { label: "n", name: "measurement noise", dash: "dot", width: 1.5 },
  e: { label: "e", name: "error", dash: "longdash", width: 1.5 },
  L: { label: "L", name: "open loop", dash: "solid", width: 2.5 },
  P: { label: "P", name: "plant", dash: "dash", width: 1.75 },
  C: { label: "C", name: "controller", dash: "dot", width: 2 },
  sketch: { label: "asymptotes", name: "straight lines of L, with what each corner is", dash: "solid", width: 1.5 },
  S: { label: "S", name: "sensitivity", dash: "solid", width: 2.25 },
  PS: { label: "PS", name: "load to output", dash: "dashdot", width: 1.75 },
  CS: { label: "CS", name: "noise to controller output", dash: "dot", width: 2 },
  CFS: { label: "CFS", name: "setpoint to controller output, weighted", dash: "dashdot", width: 1.75 },
  TF: { label: "TF", name: "setpoint to output, weighted", dash: "dash", width: 2 },
  T: { label: "T", name: "complementary sensitivity", dash: "longdash", width: 2.25 },
  term: { label: "terms", name: "what is added up", dash: "solid", width: 1 },
  sum: { label: "sum", name: "sum of the terms", dash: "dash", width: 2 },
  simulated: { label: "simulated", name: "simulation of the same transform", dash: "dot", width: 2 },
  half_rule: { label: "half rule", name: "half rule", dash: "dash", width: 2 },
  taylor: { label: "Taylor", name: "Taylor", dash: "dot", width: 2 },
  two_point: { label: "two points", name: "two points of the step response", dash: "dashdot", width: 2 },
  now: { label: "now", name: "present settings", dash: "solid", width: 3 },
  optimal: { label: "optimal", name: "best settings within the limit of Ms", dash: "solid", width: 2 },
  case_1: { label: "rule 1", name: "first rule", dash: "dash", width: 2 },
  case_2: { label: "rule 2", name: "second rule", dash: "dot", width: 2.25 },
  case_3: { label: "rule 3", name: "third rule", dash: "dashdot", width: 2 },
  case_4: { label: "rule 4", name: "fourth rule", dash: "longdash", width: 2 },
  case_5: { label: "rule 5", name: "fifth rule", dash: "dash", width: 2 },
  case_6: { label: "rule 6", name: "sixth rule", dash: "dot", width: 2.25 },
  model: { label: "model", name: "what the model answers", dash: "dash", width: 2.25 },
  ideal_S: { label: "best S", name: "S of the best loop with this dead time", dash: "dot", width: 1.5 },
  model_error: { label: "1/|GΔ|", name: "one over the largest model error", dash: "dashdot", width: 1.75 },
  samples: { label: "samples", name: "samples", dash: "solid", width: 1.5 },
  signal: { label: "signal", name: "signal between the samples", dash: "solid", width: 1.5 },
  seen: { label: "alias", name: "slowest sine with the same samples", dash: "dash", width: 2 },
  spectrum: { label: "spectrum", name: "amplitude at each frequency", dash: "solid", width: 2 },
  expected: { label: "noise alone", name: "amplitudes of the noise alone, in the mean square", dash: "solid", width: 2 },
  half_rate: { label: "fs/2", name: "half the sampling rate", dash: "dash", width: 1.5 },
  least_squares: { label: "least squares", name: "least squares", dash: "longdash", width: 2 },
};

/**
 * A legend's button for a signal that can be switched on and off.
 * @param {string} signal
 * @param {boolean} on
 * @param {() => void} toggle
 */
export function legendToggle(signal, on, toggle) {
  const { label, name, dash } = /** @type {Signal} */ (SIGNALS[signal]);
  return { signal, label, name, dash, on, toggle };
}

/**
 * @param {keyof typeof SIGNALS} signal
 * @param {Theme} theme
 */
export function lineOf(signal, theme) {
  const { dash, width } = /** @type {Signal} */ (SIGNALS[signal]);
  return { color: theme.signal[signal] ?? theme.ink, dash, width };
}

/** Drawn of a system that is zero, which has no magnitude in dB and no phase. @type {Response} */
export const NO_CURVE = { mag_dB: [], phase_deg: [] };

/** The line of a kept response: the same dash, thinner and grey, so that the live one stands out. @param {Theme} theme */
export function ghostLine(theme) {
  return { color: theme.muted, dash: "solid", width: 1.25 };
}
