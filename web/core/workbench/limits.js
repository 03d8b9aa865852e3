/** What the Limits analysis is told of the loop's surroundings, what it asks, and what its limits are called. */

/** @import {LimitsView, State} from "../types.js" */

import { parseList } from "../lists.js";
import { loopOf } from "./loop.js";

export const MODEL_ERROR = { min: 0, max: 90 };
const OPTIONAL = /** @type {const} */ (["u_limit", "noise_omega", "load_error"]);

/** In the order they are listed and drawn. @type {Record<string, string>} */
export const LIMIT_NAMES = {
  pole: "Unstable pole",
  load: "Load",
  zero: "RHP zero",
  dead_time: "Dead time",
  actuator: "Actuator",
  mismatch: "Model error",
  noise: "Noise",
};

/** @returns {LimitsView} */
export function startingLimits() {
  return { u_limit: null, noise_omega: null, load_error: null, spread_pct: 20 };
}

/** @param {URLSearchParams} query @param {LimitsView} limits */
export function limitsToQuery(query, limits) {
  for (const name of OPTIONAL) if (limits[name] !== null) query.set(`limits.${name}`, String(limits[name]));
  if (limits.spread_pct !== startingLimits().spread_pct) query.set("limits.spread_pct", String(limits.spread_pct));
}

/** @param {URLSearchParams} query @returns {LimitsView} */
export function limitsFromQuery(query) {
  const found = startingLimits();
  const number = (/** @type {string} */ name) => parseList(query.get(`limits.${name}`) ?? "")?.[0];
  for (const name of OPTIONAL) {
    const value = number(name);
    if (value !== undefined && value > 0) found[name] = value;
  }
  const spread = number("spread_pct");
  if (spread !== undefined && spread >= MODEL_ERROR.min && spread <= MODEL_ERROR.max) found.spread_pct = spread;
  return found;
}

/** @param {State} state */
export function limitsRequest(state) {
  const { spread_pct, ...demands } = state.view.analyses.limits;
  return { loop: loopOf(state), ...demands, spread: { K_pct: spread_pct, tau_pct: spread_pct, theta_pct: spread_pct }, arrays: "f4" };
}
