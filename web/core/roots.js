/** Poles and zeros in words: conjugates as one pair, equal ones counted. */

/** @import {Complex} from "./types.js" */

import { formatNumber } from "./format.js";

/** Imaginary parts below this share of the size are rounding. */
const REAL = 1e-9;
/** Roots nearer than this share of their size are one root, several times. */
const EQUAL = 1e-6;

/** @typedef {{text: string, re: number, im: number, count: number}} Root  im >= 0; a pair counts once */

/** @param {Complex} value @param {number} [digits] */
export function formatComplex([re, im], digits = 4) {
  if (Math.abs(im) <= REAL * Math.abs(re) || im === 0) return formatShort(re, digits);
  const size = formatShort(Math.abs(im), digits);
  const part = Math.abs(re) <= REAL * Math.abs(im) ? "" : `${formatShort(re, digits)} `;
  return `${part}${im < 0 ? (part ? "− " : "−") : part ? "+ " : ""}${size === "1" ? "" : size}j`;
}

/** Without zeros that say nothing. @param {number | null | undefined} value @param {number} [digits] */
export function formatShort(value, digits = 4) {
  return formatNumber(value, digits).replace(/(\.\d*?)0+(?=$|×)/, "$1").replace(/\.(?=$|×)/, "");
}

/** Rightmost first: what decides stability leads. @param {Complex[]} values @returns {Root[]} */
export function groupRoots(values) {
  /** @type {Root[]} */
  const groups = [];
  for (const [re, im] of values) {
    const size = Math.hypot(re, im);
    if (im < -REAL * size) continue;
    const near = groups.find((other) => Math.hypot(other.re - re, other.im - im) <= EQUAL * Math.max(size, 1e-9));
    if (near) near.count += 1;
    else groups.push({ re, im: im <= REAL * size ? 0 : im, count: 1, text: "" });
  }
  groups.sort((a, b) => (Math.abs(b.re - a.re) > REAL * Math.hypot(a.re, a.im) ? b.re - a.re : a.im - b.im));
  for (const root of groups) {
    const size = formatShort(root.im);
    const imaginary = `${size === "1" ? "" : size}j`;
    const onAxis = Math.abs(root.re) <= REAL * root.im;
    root.text = root.im === 0 ? formatShort(root.re) : onAxis ? `±${imaginary}` : `${formatShort(root.re)} ± ${imaginary}`;
  }
  return groups;
}

/** "−1 (3×), −2 ± 3j"; what there is none of is said so. @param {Complex[]} values */
export function rootsText(values) {
  return groupRoots(values).map(({ text, count }) => (count > 1 ? `${text} (${count}×)` : text)).join(", ") || "none";
}
