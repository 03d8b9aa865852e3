/** The state of the page of several loops <-> the address. */

/** @import {MimoLoop, MimoState} from "./mimo.js" */

import { toInput } from "../format.js";
import { blankState, FIRST_LOOP } from "./mimo.js";

const MAX_TEXT = 200;
const TYPES = /** @type {const} */ (["P", "PI", "PID"]);

/** @param {MimoState} state */
export function toMimoQuery(state) {
  const query = new URLSearchParams();
  if (state.plant) query.set("plant", state.plant);
  else {
    query.set("entries", state.entries.map((row) => row.join(";")).join("|"));
    query.set("time", state.timeUnit);
  }
  query.set("pairing", state.pairing.map((j) => j + 1).join(","));
  for (const [i, loop] of state.loops.entries()) {
    query.set(`c${i + 1}`, [loop.type, toInput((loop.action === "direct" ? -1 : 1) * loop.Kc), toInput(loop.tau_I), toInput(loop.tau_D), ...(loop.mode === "manual" ? ["manual"] : [])].join(","));
  }
  if (state.decoupler !== "none") query.set("decoupler", state.decoupler);
  if (state.prediction !== "drop") query.set("prediction", state.prediction);
  query.set("test", `${state.test.kind},${state.test.loop + 1},${toInput(state.test.size)}`);
  if (state.seen !== 0) query.set("seen", String(state.seen + 1));
  return query.toString().replace(/%2C/g, ",").replace(/%3B/g, ";").replace(/%7C/g, "|").replace(/%2F/g, "/").replace(/%28/g, "(").replace(/%29/g, ")");
}

/** @param {string | null} text @returns {MimoLoop | null} */
function loopOf(text) {
  const [type, Kc, tauI, tauD, mode] = (text ?? "").split(",");
  const [gain, integral, derivative] = [Number(Kc), Number(tauI), Number(tauD)];
  const known = TYPES.find((each) => each === type);
  if (!known || !Number.isFinite(gain) || gain === 0 || !(integral > 0) || !(derivative > 0)) return null;
  return { ...FIRST_LOOP, type: known, Kc: Math.abs(gain), action: gain < 0 ? "direct" : "reverse", tau_I: integral, tau_D: derivative, mode: mode === "manual" ? "manual" : "auto" };
}

/**
 * What the address says. Without loops of its own, or with too few of them, the page has still to be tuned.
 * @param {string} search
 * @returns {{state: MimoState, tuned: boolean}}
 */
export function fromMimoQuery(search) {
  const query = new URLSearchParams(search);
  const rows = (query.get("entries") ?? "").split("|").map((row) => row.split(";"));
  const square = rows.length >= 2 && rows.length <= 5 && rows.every((row) => row.length === rows.length && row.every((text) => text.trim() !== "" && text.length <= MAX_TEXT));
  const own = !query.has("plant") && square;
  /** @type {MimoLoop[]} */
  const loops = [];
  for (let i = 1; i <= 5; i++) {
    const found = loopOf(query.get(`c${i}`));
    if (!found) break;
    loops.push(found);
  }
  const pairing = (query.get("pairing") ?? "").split(",").map((text) => Number(text) - 1);
  const paired = loops.length >= 2 && pairing.toSorted().join() === loops.map((_, i) => i).join();
  const tuned = paired && (!own || rows.length === loops.length);
  const n = tuned ? loops.length : own ? rows.length : 2;
  const state = blankState(n);
  if (own) Object.assign(state, { plant: "", entries: rows, timeUnit: ["s", "min", "h"].find((unit) => unit === query.get("time")) ?? "s" });
  else state.plant = query.get("plant") || state.plant;
  if (tuned) Object.assign(state, { loops, pairing });
  state.decoupler = /** @type {const} */ (["static", "dynamic"]).find((kind) => kind === query.get("decoupler")) ?? "none";
  // That of transfer functions is for two loops.
  if (n > 2 && state.decoupler === "dynamic") state.decoupler = "none";
  state.prediction = query.get("prediction") === "wait" ? "wait" : "drop";
  const [kind, loop, size] = (query.get("test") ?? "").split(",");
  if ((kind === "setpoint" || kind === "load") && Number(loop) >= 1 && Number(loop) <= n && Number.isFinite(Number(size)) && Number(size) !== 0) state.test = { kind, loop: Math.floor(Number(loop)) - 1, size: Number(size) };
  const seen = Number(query.get("seen"));
  if (Number.isInteger(seen) && seen >= 1 && seen <= n) state.seen = seen - 1;
  return { state, tuned };
}
