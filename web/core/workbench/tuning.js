/** What the tuning analyses ask about a plant, and what they find when one of the answers is a refusal. */

/** @import {Api} from "../api.js" */
/** @import {ComparedRow, CompareAnswer, GainMapAnswer, Optimum, TradeOffPoint} from "./analysis-types.js" */
/** @import {ControllerType, RuleChoice, State, System, TuneSetting} from "../types.js" */

import { controllerJson, hasIntegral } from "./loop.js";

/** As many loops as the server simulates over a spread of plants in one go. */
const AT_ONCE = { single: 12, spread: 4 };
const GRID = [32, 32];
/** Around the present gain, where stability suggests no window. */
const AROUND = 30;
/** What the slider from robust to fast passes: as many limits of Ms as the server searches in one go. */
export const LIMITS = [1.15, 1.3, 1.45, 1.6, 1.8, 2, 2.3, 2.6];

/** @typedef {{plant: System, type: ControllerType, aim: "setpoint" | "load", Ms_limit: number}} Search */
/** @typedef {{search: Search, true_plant: System | null, now: object, rules: RuleChoice[], spread_pct: number | null}} CompareRequest */
/** @typedef {{map: GainMapAnswer, tradeOff: TradeOffPoint[], settings: TuneSetting[], optimum: Optimum | null, reason: string | null}} GainMapFound */

/** @param {State} state @param {ControllerType} type @returns {Search} */
function searchOf({ plant, view }, type) {
  // The search knows no PD: the controller with all its actions is the nearest.
  return { plant, type: type === "PD" ? "PID" : type, aim: view.signal, Ms_limit: view.analyses.Ms_limit };
}

/** @param {State} state @param {RuleChoice[]} rules  those of the choice that the server has @returns {CompareRequest} */
export function compareRequest(state, rules) {
  const { spread_pct, true_plant } = state.view.analyses.compare;
  return {
    search: searchOf(state, state.controller.type),
    true_plant: true_plant.trim() === "" ? null : { type: "expr", text: true_plant },
    now: controllerJson(state.controller),
    rules,
    spread_pct,
  };
}

/**
 * What a refusal says; any other error is passed on.
 * @param {any} error
 * @returns {string}
 */
function refusal(error) {
  if (error?.status === 422) return error.message;
  throw error;
}

/**
 * The present settings, the best ones and the rules' as rows: first, second, and the rest in their order.
 * @param {Api} api
 * @param {CompareRequest} request
 * @returns {Promise<CompareAnswer>}
 */
export async function compare(api, { search, true_plant, now, rules, spread_pct }) {
  /** @type {Optimum | null} */
  let best = null;
  let reason = "";
  try {
    best = await api.analyse("tune/optimal", search);
  } catch (error) {
    reason = refusal(error);
  }
  const label = `Optimal ${search.type}, Ms ≤ ${search.Ms_limit}`;
  const entries = [{ label: "now", controller: now }, ...(best ? [{ label, controller: best.controller }] : []), ...rules];
  const most = spread_pct === null ? AT_ONCE.single : AT_ONCE.spread;
  /** @type {ComparedRow[]} */
  const rows = [];
  let horizon = 0;
  for (let from = 0; from < entries.length; from += most) {
    const part = await api.analyse("compare", { plant: search.plant, true_plant, entries: entries.slice(from, from + most), spread_pct, arrays: "f4" });
    rows.push(...part.rows);
    ({ horizon } = part);
  }
  const none = { label, rule: null, type: search.type, valid: false, reason, controller: null, closed_loop_stable: null, margins: null, setpoint: null, load: null, responses: null, sensitivity: null };
  if (!best) rows.splice(1, 0, none);
  return { horizon, rows };
}

/** The map does not depend on the controller. @param {State} state @returns {Search} */
export function gainMapRequest(state) {
  return searchOf(state, "PI");
}

/**
 * @param {Api} api
 * @param {Search} search
 * @param {number} Kc  the present gain, for a plant that suggests no window
 * @returns {Promise<GainMapFound>}
 */
export async function gainMap(api, { Ms_limit, type, ...search }, Kc) {
  const ask = { plant: search.plant, aim: search.aim, points: GRID };
  const map = await api.analyse("gain-map", ask).catch((/** @type {any} */ error) => {
    if (error?.status !== 422) throw error;
    return api.analyse("gain-map", { ...ask, Kc_range: [Kc / AROUND, Kc * AROUND] });
  });
  const refused = (/** @type {any} */ error) => ({ reason: refusal(error) });
  const optimum = await api.analyse("tune/optimal", { ...search, type, Ms_limit }).catch(refused);
  const tradeOff = await api.analyse("tune/trade-off", { ...search, type }).catch(refused);
  const rules = await api.tune({ plant: search.plant, types: ["PI"] });
  return {
    map,
    settings: rules.settings.filter(({ valid, tau_I }) => valid && tau_I !== null),
    tradeOff: tradeOff.points ?? [],
    optimum: optimum.controller ? optimum : null,
    reason: optimum.reason ?? null,
  };
}

/** Without integral action the error never ends, and there is nothing to weigh. @param {State} state */
export function tradeOffRequest(state) {
  const { type } = state.controller;
  if (!hasIntegral(type)) return null;
  return { plant: state.plant, type, aim: state.view.signal, Ms_limits: LIMITS };
}

/**
 * The best settings for a limit of Ms between those that were searched, and the error they come to: by geometric
 * interpolation, so that a slider moves them evenly.
 * @param {TradeOffPoint[]} points  in increasing order
 * @param {number} Ms
 * @returns {{Kc: number, tau_I: number | null, tau_D: number | null, alpha: number, value: number | null} | null}  null outside of what can be kept
 */
export function betweenLimits(points, Ms) {
  const found = points.flatMap(({ Ms_limit, optimum }) => (optimum ? [{ Ms_limit, ...optimum.controller, value: optimum.value }] : []));
  const after = found.findIndex(({ Ms_limit }) => Ms_limit >= Ms);
  const high = found[after];
  const low = found[high && high.Ms_limit > Ms ? after - 1 : after];
  if (!low || !high) return null;
  const share = high === low ? 0 : (Ms - low.Ms_limit) / (high.Ms_limit - low.Ms_limit);
  /** @param {number | null} a @param {number | null} b */
  const between = (a, b) => (a && b ? Number((Math.sign(a) * Math.abs(a) ** (1 - share) * Math.abs(b) ** share).toPrecision(4)) : a);
  return {
    Kc: between(low.Kc, high.Kc) ?? low.Kc,
    tau_I: between(low.tau_I, high.tau_I),
    tau_D: between(low.tau_D, high.tau_D),
    alpha: low.alpha,
    value: between(low.value, high.value),
  };
}
