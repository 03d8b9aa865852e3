/** What a first-order model with dead time answers to a recorded input, exactly, so that it follows a dragged line at once. */

/** @import {Recorded} from "./types.js" */

/**
 * @param {{K: number, tau: number, theta: number}} model
 * @param {Pick<Recorded, "t" | "u" | "u_before">} record  u held from sample to sample
 * @param {number} level  y at rest with u_before
 * @returns {number[]}
 */
export function lagResponse({ K, tau, theta }, { t, u, u_before }, level) {
  let x = 0;
  let at = (t[0] ?? 0) + theta;
  let now = 0;
  let next = 0;
  return t.map((time) => {
    // Changes of the input arrive the dead time later; between two of them x goes to K u.
    while (next < t.length && (t[next] ?? 0) + theta <= time) {
      const arrives = (t[next] ?? 0) + theta;
      x += (K * now - x) * -Math.expm1(-(arrives - at) / tau);
      at = arrives;
      now = (u[next] ?? 0) - u_before;
      next += 1;
    }
    return level + (time > at ? x + (K * now - x) * -Math.expm1(-(time - at) / tau) : x);
  });
}

/**
 * 100 (1 − |y − ŷ|/|y − mean y|) over the samples there are.
 * @param {(number | null)[]} y @param {number[]} y_hat
 * @returns {number | null}
 */
export function fitPercent(y, y_hat) {
  const seen = y.flatMap((value, k) => (value === null ? [] : [[value, y_hat[k] ?? 0]]));
  const mean = seen.reduce((sum, [value = 0]) => sum + value, 0) / seen.length;
  const [off, spread] = seen.reduce(([a = 0, b = 0], [value = 0, modelled = 0]) => [a + (value - modelled) ** 2, b + (value - mean) ** 2], [0, 0]);
  return spread ? 100 * (1 - Math.sqrt((off ?? 0) / spread)) : null;
}
