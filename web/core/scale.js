/** A slider's scale: value <-> position in 0..1, and the steps of its keys. Linear or logarithmic. */

const SIGNIFICANT = 3;

/**
 * @typedef {object} Scale
 * @property {number} min
 * @property {number} max
 * @property {(value: number) => number} toPosition
 * @property {(position: number) => number} toValue
 * @property {(value: number, steps: number) => number} step  one key press is one step
 */

/** @param {number} value */
export function tidy(value) {
  return Number(value.toPrecision(SIGNIFICANT));
}

/** Without the dust of binary fractions: 0.30000000000000004 is 0.3. @param {number} value */
function tidy12(value) {
  return Number(value.toPrecision(12));
}

/** @param {number} value @param {number} low @param {number} high */
export function clamp(value, low, high) {
  return Math.min(high, Math.max(low, value));
}

/**
 * @param {{min: number, max: number, log: boolean, step?: number | null}} options  step: one key press, where it is not left to the scale
 * @returns {Scale}
 */
export function createScale({ min, max, log, step: own = null }) {
  const f = log ? Math.log10 : (/** @type {number} */ v) => v;
  const inverse = log ? (/** @type {number} */ v) => 10 ** v : (/** @type {number} */ v) => v;
  const low = f(min);
  const span = f(max) - low;
  const whole = (/** @type {number} */ v) => (own === null ? v : tidy12(Math.round(v / own) * own));
  const toValue = (/** @type {number} */ position) => {
    const value = tidy(inverse(low + clamp(position, 0, 1) * span));
    // Whole steps where they are fine; where a step would be a jump (the low end of a log scale) three digits.
    return clamp(own !== null && Math.abs(value) >= 20 * own ? whole(value) : value, min, max);
  };
  return {
    min,
    max,
    toPosition: (value) => clamp((f(clamp(value, min, max)) - low) / span, 0, 1),
    toValue,
    step(value, steps) {
      if (own !== null) return clamp(whole(value + steps * own), min, max);
      // A logarithmic step is 2.3 % (a hundredth of a decade); a linear one a hundredth of the span.
      const moved = log ? value * 10 ** (steps / 100) : value + (steps * (max - min)) / 100;
      const next = tidy(moved);
      return clamp(next === value ? tidy(value + Math.sign(steps) * 10 ** (Math.floor(Math.log10(Math.abs(value) || 1)) - 2)) : next, min, max);
    },
  };
}

/**
 * The usual range, widened by whole decades until it holds the value.
 * @param {number} value
 * @param {{min: number, max: number}} usual
 */
export function widen(value, usual) {
  let { min, max } = usual;
  if (!(value > 0)) return { min, max };
  while (value < min) min /= 10;
  while (value > max) max *= 10;
  return { min: tidy(min), max: tidy(max) };
}
