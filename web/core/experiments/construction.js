/** Reading a model off the lines drawn on a step response: which lines each method has, and what it makes of them. */

/** @import {LineName, Lines, MethodName, Recorded} from "./types.js" */

/** @type {LineName[]} */
export const LINE_NAMES = ["t0", "t1", "t2", "t_ar", "y0", "y_final"];

/** How a line is called on the plot, and whether it stands for a time or for a level. @type {Record<LineName, {label: string, time: boolean}>} */
export const LINES = {
  t0: { label: "t₀", time: true },
  t1: { label: "t₁", time: true },
  t2: { label: "t₂", time: true },
  t_ar: { label: "tₐᵣ", time: true },
  y0: { label: "y₀", time: false },
  y_final: { label: "y∞", time: false },
};

/** @type {Record<MethodName, {label: string, lines: LineName[], formula: string}>} */
export const METHODS = {
  tangent: { label: "Tangent at the inflection", lines: ["t0", "t1", "t2", "y0", "y_final"], formula: "θ = t₁ − t₀,  τ = t₂ − t₁" },
  tangent_63: { label: "Tangent and 63.2 %", lines: ["t0", "t1", "t2", "y0", "y_final"], formula: "θ = t₁ − t₀,  τ = t₂ − t₁, t₂ at 63.2 %" },
  two_point: { label: "Two points, 28.3 % and 63.2 %", lines: ["t0", "t1", "t2", "y0", "y_final"], formula: "τ = 1.5 (t₂ − t₁),  θ = t₂ − t₀ − τ" },
  sundaresan_krishnaswamy: { label: "Sundaresan–Krishnaswamy, 35.3 % and 85.3 %", lines: ["t0", "t1", "t2", "y0", "y_final"], formula: "τ = 0.67 (t₂ − t₁),  θ = 1.3 (t₁ − t₀) − 0.29 (t₂ − t₀)" },
  area: { label: "Two areas", lines: ["t0", "t_ar", "y0", "y_final"], formula: "θ + τ = tₐᵣ − t₀,  τ = e × area under the curve up to tₐᵣ" },
  least_squares: { label: "Least squares, first order", lines: [], formula: "K, τ, θ of the smallest sum of squared residuals" },
  least_squares_sopdt: { label: "Least squares, second order", lines: [], formula: "K, τ, ζ, θ of the smallest sum of squared residuals" },
  least_squares_ipdt: { label: "Least squares, integrating", lines: [], formula: "K, θ of the smallest sum of squared residuals" },
};

/** Part of the change at which a method reads the curve, where it reads points of it. @type {Partial<Record<MethodName, Lines>>} */
const SHARES = { tangent_63: { t2: 1 - Math.exp(-1) }, two_point: { t1: 1 - Math.exp(-1 / 3), t2: 1 - Math.exp(-1) }, sundaresan_krishnaswamy: { t1: 0.353, t2: 0.853 } };

/**
 * The level at which a line of time is held: where it meets the curve, or the level that the tangent meets there.
 * @param {MethodName} method @param {LineName} name @param {Lines} lines
 */
export function levelOf(method, name, { y0 = 0, y_final = 1 }) {
  const share = SHARES[method]?.[name] ?? (method === "tangent" && name === "t2" ? 1 : 0);
  return y0 + share * (y_final - y0);
}

/**
 * First-order model with dead time that a method reads off its lines; null where they give no positive time constant.
 * @param {MethodName} method
 * @param {Lines} lines
 * @param {number} step  change of the input
 * @param {Pick<Recorded, "t" | "y">} record  what the area is taken of
 * @returns {{K: number, tau: number, theta: number} | null}
 */
export function modelOfLines(method, { t0 = 0, t1 = 0, t2 = 0, t_ar = 0, y0 = 0, y_final = 1 }, step, record) {
  const K = (y_final - y0) / step;
  let tau = t2 - t1;
  let theta = t1 - t0;
  if (method === "two_point") {
    tau *= 1.5;
    theta = t2 - t0 - tau;
  } else if (method === "sundaresan_krishnaswamy") {
    tau *= 0.67;
    theta = 1.3 * (t1 - t0) - 0.29 * (t2 - t0);
  } else if (method === "area") {
    tau = Math.E * risenArea(record, t0, t_ar, y0, y_final);
    theta = t_ar - t0 - tau;
  }
  return tau > 0 && Number.isFinite(tau) && K !== 0 && Number.isFinite(K) ? { K, tau, theta: Math.max(0, theta) } : null;
}

/**
 * Integral of (y − y0)/(y_final − y0) from one time to another, y in straight lines between its samples.
 * @param {Pick<Recorded, "t" | "y">} record @param {number} from @param {number} to @param {number} y0 @param {number} y_final
 */
export function risenArea({ t, y }, from, to, y0, y_final) {
  let area = 0;
  let [before, value] = [from, /** @type {number | null} */ (null)];
  for (const [k, at] of t.entries()) {
    const now = y[k];
    if (now === null || now === undefined || at < from) continue;
    const z = (now - y0) / (y_final - y0);
    const last = value ?? (at > from ? 0 : z);
    if (at >= to) return area + (at > before ? (to - before) * (last + (0.5 * (z - last) * (to - before)) / (at - before)) : 0);
    area += 0.5 * (at - before) * (last + z);
    [before, value] = [at, z];
  }
  return area;
}

/**
 * The line through the tangent's points: (t1, y0) and, by the tangent's end or its point on the curve, another.
 * @param {MethodName} method @param {Lines} lines @param {Record<string, number>} construction  of the server
 * @returns {{t: number[], y: number[]}}
 */
export function tangentLine(method, { t1 = 0, t2 = 0, y0 = 0, y_final = 1 }, { t_inflection = 0, y_inflection = 0 }) {
  if (method === "tangent") return { t: [t1, t2], y: [y0, y_final] };
  if (method !== "tangent_63" || !((y_inflection - y0) * (y_final - y0) > 0)) return { t: [], y: [] };
  return { t: [t1, t1 + ((t_inflection - t1) * (y_final - y0)) / (y_inflection - y0)], y: [y0, y_final] };
}
