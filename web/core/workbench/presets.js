/** Plants to pick from, each with a controller that makes a loop worth looking at. */

/** @import {ControllerState, State, System} from "../types.js" */

import { startingAnalyses } from "./analyses.js";

/**
 * @typedef {object} Preset
 * @property {string} id
 * @property {string} group
 * @property {string} name
 * @property {string} teaches
 * @property {System} plant
 * @property {Partial<ControllerState>} controller
 */

/** @type {ControllerState} */
export const DEFAULT_CONTROLLER = { type: "PI", form: "ideal", Kc: 1.4, tau_I: 2.2, tau_D: 0.45, alpha: 0.1, beta: 1, action: "reverse" };

/** @param {string} text @returns {System} */
const expr = (text) => ({ type: "expr", text });

/** @type {Preset[]} */
export const PRESETS = [
  {
    id: "three-lags",
    group: "First steps",
    name: "Three equal lags",
    teaches: "The textbook loop: stable until the gain reaches 8.",
    plant: expr("1/(s+1)^3"),
    controller: { type: "PI", Kc: 1.4, tau_I: 2.2 },
  },
  {
    id: "fopdt",
    group: "First steps",
    name: "Lag with dead time",
    teaches: "What most processes look like from outside; drag θ and watch the phase.",
    plant: { type: "fopdt", K: 1, tau: 0.5, theta: 0.1 },
    controller: { type: "PI", Kc: 2.2, tau_I: 0.5 },
  },
  {
    id: "oscillatory",
    group: "First steps",
    name: "Oscillatory",
    teaches: "A lightly damped pair: derivative action is the brake.",
    plant: { type: "sopdt", K: 1, tau: 1, zeta: 0.2, theta: 0 },
    controller: { type: "PID", Kc: 2, tau_I: 2, tau_D: 1 },
  },
  {
    id: "integrator-delay",
    group: "Harder ones",
    name: "Integrator with dead time",
    teaches: "A level with a slow valve: too little gain is bad here too.",
    plant: expr("0.5 exp(-s)/s"),
    controller: { type: "PI", Kc: 0.8, tau_I: 9 },
  },
  {
    id: "rhp-zero",
    group: "Harder ones",
    name: "Inverse response",
    teaches: "A zero in the right half plane: y first moves the wrong way.",
    plant: expr("(1 - s)/(s+1)^2"),
    controller: { type: "PI", Kc: 0.6, tau_I: 1.6 },
  },
  {
    id: "unstable",
    group: "Harder ones",
    name: "Unstable plant",
    teaches: "Here the gain has a lower limit as well as an upper one.",
    plant: expr("2/((s-1)(0.1s+1))"),
    controller: { type: "PI", Kc: 2, tau_I: 2 },
  },
  {
    id: "dead-time",
    group: "Harder ones",
    name: "Pure dead time",
    teaches: "Nothing but delay: the response is a staircase.",
    plant: expr("exp(-s)"),
    controller: { type: "PI", Kc: 0.2, tau_I: 0.4 },
  },
  {
    id: "four-lags",
    group: "Harder ones",
    name: "Four lags, widely spaced",
    teaches: "High gain is possible until the small lags add up.",
    plant: expr("1/((s+1)(0.2s+1)(0.04s+1)(0.008s+1))"),
    controller: { type: "PI", Kc: 5, tau_I: 0.8 },
  },
  {
    id: "notes-locus-two-poles",
    group: "Lecture notes",
    name: "Root locus with a right-half-plane pole",
    teaches: "Stable for every gain above 2.",
    plant: expr("2(s+1)/(s(s-4))"),
    controller: { type: "P", Kc: 6 },
  },
  {
    id: "notes-routh",
    group: "Lecture notes",
    name: "Routh example with PI",
    teaches: "With τI ≥ 0.5 no gain makes it unstable.",
    plant: expr("1/(s^2+2s+2)"),
    controller: { type: "PI", Kc: 2, tau_I: 0.8 },
  },
  {
    id: "notes-internal",
    group: "Lecture notes",
    name: "Symmetric unstable pair",
    teaches: "Cancelling the pole at +4 hides it from y, not from the plant.",
    plant: expr("3/((s+4)(s-4))"),
    controller: { type: "PD", Kc: 12, tau_D: 0.3 },
  },
  {
    id: "notes-two-zeros",
    group: "Lecture notes",
    name: "Two right-half-plane zeros",
    teaches: "The response first moves up, then down, then up for good.",
    plant: expr("(s^2-3s+2)/(s+1)^4"),
    controller: { type: "PI", Kc: 0.15, tau_I: 1.6 },
  },
  {
    id: "notes-nine-poles",
    group: "Lecture notes",
    name: "Nine poles",
    teaches: "At least two of them are in the right half plane at every gain.",
    plant: expr("(s+3)/(s^2(s+2)(s+4)(s^2+2s+9)(s^3+5))"),
    controller: { type: "P", Kc: 10 },
  },
];

/** @returns {State} */
export function defaultState() {
  return {
    plant: expr("1/(s+1)^3"),
    controller: { ...DEFAULT_CONTROLLER },
    actuator: "",
    sensor: "",
    horizon: null,
    view: { signal: "setpoint", show: [], analyses: startingAnalyses() },
  };
}
