/** The Smith predictor page: what it is set to, what it asks, and how that stands in the address. */

/** @import {Api} from "../api.js" */
/** @import {ComparedRow} from "../workbench/analysis-types.js" */

import { toInput } from "../format.js";

/** @typedef {"K" | "tau" | "theta"} MismatchAxis */
/** @typedef {"theta_K" | "theta_tau" | "K_tau"} Plane */
/** @typedef {"smith" | "PI" | "PID"} LoopName */

/**
 * @typedef {object} SmithState
 * @property {string} model
 * @property {Record<MismatchAxis, number>} mismatch  of the plant against the model, in per cent
 * @property {number} Ms
 * @property {Plane} plane
 * @property {"setpoint" | "load"} signal
 */

/**
 * @typedef {object} SmithRow
 * @property {LoopName} name
 * @property {boolean} valid
 * @property {string | null} reason
 * @property {{Kc: number, tau_I: number | null, tau_D: number | null} | null} controller
 * @property {number | null} Ms_nominal
 * @property {boolean | null} closed_loop_stable
 * @property {ComparedRow["margins"]} margins
 * @property {ComparedRow["setpoint"]} setpoint
 * @property {ComparedRow["load"]} load
 * @property {ComparedRow["responses"]} responses
 * @property {{K: [number, number] | null, theta: [number, number] | null, reasons: Record<string, string>} | null} tolerates
 */

/**
 * @typedef {object} SmithRegion
 * @property {MismatchAxis} along
 * @property {MismatchAxis} across
 * @property {[number, number]} along_range
 * @property {[number, number]} across_range
 * @property {number[]} rows
 * @property {{name: LoopName, intervals: [number, number][][] | null, reason: string | null}[]} loops
 */

/**
 * @typedef {object} SmithAnswer
 * @property {{text: string, mathml: string}} model
 * @property {{text: string, mathml: string}} plant
 * @property {{how: string, tau_c: number | null, Ms: number | null, on_limit: boolean | null}} tuning
 * @property {number} horizon
 * @property {SmithRow[]} rows
 * @property {string[]} notes
 * @property {SmithRegion | null} region
 * @property {string} regionKey  what the region was asked for
 */

const MAX_TEXT = 500;
const REGION_ROWS = 61;
const POINTS = { moving: 200, rest: 400 };
/** Per cent either way, as the server bounds the factors. @type {Record<MismatchAxis, {min: number, max: number}>} */
export const MISMATCH = { K: { min: -95, max: 200 }, tau: { min: -80, max: 200 }, theta: { min: -100, max: 200 } };
export const MS = { min: 1.05, max: 2 };
/** @type {MismatchAxis[]} */
export const AXES = ["K", "tau", "theta"];
/** @type {Record<Plane, {along: MismatchAxis, across: MismatchAxis, third: MismatchAxis}>} */
export const PLANES = {
  theta_K: { along: "theta", across: "K", third: "tau" },
  theta_tau: { along: "theta", across: "tau", third: "K" },
  K_tau: { along: "K", across: "tau", third: "theta" },
};
/** @type {Record<LoopName, {label: string, signal: string, name: string}>} */
export const LOOPS = {
  smith: { label: "Smith", signal: "now", name: "PI with the Smith predictor" },
  PI: { label: "best PI", signal: "case_1", name: "the best PI of the same Ms" },
  PID: { label: "best PID", signal: "case_2", name: "the best PID of the same Ms" },
};

export const SMITH_PRESETS = [
  { name: "Long dead time", teaches: "Twice as long as the lag: what the predictor is made for.", model: "exp(-4s)/(2s+1)", Ms: 1.6, signal: /** @type {const} */ ("setpoint") },
  { name: "Short dead time", teaches: "A fifth of the lag: there is little to gain.", model: "exp(-s)/(5s+1)", Ms: 1.6, signal: /** @type {const} */ ("setpoint") },
  { name: "Integrating", teaches: "A load leaves an offset: the known failure.", model: "0.5 exp(-2s)/s", Ms: 1.5, signal: /** @type {const} */ ("load") },
  { name: "Unstable", teaches: "The predictor hides the unstable pole: it cannot work.", model: "2 exp(-0.2s)/(s-1)", Ms: 2, signal: /** @type {const} */ ("load") },
];

/** @returns {SmithState} */
export function startingSmith() {
  const [first] = SMITH_PRESETS;
  return { model: first?.model ?? "", mismatch: { K: 0, tau: 0, theta: 20 }, Ms: 1.6, plane: "theta_K", signal: "setpoint" };
}

/** @param {number} pct */
export const factorOf = (pct) => 1 + pct / 100;
/** @param {number} factor */
export const pctOf = (factor) => 100 * (factor - 1);

/**
 * While something moves the loops alone; the region at rest, where it is another one.
 * @param {Api} api
 * @param {SmithState} state
 * @param {{moving: boolean, last: SmithAnswer | null}} how
 * @returns {Promise<SmithAnswer>}
 */
export async function judge(api, { model, mismatch, Ms, plane }, { moving, last }) {
  const key = JSON.stringify([model, Ms, plane, mismatch[PLANES[plane].third]]);
  const known = last?.regionKey === key;
  /** @type {SmithAnswer} */
  const answer = await api.analyse("smith", {
    model: { type: "expr", text: model },
    mismatch: { K: factorOf(mismatch.K), tau: factorOf(mismatch.tau), theta: factorOf(mismatch.theta) },
    Ms_limit: Ms,
    plane,
    want: moving || known ? ["loops"] : ["loops", "region"],
    region_rows: REGION_ROWS,
    points: moving ? POINTS.moving : POINTS.rest,
  });
  return answer.region ? { ...answer, regionKey: key } : { ...answer, region: last?.region ?? null, regionKey: last?.regionKey ?? "" };
}

/** @param {string} search @returns {SmithState} */
export function smithFromQuery(search) {
  const query = new URLSearchParams(search);
  const start = startingSmith();
  /** @param {string} name @param {number} otherwise @param {{min: number, max: number}} limits */
  const number = (name, otherwise, { min, max }) => {
    const raw = query.get(name);
    const value = raw === null || raw.trim() === "" ? NaN : Number(raw);
    return Number.isFinite(value) && value >= min && value <= max ? value : otherwise;
  };
  const model = query.get("model");
  const plane = query.get("plane");
  return {
    model: model !== null && model.trim() !== "" && model.length <= MAX_TEXT ? model : start.model,
    mismatch: { K: number("K", 0, MISMATCH.K), tau: number("tau", 0, MISMATCH.tau), theta: number("theta", query.has("model") ? 0 : start.mismatch.theta, MISMATCH.theta) },
    Ms: number("Ms", start.Ms, MS),
    plane: plane === "theta_tau" || plane === "K_tau" ? plane : "theta_K",
    signal: query.get("signal") === "load" ? "load" : "setpoint",
  };
}

/** @param {SmithState} state */
export function smithToQuery({ model, mismatch, Ms, plane, signal }) {
  const query = new URLSearchParams({ model });
  for (const axis of AXES) if (mismatch[axis] !== 0) query.set(axis, toInput(mismatch[axis]));
  if (Ms !== startingSmith().Ms) query.set("Ms", toInput(Ms));
  if (plane !== "theta_K") query.set("plane", plane);
  if (signal !== "setpoint") query.set("signal", signal);
  return query;
}
