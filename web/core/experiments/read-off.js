/** The model shown: the method's own, or what its formula makes of the lines that the student has moved. */

/** @import {IdentifyAnswer, Lines, MethodFound, MethodName} from "./types.js" */

import { METHODS, modelOfLines } from "./construction.js";
import { fitPercent, lagResponse } from "./lag-response.js";

/**
 * @typedef {object} ReadOff
 * @property {MethodFound} found  as the server gave it
 * @property {Lines} lines
 * @property {any} system  null where there is none
 * @property {Record<string, number> | null} model
 * @property {number[] | null} y_hat
 * @property {(number | null)[] | null} residuals
 * @property {number | null} fit_pct
 * @property {boolean} hand
 * @property {string | null} reason  why there is no model
 */

/** Null where the method has not been asked yet. @param {IdentifyAnswer | null} answer @param {MethodName} method @param {Lines} moved @returns {ReadOff | null} */
export function readOff(answer, method, moved) {
  const found = answer?.method === method ? answer : answer?.methods?.find((each) => each.method === method);
  if (!answer || !found) return null;
  const { construction, system, model, y_hat, residuals, fit_pct, reason } = found;
  /** @type {Lines} */
  const own = Object.fromEntries(METHODS[method].lines.filter((name) => name in construction).map((name) => [name, construction[name]]));
  const hand = METHODS[method].lines.some((name) => name in moved && name in own);
  if (!hand || !model) return { found, lines: own, system, model, y_hat, residuals, fit_pct, hand: false, reason };
  const lines = { ...own, ...Object.fromEntries(Object.entries(moved).filter(([name]) => name in own)) };
  const step = ((own.y_final ?? 1) - (own.y0 ?? 0)) / (model["K"] ?? 1);
  const read = modelOfLines(method, lines, step, answer.record);
  if (!read) return { found, lines, system: null, model: null, y_hat: null, residuals: null, fit_pct: null, hand, reason: "these lines give no time constant above zero: move t₂ behind t₁, and y∞ off y₀" };
  const modelled = lagResponse(read, answer.record, lines.y0 ?? 0);
  const left = answer.record.y.map((value, k) => (value === null ? null : value - (modelled[k] ?? 0)));
  return { found, lines, system: { type: "fopdt", ...read }, model: read, y_hat: modelled, residuals: left, fit_pct: fitPercent(answer.record.y, modelled), hand, reason: null };
}
