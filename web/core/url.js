/** State <-> query string. The keys are the API's own names, so that a link can be written by hand. */

/** @import {ControllerState, State, System, View} from "./types.js" */

import { analysesFromQuery, analysesToQuery } from "./workbench/analyses.js";
import { toInput } from "./format.js";
import { matrixLine, parseMatrix } from "./lists.js";

const MAX_TEXT = 500;
const TYPES = ["P", "PI", "PD", "PID"];
const MATRICES = /** @type {const} */ (["A", "B", "C", "D"]);
const FORMS = ["ideal", "series", "parallel"];

/** @param {State} state @returns {string} without the leading "?" */
export function toQuery({ plant, controller, actuator, sensor, horizon, view }) {
  const query = new URLSearchParams();
  if (plant.type === "expr") query.set("plant", plant.text);
  else {
    query.set("plant", plant.type);
    if (plant.type === "ss") for (const name of MATRICES) query.set(name, matrixLine(plant[name]));
    for (const [name, value] of Object.entries(plant)) if (typeof value === "number") query.set(name, toInput(value));
  }
  query.set("type", controller.type);
  if (controller.form !== "ideal") query.set("form", controller.form);
  query.set("Kc", toInput(controller.Kc));
  query.set("tau_I", toInput(controller.tau_I));
  query.set("tau_D", toInput(controller.tau_D));
  if (controller.alpha !== 0.1) query.set("alpha", toInput(controller.alpha));
  if (controller.beta !== 1) query.set("beta", toInput(controller.beta));
  if (controller.action !== "reverse") query.set("action", controller.action);
  if (actuator.trim() !== "") query.set("actuator", actuator);
  if (sensor.trim() !== "") query.set("sensor", sensor);
  if (horizon !== null) query.set("horizon", toInput(horizon));
  if (view.signal !== "setpoint") query.set("signal", view.signal);
  if (view.show.length > 0) query.set("show", view.show.join(","));
  analysesToQuery(query, view.analyses);
  // Commas and slashes are legal in a query; escaped they make the link unreadable.
  return query.toString().replace(/%2C/g, ",").replace(/%3B/g, ";").replace(/%2F/g, "/").replace(/%28/g, "(").replace(/%29/g, ")").replace(/%5E/g, "^");
}

/**
 * What the query says, laid over `fallback`; anything it does not say well is left as it was.
 * @param {string} search
 * @param {State} fallback
 * @param {string[]} plots  names that `show` may hold
 * @returns {State}
 */
export function fromQuery(search, fallback, plots) {
  const query = new URLSearchParams(search);
  /** @param {string} name @param {number} otherwise @param {(v: number) => boolean} [ok] */
  const number = (name, otherwise, ok = (v) => v > 0) => {
    const raw = query.get(name);
    const value = raw === null || raw.trim() === "" ? NaN : Number(raw);
    return Number.isFinite(value) && ok(value) ? value : otherwise;
  };
  /** @template {string} T @param {string} name @param {readonly string[]} allowed @param {T} otherwise @returns {T} */
  const choice = (name, allowed, otherwise) => {
    const value = query.get(name);
    return value !== null && allowed.includes(value) ? /** @type {T} */ (value) : otherwise;
  };

  /** @type {ControllerState} */
  const controller = {
    type: choice("type", TYPES, fallback.controller.type),
    form: choice("form", FORMS, fallback.controller.form),
    Kc: number("Kc", fallback.controller.Kc),
    tau_I: number("tau_I", fallback.controller.tau_I),
    tau_D: number("tau_D", fallback.controller.tau_D),
    alpha: number("alpha", fallback.controller.alpha),
    beta: number("beta", fallback.controller.beta, () => true),
    action: choice("action", ["reverse", "direct"], fallback.controller.action),
  };
  /** @type {View} */
  const view = {
    signal: choice("signal", ["setpoint", "load"], fallback.view.signal),
    show: query.has("show") ? [...new Set((query.get("show") ?? "").split(","))].filter((name) => plots.includes(name)) : fallback.view.show,
    analyses: analysesFromQuery(query),
  };
  /** @param {"actuator" | "sensor"} name */
  const text = (name) => {
    const value = query.get(name);
    return value !== null && value.length <= MAX_TEXT ? value : fallback[name];
  };
  const horizon = query.has("horizon") ? number("horizon", 0) || null : fallback.horizon;
  return { plant: plantOf(query, number) ?? fallback.plant, controller, actuator: text("actuator"), sensor: text("sensor"), horizon, view };
}

/**
 * @param {URLSearchParams} query
 * @param {(name: string, otherwise: number, ok?: (v: number) => boolean) => number} number
 * @returns {System | null}
 */
function plantOf(query, number) {
  const text = query.get("plant");
  if (text === null || text.trim() === "" || text.length > MAX_TEXT) return null;
  const any = () => true;
  const notNegative = (/** @type {number} */ v) => v >= 0;
  if (text === "fopdt") return { type: "fopdt", K: number("K", 1, any), tau: number("tau", 1), theta: number("theta", 0, notNegative) };
  if (text === "sopdt") {
    return { type: "sopdt", K: number("K", 1, any), tau: number("tau", 1), zeta: number("zeta", 1, notNegative), theta: number("theta", 0, notNegative) };
  }
  if (text === "ss") {
    const [A, B, C, D] = MATRICES.map((name) => parseMatrix(query.get(name) ?? ""));
    return A && B && C && D ? { type: "ss", A, B, C, D, theta: number("theta", 0, notNegative) } : null;
  }
  return { type: "expr", text };
}
