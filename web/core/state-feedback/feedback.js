/** What the state feedback page is set to: its defaults, its requests, its address, and its words. */

/** @import {Complex} from "../types.js" */

import { ENDLESS, profileOf } from "./plants.js";
import { formatNumber, formatWithUnit, sentence } from "../format.js";
import { parseMatrix } from "../lists.js";

/** @typedef {{A: number[][], B: number[][], C: number[][], D: number[][]}} FeedbackMatrices */

/**
 * @typedef {object} FeedbackState
 * @property {string} plant
 * @property {FeedbackMatrices} matrices
 * @property {"poles" | "lqr"} method
 * @property {Complex[]} poles  empty: those that the regulator gives
 * @property {number[]} weights  of the states, in units of their sizes; that of the integral last
 * @property {number} effort  weight of the input
 * @property {boolean} observer
 * @property {number} speed  of the observer, in poles of the feedback
 * @property {boolean} integral
 * @property {number} setpoint  deviation
 * @property {Record<string, number>} start  deviations of states
 * @property {number | null} limit
 * @property {boolean} endless
 */

/** @typedef {{name: string, unit: string, meaning: string, value: number}} FeedbackSignal */
/** @typedef {{desired: Complex[] | null, obtained: Complex[], error: number | null, condition: number | null, kept: Complex[], residual: number | null}} GainFound */
/** @typedef {{time_unit: string, states: FeedbackSignal[], inputs: FeedbackSignal[], outputs: FeedbackSignal[], A: number[][], B: number[][], poles: Complex[], K: number[][], K_I: number[][] | null, N: number[][] | null, N_reason: string | null, L: number[][] | null, feedback: GainFound, observer: GainFound | null, closed_loop_poles: Complex[], closed_loop_stable: boolean, separation_error: number, margins: any, margins_reason: string | null}} FeedbackDesign */
/** @typedef {Record<string, number[]>} Columns */
/** @typedef {{t: number[], states: Columns, outputs: Columns, inputs: Columns, estimates: Columns | null}} LinearRun */
/** @typedef {LinearRun & {commands: Columns, events: {name: string, message: string, t: number}[], outcome: string, truncated_at: number | null, truncated_reason: string | null}} NonlinearRun */
/** @typedef {{time_unit: string, horizon: number, linear: LinearRun | null, linear_reason: string | null, nonlinear: NonlinearRun | null}} FeedbackRun */
/** @typedef {{size: number, start: number, duration: number}} PushNow */

/** An oscillator, to begin with. */
const MATRICES = { A: [[0, 1], [-1, 0]], B: [[0], [1]], C: [[1, 0]], D: [[0]] };
const FIRST_TILT = 15;
/** How long a run goes on after the last push. */
const AFTER_PUSH = 5;
/** What is seen of a run after it has failed. */
const AFTERMATH = 0.6;
export const MOST_PUSHES = 8;
const FREE = 1e6;

/** @param {string} plant @returns {FeedbackState} */
export function defaultFeedback(plant = "cart-pendulum") {
  const profile = profileOf(plant);
  const [tilt] = profile.tilts;
  /** @type {Record<string, number>} */
  const start = {};
  if (tilt) start[tilt.state] = tilt.state === "phi" ? FIRST_TILT / tilt.factor : (0.4 * tilt.max) / tilt.factor;
  if (profile.id === "matrices") start["x1"] = 1;
  return { plant: profile.id, matrices: MATRICES, method: profile.poles ? "poles" : "lqr", poles: profile.poles ?? [], weights: [], effort: 1, observer: false, speed: 4, integral: false, setpoint: 0, start, limit: profile.limit?.value ?? null, endless: false };
}

/** How many states the plant has, as far as it is known without asking. @param {FeedbackState} state */
export function stateCount(state) {
  return state.plant === "matrices" ? state.matrices.A.length : Object.keys(profileOf(state.plant).sizes).length;
}

/** Weights for every state that has none yet. @param {FeedbackState} state */
export function weightsOf(state) {
  const count = stateCount(state) + (state.integral ? 1 : 0);
  return Array.from({ length: count }, (_, i) => state.weights[i] ?? 1);
}

/** What is asked for the design. @param {FeedbackState} state */
export function designRequest(state) {
  const profile = profileOf(state.plant);
  const sizes = [...Object.values(profile.sizes)];
  const plant =
    state.plant === "matrices"
      ? { type: "ss", ...state.matrices }
      : { type: "plant", id: profile.id, operating_point: profile.point, actuators: profile.actuators, parameters: profile.endless && state.endless ? { [profile.endless]: ENDLESS } : {} };
  const held = sizes[Object.keys(profile.sizes).indexOf(profile.controlled)] ?? 1;
  const Q = weightsOf(state).map((weight, i) => weight / (sizes[i] ?? held) ** 2);
  const inputs = state.plant === "matrices" ? (state.matrices.B[0]?.length ?? 1) : 1;
  const R = Array.from({ length: inputs }, () => state.effort / profile.effort ** 2);
  return {
    plant,
    gain: state.method === "poles" && state.poles.length > 0 ? { method: "poles", poles: state.poles } : { method: "lqr", Q, R },
    observer: state.observer ? { method: "faster", speed: state.speed } : null,
    controlled: [profile.controlled],
    integral: state.integral,
  };
}

