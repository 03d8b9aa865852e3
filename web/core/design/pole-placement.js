/** The pole placement page: what it is set to, what it asks, and how that stands in the address. */

/** @import {Complex, LoopAnswer} from "../types.js" */
/** @import {PoleGroup} from "./pole-groups.js" */
/** @import {Api} from "../api.js" */

import { toInput } from "../format.js";
import { round125 } from "../plant/pace.js";
import { countOf, groupsOf, polesOf, trimmed } from "./pole-groups.js";

/**
 * @typedef {object} PlacementState
 * @property {string} plant
 * @property {PoleGroup[]} groups  none: the server chooses
 * @property {boolean} integrator
 * @property {"biproper" | "strictly_proper"} structure
 * @property {number | null} pade_order
 * @property {boolean} scaled  the setpoint is multiplied by 1/T(0)
 * @property {"setpoint" | "load"} signal
 */

/** @typedef {{Kc: number, tau_I: number | null, tau_D: number | null, alpha: number}} PIDSettings */

/**
 * @typedef {object} Placed
 * @property {{text: string, latex: string, mathml: string, num: number[], den: number[], zeros: Complex[], poles: Complex[], relative_degree: number, stable: boolean, because: string, integrators: number, pid: PIDSettings | null}} C
 * @property {Record<"A" | "B" | "L" | "P" | "D", number[]>} equation
 * @property {Complex[]} plant_poles  of the plant that the poles are placed for
 * @property {Complex[]} plant_zeros
 * @property {Complex[]} wanted
 * @property {Complex[]} added
 * @property {number} required
 * @property {number} residual
 * @property {number} condition
 * @property {Complex[]} closed_loop_poles
 * @property {number} pole_error
 * @property {"stable" | "marginal" | "unstable"} verdict
 * @property {string} because
 * @property {number | null} static_gain
 * @property {number | null} offset_pct
 * @property {number | null} reference_gain
 * @property {{theta: number, order: number} | null} approximation
 * @property {Record<string, string>} reasons
 */

/** @typedef {{design: Placed, loop: LoopAnswer, horizon: number}} PlacementAnswer */

const MAX_TEXT = 500;
const MOST_POLES = 50;
/** Time constants of the slowest pole that are shown. */
const SHOWN = 7;
const POINTS = 400;

export const PLACEMENT_PRESETS = [
  { name: "Two lags", teaches: "The example of the lecture: three poles to place, and an offset.", plant: "2/((s+1)(s+2))", poles: /** @type {Complex[]} */ ([[-2.5, 3.1225], [-2.5, -3.1225], [-40, 0]]) },
  { name: "Unstable", teaches: "One pole in the right half-plane: the poles you want must be faster.", plant: "1/((s-1)(s+2))", poles: null },
  { name: "Inverse response", teaches: "A zero in the right half-plane: fast poles cost margins.", plant: "(2-s)/((s+1)(s+3))", poles: null },
  { name: "Double integrator", teaches: "A mass that is pushed: a lead, and no offset.", plant: "1/s^2", poles: null },
  { name: "Oscillator", teaches: "Hardly damped: the poles can be put where they are damped well.", plant: "1/(s^2+0.2s+1)", poles: null },
];

/** @returns {PlacementState} */
export function startingPlacement() {
  const [first] = PLACEMENT_PRESETS;
  return { plant: first?.plant ?? "", groups: groupsOf(first?.poles ?? []), integrator: false, structure: "biproper", pade_order: null, scaled: false, signal: "setpoint" };
}

/** @param {PlacementState} state */
function placeRequest({ plant, groups, integrator, structure, pade_order }) {
  return { plant: { type: "expr", text: plant }, ...(groups.length > 0 ? { poles: polesOf(groups) } : {}), complete: true, integrator, structure, pade_order };
}

/** A time in which the slowest of the poles has died out. @param {Complex[]} poles */
export function horizonOf(poles) {
  const slowest = Math.min(...poles.map(([re, im]) => Math.max(Math.abs(re), 0.02 * Math.hypot(re, im))).filter((rate) => rate > 0));
  return Number.isFinite(slowest) ? round125(SHOWN / slowest) : 10;
}

/**
 * @param {Api} api
 * @param {PlacementState} state
 * @param {{moving: boolean, last: PlacementAnswer | null}} how
 * @returns {Promise<PlacementAnswer>}
 */
