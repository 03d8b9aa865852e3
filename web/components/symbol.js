/** Symbols of the nomenclature as they are printed: K_c is an italic K with a c below it. */

import { h } from "./dom.js";

/** @type {Record<string, {base: string, sub?: string, spoken: string}>} */
export const SYMBOLS = {
  Kc: { base: "K", sub: "c", spoken: "controller gain Kc" },
  Kp: { base: "K", sub: "p", spoken: "proportional gain Kp" },
  Ki: { base: "K", sub: "i", spoken: "integral gain Ki" },
  Kd: { base: "K", sub: "d", spoken: "derivative gain Kd" },
  tau_I: { base: "τ", sub: "I", spoken: "integral time tau I" },
  tau_D: { base: "τ", sub: "D", spoken: "derivative time tau D" },
  tau_c: { base: "τ", sub: "c", spoken: "closed-loop time constant tau c" },
  beta: { base: "β", spoken: "setpoint weight beta" },
  alpha: { base: "α", spoken: "derivative filter alpha" },
  K: { base: "K", spoken: "process gain K" },
  tau: { base: "τ", spoken: "time constant tau" },
  theta: { base: "θ", spoken: "dead time theta" },
  tau_1: { base: "τ", sub: "1", spoken: "slow time constant tau 1" },
  tau_2: { base: "τ", sub: "2", spoken: "fast time constant tau 2" },
  zeta: { base: "ζ", spoken: "damping zeta" },
  Ku: { base: "K", sub: "u", spoken: "ultimate gain Ku" },
  Pu: { base: "P", sub: "u", spoken: "ultimate period Pu" },
  omega_180: { base: "ω", sub: "180", spoken: "phase crossover omega 180" },
  horizon: { base: "t", sub: "end", spoken: "end of the time axis" },
};

/** @param {string} name @returns {HTMLElement} */
export function symbol(name) {
  const known = SYMBOLS[name];
  if (!known) return h("span", { class: "symbol" }, name);
  return h("span", { class: "symbol" }, h("i", {}, known.base), known.sub ? h("sub", {}, known.sub) : null);
}
