/** The tuned controller on the model, as promised, and on the plant itself: curves and figures of both. */

/** @import {Api} from "../api.js" */
/** @import {ComparedRow} from "../workbench/analysis-types.js" */
/** @import {About, Model, Setting} from "./types.js" */
/** @import {TuneSetting} from "../types.js" */

import { controllerOf, controlRequest, filledIn, LOOP_POINTS, systemOf } from "./requests.js";

const METRICS = /** @type {const} */ (["overshoot_pct", "t_rise", "t_settle", "IAE", "TV"]);
const MARGINS = /** @type {const} */ (["GM_dB", "PM_deg", "Ms"]);

/** @typedef {{t: number[], y: number[], u: number[]}} Curve */
/** @typedef {{curve: Curve, stable: boolean | null, values: Record<string, number | null>, reasons: Record<string, string>, cut: string | null}} Side */
/** @typedef {{setpoint: Side | null, load: Side | null}} Sides */
/** @typedef {{promised: Sides | null, true_: Sides | null, reason: string | null, horizon: number}} PromisedRun  reason: why there is no promise */

/**
 * A row of /compare in the units of the plant: a step of `size` about where it rests.
 * @param {ComparedRow} row @param {{size: number, y: number, u: number}} at
 * @returns {Sides | null}
 */
function sidesOf({ responses, setpoint, load, margins, closed_loop_stable }, { size, y, u }) {
  if (!responses || !setpoint || !load || !margins) return null;
  /** @param {"setpoint" | "load"} name @param {Record<string, any>} metrics @returns {Side} */
  const side = (name, metrics) => {
    const response = responses[name];
    const values = Object.fromEntries([...METRICS.map((key) => [key, metrics[key] ?? null]), ...MARGINS.map((key) => [key, closed_loop_stable ? margins[key] : null])]);
    for (const key of ["IAE", "TV"]) if (values[key] !== null) values[key] *= Math.abs(size);
    return {
      curve: { t: [...response.t], y: [...response.y].map((value) => y + size * value), u: [...response.u].map((value) => u + size * value) },
      stable: closed_loop_stable,
      values,
      reasons: { ...metrics["reasons"], ...margins.reasons },
      cut: response.truncated_reason,
    };
  };
  return { setpoint: side("setpoint", setpoint), load: side("load", load) };
}

/**
 * @param {Api} api @param {Setting} setting @param {About | null} about  null where no plant stands behind the record
 * @param {Model | null} model @param {TuneSetting} tuned
 * @returns {Promise<PromisedRun>}
 */
export async function runBoth(api, setting, about, model, tuned) {
  const entries = [{ label: "tuned", controller: controllerOf(tuned) }];
  const ask = (/** @type {any} */ plant, /** @type {number | null} */ horizon) => api.analyse("compare", { plant, entries, horizon, points: LOOP_POINTS });
  const library = about !== null && setting.plant.kind === "library";
  const at = { size: library ? filledIn(setting.experiment, setting.plant, about).change : 1, y: library ? about.level : 0, u: library ? about.u0 : 0 };
  /** @type {Sides | null} */
  let true_ = null;
  let horizon = 0;
  if (about && !library) {
    const answer = await ask(systemOf(setting.plant), null);
    ({ horizon } = answer);
    if (answer.rows[0].reason) throw Object.assign(new Error(answer.rows[0].reason), { hint: null });
    true_ = sidesOf(answer.rows[0], at);
  }
  /** @type {Sides | null} */
  let promised = null;
  /** @type {string | null} */
  let reason = model ? null : "without a model there is no promise: the rule started from the ultimate point alone";
  if (model) {
    const answer = await ask(model.system, horizon || null);
    promised = sidesOf(answer.rows[0], at);
    reason = answer.rows[0].reason;
    horizon ||= answer.horizon;
  }
  if (library) {
    horizon ||= 15 * about.scale;
    const answer = await api.workOut(setting.plant.id, "control", controlRequest(setting, about, tuned, horizon));
    const [{ metrics, output, u }] = answer.loops;
    // Its TV begins after the first jump of u, that of the promise before it: the two are no pair.
    const { reasons, ...values } = metrics;
    values.TV = null;
    if (promised?.setpoint) promised.setpoint.values["TV"] = null;
    true_ = { setpoint: { curve: { t: answer.t, y: answer.outputs[output], u }, stable: null, values, reasons, cut: answer.truncated_reason }, load: null };
  }
  return { promised, true_, reason, horizon };
}
