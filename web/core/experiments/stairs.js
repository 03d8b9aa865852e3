/** A held signal as a line can draw it: level to the next sample, then up or down at once. */

/** @param {number[]} t @param {(number | null)[]} u @returns {{t: number[], y: (number | null)[]}} */
export function stairs(t, u) {
  /** @type {{t: number[], y: (number | null)[]}} */
  const out = { t: [], y: [] };
  for (const [k, time] of t.entries()) {
    if (k > 0 && u[k] !== u[k - 1]) {
      out.t.push(time);
      out.y.push(u[k - 1] ?? null);
    }
    out.t.push(time);
    out.y.push(u[k] ?? null);
  }
  return out;
}
