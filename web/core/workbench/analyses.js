/** What the analyses are asked beside the loop: how each starts, and how it stands in an address. */

/** @import {AnalysesView, CompareView, ControllerType, ResponseView} from "../types.js" */

import { INPUTS, inputFromQuery, inputToQuery, startingInput, TRANSFORMS } from "../inputs.js";
import { limitsFromQuery, limitsToQuery, startingLimits } from "./limits.js";
import { listText, parseList } from "../lists.js";
import { spectrumFromQuery, spectrumToQuery, startingSpectrum } from "./spectrum.js";

const SUBJECTS = new Set(["plant", "open_loop", "closed_loop"]);
const SUMS = new Set(["superposition", "convolution"]);
export const MOST_SLICES = 500;
export const MOST_RULES = 6;
/** How wrong a model may be, in per cent, and how far Ms may be let go: as the server has them. */
export const SPREAD = { min: 1, max: 90 };
export const MS_LIMIT = { min: 1.05, max: 4 };
/** What some rules leave to the user, within what the server takes. */
export const TAU_C = { min: 0, max: 1e6 };
export const PM_DEG = { min: 1, max: 89 };
const RULE = /^([a-z_0-9]+)\.(P|PI|PD|PID)$/;

/** @returns {AnalysesView} */
export function startingAnalyses() {
  return {
    response: { of: "plant", input: startingInput("step", INPUTS), initial: null, sum: null, slices: 12 },
    laplace: { input: startingInput("step", TRANSFORMS), ode: null },
    polynomial: null,
    model_type: "FOPDT",
    cancel_tolerance: 1e-8,
    compare: { rules: ["ziegler_nichols", "amigo", "simc"].map((rule) => ({ rule, type: "PI" })), spread_pct: null, true_plant: "" },
    Ms_limit: 1.6,
    tune: { tau_c: null, PM_deg: 45 },
    limits: startingLimits(),
    spectrum: startingSpectrum(),
  };
}

/** @param {unknown} a @param {unknown} b */
function same(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** Only what is not as it starts. @param {URLSearchParams} query @param {AnalysesView} analyses */
export function analysesToQuery(query, { response, laplace, polynomial, model_type, cancel_tolerance, compare, Ms_limit, tune, limits, spectrum }) {
  const start = startingAnalyses();
  if (response.of !== start.response.of) query.set("response.of", response.of);
  if (!same(response.input, start.response.input)) inputToQuery(query, "response", response.input);
  if (response.initial?.y) query.set("response.y", listText(response.initial.y, ","));
  if (response.initial?.x) query.set("response.x", listText(response.initial.x, ","));
  if (response.sum) query.set("response.sum", response.sum);
  if (response.slices !== start.response.slices) query.set("response.slices", String(response.slices));
  if (laplace.input === null) query.set("laplace.input", "none");
  else if (!same(laplace.input, start.laplace.input)) inputToQuery(query, "laplace", laplace.input);
  for (const [name, values] of Object.entries(laplace.ode ?? {})) query.set(`laplace.${name}`, listText(values, ","));
  if (polynomial) query.set("routh.polynomial", listText(polynomial, ","));
  if (model_type !== start.model_type) query.set("model_type", model_type);
  if (cancel_tolerance !== start.cancel_tolerance) query.set("cancel_tolerance", String(cancel_tolerance));
  if (!same(compare.rules, start.compare.rules)) query.set("compare.rules", compare.rules.map(({ rule, type }) => `${rule}.${type}`).join(","));
  if (compare.spread_pct !== null) query.set("compare.spread_pct", String(compare.spread_pct));
  if (compare.true_plant !== "") query.set("compare.true_plant", compare.true_plant);
  if (Ms_limit !== start.Ms_limit) query.set("Ms_limit", String(Ms_limit));
  if (tune.tau_c !== null) query.set("tune.tau_c", String(tune.tau_c));
  if (tune.PM_deg !== start.tune.PM_deg) query.set("tune.PM_deg", String(tune.PM_deg));
  limitsToQuery(query, limits);
  spectrumToQuery(query, spectrum);
}

/** @param {string} text @returns {CompareView["rules"]} */
function rulesFrom(text) {
  return text
    .split(",")
    .map((word) => RULE.exec(word))
    .filter((found) => found !== null)
    .slice(0, MOST_RULES)
    .map(([, rule = "", type]) => ({ rule, type: /** @type {ControllerType} */ (type) }));
}

/** @param {URLSearchParams} query @returns {AnalysesView} */
export function analysesFromQuery(query) {
  const start = startingAnalyses();
  const list = (/** @type {string} */ name) => {
    const values = parseList(query.get(name) ?? "");
    return values?.length ? values : null;
  };
  const [a, y, x] = [list("laplace.a"), list("response.y"), list("response.x")];
  const subject = query.get("response.of") ?? "";
  const sum = query.get("response.sum") ?? "";
  const [slices] = list("response.slices") ?? [];
  const [tolerance] = list("cancel_tolerance") ?? [];
  const [spread] = list("compare.spread_pct") ?? [];
  const [limit] = list("Ms_limit") ?? [];
  const [tau_c] = list("tune.tau_c") ?? [];
  const [PM_deg] = list("tune.PM_deg") ?? [];
  const within = (/** @type {number | undefined} */ value, /** @type {{min: number, max: number}} */ { min, max }) => value !== undefined && value >= min && value <= max;
  const rules = query.get("compare.rules");
  return {
    response: {
      of: SUBJECTS.has(subject) ? /** @type {ResponseView["of"]} */ (subject) : start.response.of,
      input: inputFromQuery(query, "response", INPUTS) ?? start.response.input,
      initial: y ? { y } : x ? { x } : null,
      sum: SUMS.has(sum) ? /** @type {ResponseView["sum"]} */ (sum) : null,
      slices: slices !== undefined && Number.isInteger(slices) && slices >= 1 && slices <= MOST_SLICES ? slices : start.response.slices,
    },
    laplace: {
      input: query.get("laplace.input") === "none" ? null : (inputFromQuery(query, "laplace", TRANSFORMS) ?? start.laplace.input),
      ode: a ? { a, b: list("laplace.b") ?? [1], initial: list("laplace.initial") ?? [] } : null,
    },
    polynomial: list("routh.polynomial"),
    model_type: query.get("model_type") === "SOPDT" ? "SOPDT" : "FOPDT",
    cancel_tolerance: tolerance !== undefined && tolerance >= 0 && tolerance <= 0.1 ? tolerance : start.cancel_tolerance,
    compare: {
      rules: rules === null ? start.compare.rules : rulesFrom(rules),
      spread_pct: within(spread, SPREAD) ? (spread ?? null) : null,
      true_plant: query.get("compare.true_plant")?.slice(0, 500) ?? "",
    },
    Ms_limit: within(limit, MS_LIMIT) ? (limit ?? start.Ms_limit) : start.Ms_limit,
    tune: {
      tau_c: within(tau_c, TAU_C) ? (tau_c ?? null) : null,
      PM_deg: within(PM_deg, PM_DEG) ? (PM_deg ?? start.tune.PM_deg) : start.tune.PM_deg,
    },
    limits: limitsFromQuery(query),
    spectrum: spectrumFromQuery(query),
  };
}
