/** Names of signals as symbols: T_amb is T with a subscript, phi is φ, Fi is F with a subscript i. */

import { svg } from "../dom.js";

/** @type {Record<string, string>} */
const GREEK = {
  alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", kappa: "κ", lambda: "λ",
  mu: "μ", nu: "ν", xi: "ξ", rho: "ρ", sigma: "σ", tau: "τ", phi: "φ", chi: "χ", psi: "ψ", omega: "ω",
};

/** @param {string} name @returns {{base: string, sub: string, symbol: boolean}} */
export function splitName(name) {
  const [stem, ...rest] = name.split("_");
  const sub = rest.join(" ");
  if (GREEK[stem]) return { base: GREEK[stem], sub, symbol: true };
  if (/^[A-Za-z]$/.test(stem)) return { base: stem, sub, symbol: true };
  // two or three letters are a symbol and what tells it from others: Fi, cA, h1, Tw
  if (!sub && /^[A-Za-z](?:[A-Z]|[a-z]?\d{1,2}|[a-z])[a-z\d]?$/.test(stem) && stem.length <= 3) return { base: stem[0], sub: stem.slice(1), symbol: true };
  return { base: name.replaceAll("_", " "), sub: "", symbol: false };
}

/** The name as parts of an SVG text; what follows must undo the subscript by the `dy` given. @param {string} name */
export function nameSpans(name) {
  const { base, sub, symbol } = splitName(name);
  const spans = [svg("tspan", { class: symbol ? "symbol" : null }, base)];
  if (sub) spans.push(svg("tspan", { class: "sub", dy: "0.35em" }, sub));
  // a subscript is 0.72 em: 0.35 of its own size down is 0.252 of the text's up
  return { spans, dy: sub ? "-0.252em" : null };
}
