/** Numbers as people read them: fixed significant digits, a real minus sign, no jumping width. */

/** @import {Numbers} from "./types.js" */

const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";
export const UNDEFINED = "—";

/** @param {number} n */
function superscript(n) {
  const digits = [...String(Math.abs(n))].map((d) => SUPERSCRIPT[Number(d)]).join("");
  return (n < 0 ? "⁻" : "") + digits;
}

/**
 * `digits` significant digits, trailing zeros kept so that the width holds while the value moves.
 * @param {number | null | undefined} value
 * @param {number} [digits]
 * @returns {string}
 */
export function formatNumber(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return UNDEFINED;
  if (value === Infinity) return "∞";
  if (value === -Infinity) return "−∞";
  if (value === 0) return "0";
  const rounded = Number(value.toPrecision(digits));
  const magnitude = Math.floor(Math.log10(Math.abs(rounded)));
  let text;
  if (magnitude < -3 || magnitude > 5) {
    text = `${(rounded / 10 ** magnitude).toFixed(digits - 1)}×10${superscript(magnitude)}`;
  } else {
    text = rounded.toFixed(Math.max(0, digits - 1 - magnitude));
  }
  return text.replace("-", "−");
}

/**
 * What stands for a figure that is not a number: infinity where the reason says so, else a dash.
 * @param {string | null | undefined} reason
 */
export function formatAbsent(reason) {
  return /^infinite\b/i.test(reason ?? "") ? "∞" : UNDEFINED;
}

/** Names of times in words from the server as they are printed: tau_c is τ_c. @param {string} text */
export function greek(text) {
  return text.replace(/\b(tau|theta|lambda)(?:_|\b)/g, (_, name) => (name === "tau" ? "τ" : name === "theta" ? "θ" : "λ"));
}

/**
 * A sentence as people write it: a capital at the start, a stop at the end.
 * @param {string | null | undefined} text
 */
export function sentence(text) {
  if (!text) return "";
  const trimmed = text.trim();
  return trimmed.charAt(0).toUpperCase() + trimmed.slice(1) + (/[.!?…]$/.test(trimmed) ? "" : ".");
}

/**
 * A fixed number of decimals, for values with a natural scale (per cent, degrees).
 * @param {number | null | undefined} value
 * @param {number} decimals
 */
export function formatFixed(value, decimals) {
  if (value === null || value === undefined || !Number.isFinite(value)) return formatNumber(value);
  if (Math.abs(value) >= 1e5) return formatNumber(value);
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}

/**
 * @param {number | null | undefined} value
 * @param {string} unit
 * @param {number} [digits]
 */
export function formatWithUnit(value, unit, digits = 3) {
  const text = formatNumber(value, digits);
  return unit && text !== UNDEFINED ? `${text}\u202f${unit}` : text;
}

/**
 * Text for an input: plain ASCII, as short as the value allows.
 * @param {number} value
 */
export function toInput(value) {
  return String(Number(value.toPrecision(6)));
}

const NUMBER = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?$/i;

/**
 * The number a person typed, or null. Takes a decimal comma and a typographic minus.
 * @param {string} text
 * @returns {number | null}
 */
export function parseNumber(text) {
  const plain = text.trim().replace("−", "-").replace(/\s+/g, "");
  if (!NUMBER.test(plain)) return null;
  const value = Number(plain.replace(",", "."));
  return Number.isFinite(value) ? value : null;
}

/**
 * Enough digits to tell neighbours apart in a table or file.
 * @param {number | null} value
 */
export function tableNumber(value) {
  return value === null || !Number.isFinite(value) ? "" : String(Number(value.toPrecision(7)));
}

/**
 * The entry of a series nearest to `at`; series are increasing.
 * @param {Numbers} series
 * @param {number} at
 */
export function nearestIndex(series, at) {
  let low = 0;
  let high = series.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((series[middle] ?? 0) <= at) low = middle;
    else high = middle;
  }
  return at - (series[low] ?? 0) <= (series[high] ?? 0) - at ? low : high;
}
