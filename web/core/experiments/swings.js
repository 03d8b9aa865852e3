/** What is read off an oscillation as one would by eye: its turning points, whether they grow, the period and the height. */

/** @import {Points} from "./types.js" */

/** Swings, from one turning point to the next, that a verdict is made of: three periods at most, one and a half at least. */
const MOST = 7;
const LEAST = 4;
/** Change of the swings in a period that passes as none. */
const SUSTAINED = 0.03;

/**
 * Turning points found as they come: one is known once the curve has turned back from it by `least`.
 * @param {number} least  above the noise
 */
export function createSwings(least) {
  /** @type {Points} */
  const points = { t: [], y: [] };
  let way = 0;
  /** The furthest so far on the way, with its neighbours. */
  let [t, y, before, after] = [0, 0, /** @type {[number, number] | null} */ (null), /** @type {[number, number] | null} */ (null)];
  /** @type {[number, number] | null} */
  let last = null;
  return {
    points,
    /** @param {number} time @param {number} value */
    push(time, value) {
      if (last === null) [t, y] = [time, value];
      else if (way === 0) {
        if (Math.abs(value - y) > least) {
          way = Math.sign(value - y);
          [t, y, before, after] = [time, value, last, null];
        }
      } else if (way * (value - y) >= 0) [t, y, before, after] = [time, value, last, null];
      else {
        after ??= [time, value];
        if (way * (y - value) > least) {
          const top = vertex(before, [t, y], after);
          points.t.push(top[0]);
          points.y.push(top[1]);
          way = -way;
          [t, y, before, after] = [time, value, last, null];
        }
      }
      last = [time, value];
    },
  };
}

/**
 * Top of the parabola through three points.
 * @param {[number, number] | null} a @param {[number, number]} b @param {[number, number] | null} c
 * @returns {[number, number]}
 */
function vertex(a, b, c) {
  if (!a || !c || a[0] === b[0] || c[0] === b[0]) return b;
  const [p, q] = [(b[1] - a[1]) / (b[0] - a[0]), (c[1] - b[1]) / (c[0] - b[0])];
  const bend = (q - p) / (c[0] - a[0]);
  if (bend === 0) return b;
  const slope = p + bend * (b[0] - a[0]);
  const s = -slope / (2 * bend);
  return s > a[0] - b[0] && s < c[0] - b[0] ? [b[0] + s, b[1] + s * slope + bend * s * s] : b;
}

/**
 * @param {Points} points
 * @param {number} [since]  what came before is of another gain
 * @returns {{verdict: "too few" | "decaying" | "sustained" | "growing", ratio: number | null, Pu: number | null, amplitude: number | null, swings: number}}
 *   ratio: each swing over the one a period before; amplitude: half of the last swing
 */
export function judge({ t, y }, since = -Infinity) {
  // The first turn after a change of gain is still made of what was before.
  const first = Math.max(t.findIndex((time) => time > since) + (since === -Infinity ? 0 : 1), t.length - MOST - 1);
  const usable = t.some((time) => time > since) ? t.length - first - 1 : 0;
  const swings = Array.from({ length: Math.max(0, usable) }, (_, k) => Math.abs((y[first + k + 1] ?? 0) - (y[first + k] ?? 0)));
  if (swings.length < LEAST) return { verdict: "too few", ratio: null, Pu: null, amplitude: null, swings: swings.length };
  const n = swings.length;
  const middle = (n - 1) / 2;
  const logs = swings.map(Math.log);
  const mean = logs.reduce((sum, v) => sum + v, 0) / n;
  const slope = logs.reduce((sum, v, k) => sum + (v - mean) * (k - middle), 0) / swings.reduce((sum, _, k) => sum + (k - middle) ** 2, 0);
  const ratio = Math.exp(2 * slope);
  const Pu = (2 * ((t.at(-1) ?? 0) - (t[first] ?? 0))) / n;
  return { verdict: Math.abs(ratio - 1) <= SUSTAINED ? "sustained" : ratio < 1 ? "decaying" : "growing", ratio, Pu, amplitude: (swings.at(-1) ?? 0) / 2, swings: n };
}