/** How long a run is. @param {FeedbackState} state @param {FeedbackDesign} design @param {PushNow[]} pushes */
export function horizonOf(state, design, pushes) {
  const slowest = Math.max(...design.closed_loop_poles.map(([re]) => re));
  const own = profileOf(state.plant).horizon ?? (slowest < -1e-6 ? Math.min(1e4, 8 / -slowest) : 20);
  return Math.max(own, ...pushes.map(({ start }) => start + (AFTER_PUSH / 6) * own));
}

/**
 * @param {FeedbackState} state
 * @param {FeedbackDesign} design
 * @param {PushNow[]} pushes
 * @param {{free?: boolean, endless?: boolean, seen?: boolean}} [instead]  without the limit of the input, without the end of the track, without the observer
 */
export function runRequest(state, design, pushes, instead = {}) {
  const profile = profileOf(state.plant);
  const output = design.outputs.find(({ name }) => name === profile.controlled);
  const limit = instead.free ? FREE : state.limit;
  const input = design.inputs[0]?.name ?? "";
  return {
    ...designRequest({ ...state, endless: state.endless || instead.endless === true, observer: state.observer && !instead.seen }),
    horizon: horizonOf(state, design, pushes),
    points: 601,
    initial: Object.fromEntries(design.states.filter(({ name }) => state.start[name]).map(({ name, value }) => [name, value + (state.start[name] ?? 0)])),
    setpoints: output && state.setpoint ? { [output.name]: output.value + state.setpoint } : {},
    limits: limit !== null && profile.limit ? { [input]: [-limit, limit] } : {},
    pushes,
  };
}

/** What is asked for the rows of the map. @param {FeedbackState} state @param {FeedbackDesign} design @param {{columns: number, rows: [number, number, number]}} grid  rows: first and last value and how many */
export function mapRequest(state, design, { columns, rows: [low, high, count] }) {
  const map = profileOf(state.plant).map;
  if (!map) throw new Error("this plant has no map");
  const { limits, horizon, initial: _, points: __, setpoints: ___, pushes: ____, ...same } = runRequest({ ...state, setpoint: 0 }, design, []);
  const at = (/** @type {string} */ name) => design.states.find((each) => each.name === name)?.value ?? 0;
  const [x, y] = map;
  return {
    ...same,
    horizon,
    limits,
    horizontal: { state: x.state, low: at(x.state) + x.low, high: at(x.state) + x.high, count: columns },
    vertical: { state: y.state, low: at(y.state) + low, high: at(y.state) + high, count },
  };
}

/** The last moment of a run that is worth seeing. @param {FeedbackRun} run */
export function endOf({ nonlinear, linear, horizon }) {
  const t = nonlinear?.t ?? linear?.t ?? [0, horizon];
  const end = t.at(-1) ?? horizon;
  const failed = nonlinear && nonlinear.outcome !== "caught" ? nonlinear.events[0]?.t : undefined;
  return failed === undefined ? end : Math.min(end, failed + AFTERMATH);
}

/** @param {number[]} values */
const largest = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);

/** How a run has ended, in a sentence. @param {FeedbackState} state @param {FeedbackDesign} design @param {FeedbackRun} run */
export function verdictOf(state, design, run) {
  const found = run.nonlinear;
  const { time_unit: unit } = design;
  if (!found) return { kind: design.closed_loop_stable ? "good" : "bad", head: design.closed_loop_stable ? "It comes to rest." : "It runs away.", text: "The loop is linear: what it does from one start it does from every start." };
  const input = design.inputs[0];
  const force = largest((found.inputs[input?.name ?? ""] ?? []).map((value) => value - (input?.value ?? 0)));
  const at = state.limit !== null && force >= state.limit * (1 - 1e-9) ? ` The force was at its limit of ${formatWithUnit(state.limit, input?.unit ?? "", 3)}.` : "";
  if (found.outcome === "caught") {
    const held = design.outputs.find(({ name }) => name === profileOf(state.plant).controlled);
    const moved = largest((found.outputs[held?.name ?? ""] ?? []).map((value) => value - (held?.value ?? 0)));
    return { kind: "good", head: "Caught.", text: `${held?.name ?? ""} moved by up to ${formatWithUnit(moved, held?.unit ?? "")}, ${input?.name ?? ""} by up to ${formatWithUnit(force, input?.unit ?? "")}.${at}` };
  }
  const [event] = found.events;
  if (event) return { kind: "bad", head: "Lost.", text: `${sentence(event.message).replace(/\.$/, "")} after ${formatNumber(event.t, 2)} ${unit}.${at}` };
  if (found.truncated_reason) return { kind: "bad", head: "Lost.", text: `${sentence(found.truncated_reason)}${at}` };
  return { kind: "open", head: "Not yet at rest.", text: `It still moves after ${formatNumber(run.horizon, 2)} ${unit}.${at}` };
}