export async function place(api, state, { moving, last }) {
  /** @type {Placed} */
  let design = await api.analyse("pole-placement", placeRequest(state));
  if (countOf(state.groups) > design.required) design = await api.analyse("pole-placement", placeRequest({ ...state, groups: trimmed(state.groups, design.required) }));
  const { zeros, poles, num } = design.C;
  const horizon = moving && last ? last.horizon : horizonOf(design.wanted);
  const loop = await api.loop({
    loop: { plant: { type: "expr", text: state.plant }, controller: { type: "zpk", zeros, poles, k: num[0] } },
    want: ["step", "margins", "verdict", ...(moving ? [] : ["metrics", "sensitivity"])],
    horizon,
    points: POINTS,
  });
  return { design, loop, horizon };
}

/** @param {string} search @returns {PlacementState} */
export function placementFromQuery(search) {
  const query = new URLSearchParams(search);
  const start = startingPlacement();
  const plant = query.get("plant");
  const named = plant !== null && plant.trim() !== "" && plant.length <= MAX_TEXT;
  const poles = (query.get("poles") ?? "").split(";").map((text) => text.split(",").map(Number));
  const good = poles.every((pole) => pole.length <= 2 && pole.every(Number.isFinite)) && poles.length <= MOST_POLES;
  const groups = query.has("poles") && good ? groupsOf(poles.map(([re = 0, im = 0]) => [re, Math.abs(im)])) : named ? [] : start.groups;
  const order = Number(query.get("pade") ?? NaN);
  return {
    plant: named ? plant : start.plant,
    groups,
    integrator: query.get("integrator") === "1",
    structure: query.get("structure") === "strictly_proper" ? "strictly_proper" : "biproper",
    pade_order: Number.isInteger(order) && order >= 1 && order <= 8 ? order : null,
    scaled: query.get("scaled") === "1",
    signal: query.get("signal") === "load" ? "load" : "setpoint",
  };
}

/** @param {PlacementState} state */
export function placementToQuery({ plant, groups, integrator, structure, pade_order, scaled, signal }) {
  const query = new URLSearchParams({ plant, poles: groups.map(({ re, im }) => (im > 0 ? `${toInput(re)},${toInput(im)}` : toInput(re))).join(";") });
  if (integrator) query.set("integrator", "1");
  if (structure !== "biproper") query.set("structure", structure);
  if (pade_order !== null) query.set("pade", String(pade_order));
  if (scaled) query.set("scaled", "1");
  if (signal !== "setpoint") query.set("signal", signal);
  return query;
}

/** The same loop on the workbench, whose controller is a PID. @param {string} plant @param {PIDSettings} pid */
export function workbenchLink(plant, { Kc, tau_I, tau_D, alpha }) {
  const query = new URLSearchParams({ plant, type: `P${tau_I === null ? "" : "I"}${tau_D ? "D" : ""}`, Kc: toInput(Math.abs(Kc)) });
  if (tau_I !== null) query.set("tau_I", toInput(tau_I));
  if (tau_D) {
    query.set("tau_D", toInput(tau_D));
    query.set("alpha", toInput(alpha));
  }
  if (Kc < 0) query.set("action", "direct");
  return `/workbench?${query}`;
}

/** The same design in Python, by the equation itself. @param {Placed} design @param {string} plant */
export function pythonCode({ equation: { A, B, D }, C }, plant) {
  const list = (/** @type {number[]} */ values) => `[${values.map((value) => Number(value.toPrecision(12))).join(", ")}]`;
  const f = C.integrators > 0 ? "np.array([1, 0])  # what L must contain: s" : "np.array([1])     # what L must contain: nothing";
  return `# Poles of the loop with G = ${plant}, by A L + B P = D
import numpy as np
import control as ct

A, B = np.array(${list(A)}), np.array(${list(B)})
D = np.array(${list(D)})
F = ${f}

AF = np.convolve(A, F)
n, d = len(AF) - 1, len(D) - 1            # deg P < n, deg L = d - n

def shifts(a, columns):                   # a times s^(columns-1) ... 1
    rows = [np.pad(a, (d + 1 - len(a) - j, j)) for j in range(columns)]
    return np.array(rows[::-1]).T

x = np.linalg.solve(np.hstack([shifts(AF, d - n + 1), shifts(B, n)]), D)
L, P = np.convolve(F, x[: d - n + 1]), x[d - n + 1 :]

C, G = ct.tf(P, L), ct.tf(B, A)           # C = P/L
print(C, ct.poles(ct.feedback(C * G)))    # the poles that were wanted
`;
}
