/** The page of several loops: its state with undo, and what each route is asked. Loops, inputs and outputs count from 0 here, from 1 in requests. */

/** @import {MatrixEntry} from "../plant/types.js" */

import { parseNumber } from "../format.js";

/** @typedef {{type: "P" | "PI" | "PID", Kc: number, tau_I: number, tau_D: number, action: "reverse" | "direct", mode: "auto" | "manual"}} MimoLoop */
/** @typedef {{kind: "setpoint" | "load", loop: number, size: number}} MimoTest */
/**
 * @typedef {object} MimoState
 * @property {string} plant  id of the library, or nothing for a matrix of one's own
 * @property {string[][]} entries  as they are typed
 * @property {string} timeUnit  of a matrix of one's own
 * @property {number[]} pairing  input of each output
 * @property {MimoLoop[]} loops
 * @property {"none" | "static" | "dynamic"} decoupler
 * @property {"drop" | "wait"} prediction
 * @property {MimoTest} test
 * @property {number} seen  the loop that is looked at with the others open and closed
 */
/** @typedef {{name: string, unit: string, meaning: string}} MimoSignal */
/** @typedef {{timeUnit: string, inputs: MimoSignal[], outputs: MimoSignal[]}} MimoAbout */
/** @typedef {{moving: boolean, design: boolean, view: boolean}} MimoChange */
/** @typedef {ReturnType<typeof createMimoStore>} MimoStore */

const UNDO_DEPTH = 100;
export const FIRST_PLANT = "wood-berry";
/** @type {MimoLoop} */
export const FIRST_LOOP = { type: "PI", Kc: 1, tau_I: 10, tau_D: 1, action: "reverse", mode: "auto" };

/** @param {number} n @returns {MimoState} */
export function blankState(n = 2) {
  const all = Array.from({ length: n }, (_, i) => i);
  return {
    plant: FIRST_PLANT,
    entries: all.map((i) => all.map((j) => (i === j ? "1, 5, 1" : "0.5, 5, 1"))),
    timeUnit: "s",
    pairing: all,
    loops: all.map(() => FIRST_LOOP),
    decoupler: "none",
    prediction: "drop",
    test: { kind: "setpoint", loop: 0, size: 1 },
    seen: 0,
  };
}

/** @param {MimoState} initial */
export function createMimoStore(initial) {
  let state = initial;
  let rest = initial;
  /** @type {MimoState[]} */
  let past = [];
  /** @type {MimoState[]} */
  let future = [];
  /** @type {MimoAbout} */
  let about = { timeUnit: initial.timeUnit, inputs: [], outputs: [] };
  /** @type {Set<(state: MimoState, change: MimoChange) => void>} */
  const listeners = new Set();

  /** @param {boolean} moving */
  function tell(moving) {
    for (const listener of [...listeners]) listener(state, { moving, design: true, view: false });
  }

  /** @param {MimoState} next */
  function goTo(next) {
    state = rest = next;
    tell(false);
  }

  return {
    get: () => state,
    get about() {
      return about;
    },
    /** What the server calls the signals. @param {MimoAbout} next */
    name(next) {
      if (JSON.stringify(next) === JSON.stringify(about)) return;
      about = next;
      tell(false);
    },
    /** @param {Partial<MimoState>} patch @param {{moving?: boolean}} [how] */
    set(patch, { moving = false } = {}) {
      state = { ...state, ...patch };
      if (!moving && JSON.stringify(rest) !== JSON.stringify(state)) {
        past = [...past, rest].slice(-UNDO_DEPTH);
        future = [];
        rest = state;
      }
      tell(moving);
    },
    /** @param {number} index @param {Partial<MimoLoop>} patch @param {{moving?: boolean}} [how] */
    setLoop(index, patch, how) {
      const loop = state.loops[index];
      if (loop) this.set({ loops: state.loops.with(index, { ...loop, ...patch }) }, how);
    },
    get canUndo() {
      return past.length > 0;
    },
    get canRedo() {
      return future.length > 0;
    },
    undo() {
      const previous = past.at(-1);
      if (!previous) return;
      past = past.slice(0, -1);
      future = [...future, rest];
      goTo(previous);
    },
    redo() {
      const next = future.at(-1);
      if (!next) return;
      future = future.slice(0, -1);
      past = [...past, rest];
      goTo(next);
    },
    /** @param {(state: MimoState, change: MimoChange) => void} listener */
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}

/** An entry of the library as it would be typed. @param {MatrixEntry} entry */
export function entryText({ K, leads, lags, theta }) {
  const product = (/** @type {number[]} */ times) => times.map((time) => `(${time}s+1)`).join("");
  const delay = theta ? `exp(-${theta === 1 ? "" : theta}s)` : "";
  const bottom = lags.length > 1 ? `/(${product(lags)})` : lags.length === 1 ? `/${product(lags)}` : "";
  return `${K}${product(leads)}${delay}${bottom}`;
}

/** What is typed as a system: three numbers are K, tau and theta. @param {string} text */
function systemOf(text) {
  const numbers = text.split(",").map((part) => parseNumber(part));
  const [K, tau, theta] = numbers;
  if (numbers.length === 3 && K && tau && theta !== null && theta !== undefined) return { type: "fopdt", K, tau, theta };
  return { type: "expr", text };
}

/** @param {MimoState} state */
export function plantRequest({ plant, entries, timeUnit }) {
  return plant ? { type: "plant", id: plant } : { type: "matrix", entries: entries.map((row) => row.map(systemOf)), time_unit: timeUnit };
}

/** @param {MimoState} state */
export const pairedRequest = (state) => ({ plant: plantRequest(state), pairing: state.pairing.map((j) => j + 1) });

/** @param {MimoState} state */
export function loopsRequest(state) {
  const loops = state.loops.map(({ type, Kc, tau_I: tauI, tau_D: tauD, action, mode }) => ({
    controller: { type: "pid", Kc, tau_I: type === "P" ? null : tauI, tau_D: type === "PID" ? tauD : null, action },
    mode,
  }));
  return { ...pairedRequest(state), loops, decoupler: state.decoupler, prediction: state.prediction };
}

/** Of a loop in manual it is the controller's output that steps. @param {MimoState} state */
export function testOf({ test, loops }) {
  return { ...test, kind: test.kind === "setpoint" && loops[test.loop]?.mode === "manual" ? "manual" : test.kind };
}

/** Settings as the tuning route gives them. @param {MimoLoop} loop @param {{Kc: number, tau_I: number | null, tau_D: number | null}} settings @returns {MimoLoop} */
export function tunedLoop(loop, { Kc, tau_I: tauI, tau_D: tauD }) {
  // Three digits are as many as a rule is worth.
  const short = (/** @type {number} */ value) => Number(value.toPrecision(3));
  return { ...loop, type: tauD ? "PID" : tauI === null ? "P" : "PI", Kc: short(Math.abs(Kc)), action: Kc < 0 ? "direct" : "reverse", tau_I: short(tauI ?? loop.tau_I), tau_D: short(tauD ?? loop.tau_D) };
}