/** Poles as people type them: "-2+1i, -2-1i, -5". @param {string} text @returns {Complex[] | null} */
export function parsePoles(text) {
  const parts = text.replaceAll("−", "-").replace(/\s*([+-])\s*(?=[\d.]*\s*[ij])/g, "$1").split(/[,;\s]+/).filter((part) => part !== "");
  /** @type {Complex[]} */
  const poles = [];
  for (const part of parts) {
    const found = /^([+-]?[\d.]+(?:e[+-]?\d+)?)?(?:([+-]?[\d.]*)[ij])?$/i.exec(part);
    if (!found || (found[1] === undefined && found[2] === undefined)) return null;
    const [re, im] = [Number(found[1] ?? 0), found[2] === undefined ? 0 : /\d/.test(found[2]) ? Number(found[2]) : found[2] === "-" ? -1 : 1];
    if (!Number.isFinite(re) || !Number.isFinite(im)) return null;
    poles.push([re, im]);
  }
  return poles.length > 0 ? poles : null;
}

/** @param {Complex[]} poles */
export function polesLine(poles) {
  const short = (/** @type {number} */ value) => String(Number(value.toPrecision(4)));
  return poles.map(([re, im]) => (im === 0 ? short(re) : `${short(re)}${im < 0 ? "-" : "+"}${short(Math.abs(im))}i`)).join(", ");
}

/** @type {Record<string, string>} */
const GREEK = { phi: "φ", omega: "ω" };

/** A state's name as it is written. @param {string} name */
export function written(name) {
  return GREEK[name] ?? name;
}

/** The same with signs as they are printed. @param {Complex[]} poles */
export function polesText(poles) {
  return polesLine(poles).replaceAll("-", "−");
}

/** @param {FeedbackState} state */
export function toQuery(state) {
  const plain = defaultFeedback(state.plant);
  const query = new URLSearchParams();
  /** @param {string} name @param {unknown} value @param {unknown} usual */
  const put = (name, value, usual) => {
    if (JSON.stringify(value) !== JSON.stringify(usual)) query.set(name, String(value));
  };
  put("plant", state.plant, "cart-pendulum");
  if (state.plant === "matrices") for (const [name, matrix] of Object.entries(state.matrices)) put(name, matrix.map((row) => row.join(" ")).join(";"), plain.matrices[/** @type {"A"} */ (name)].map((row) => row.join(" ")).join(";"));
  put("method", state.method, plain.method);
  if (state.method === "poles") put("poles", polesLine(state.poles).replaceAll(", ", ","), polesLine(plain.poles).replaceAll(", ", ","));
  put("weights", state.weights.join(","), "");
  put("effort", state.effort, plain.effort);
  put("observer", state.observer ? state.speed : 0, 0);
  put("integral", state.integral ? 1 : 0, 0);
  put("setpoint", state.setpoint, plain.setpoint);
  const names = new Set([...Object.keys(state.start), ...Object.keys(plain.start)]);
  for (const name of names) put(`start.${name}`, Number((state.start[name] ?? 0).toPrecision(5)), Number((plain.start[name] ?? 0).toPrecision(5)));
  put("limit", state.limit, plain.limit);
  put("endless", state.endless ? 1 : 0, 0);
  return query.toString().replace(/%2C/g, ",");
}

/** @param {string} search @returns {FeedbackState} */
export function fromQuery(search) {
  const query = new URLSearchParams(search);
  const state = defaultFeedback(query.get("plant") ?? undefined);
  const number = (/** @type {string} */ name) => (query.has(name) && Number.isFinite(Number(query.get(name))) ? Number(query.get(name)) : null);
  if (state.plant === "matrices") {
    const matrices = Object.fromEntries(["A", "B", "C", "D"].flatMap((name) => {
      const matrix = query.has(name) ? parseMatrix((query.get(name) ?? "").replaceAll(";", "\n")) : null;
      return matrix ? [[name, matrix]] : [];
    }));
    state.matrices = { ...state.matrices, ...matrices };
  }
  const method = query.get("method");
  if (method === "lqr" || method === "poles") state.method = method;
  state.poles = parsePoles(query.get("poles") ?? "") ?? state.poles;
  state.weights = (query.get("weights") ?? "").split(",").filter((part) => part !== "").map(Number).filter((value) => value >= 0);
  state.effort = number("effort") || state.effort;
  const speed = number("observer");
  if (speed) Object.assign(state, { observer: true, speed });
  state.integral = number("integral") === 1;
  state.setpoint = number("setpoint") ?? state.setpoint;
  for (const [name, value] of query) if (name.startsWith("start.") && Number.isFinite(Number(value))) state.start[name.slice(6)] = Number(value);
  state.limit = number("limit") ?? state.limit;
  state.endless = number("endless") === 1;
  return state;
}
