/** What a corner of the straight-line Bode diagram is, in words. */

/** @import {AsymptotesPanel, Complex, Corner} from "../types.js" */

import { formatNumber } from "../format.js";

/** As short as the value allows: −2, 0.5, 1.25. @param {number} value */
function short(value) {
  return formatNumber(Number(value.toPrecision(4)), 4).replace(/(\.\d*?)0+(?=$|×)/, "$1").replace(/\.(?=$|×)/, "");
}

/** "−1 ± 2i" for a pair, "−1" for a real root. @param {Complex} s */
export function rootInWords([re, im]) {
  if (im === 0) return short(re);
  return `${re === 0 ? "" : `${short(re)} `}±${re === 0 ? "" : " "}${short(im)}i`;
}

/** @param {number} count */
function times(count) {
  return count === 1 ? "" : count === 2 ? "double " : count === 3 ? "triple " : `${count}-fold `;
}

/** @param {number} value */
function signed(value) {
  return `${value < 0 ? "−" : "+"}${short(Math.abs(value))}`;
}

/** "Pole at −2: slope −20 dB/decade more, phase −90° between 0.2 and 20". @param {Corner} corner @param {string} unit */
export function cornerInWords({ kind, s, multiplicity, zeta, slope_change, phase_change_deg, phase_from, phase_to }, unit) {
  const what = `${times(multiplicity)}${kind}${zeta === null ? "" : " pair"} at ${rootInWords(s)}`;
  const damping = zeta === null ? "" : ` (damping ${short(zeta)})`;
  const where = phase_to / phase_from < 1.001 ? `at ${short(phase_to)}` : `between ${short(phase_from)} and ${short(phase_to)}`;
  const text = `${what}${damping}: slope ${signed(20 * slope_change)} dB/decade more, phase ${signed(phase_change_deg)}° ${where} rad/${unit}`;
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Left of all corners. @param {AsymptotesPanel} sketch */
export function startInWords({ initial_slope, initial_phase_deg }) {
  const roots = Math.abs(initial_slope);
  const what = initial_slope === 0 ? "No pole or zero at the origin" : `${times(roots)}${initial_slope < 0 ? "pole" : "zero"} at the origin`;
  const text = `${what}: slope ${initial_slope === 0 ? "0" : signed(20 * initial_slope)} dB/decade from the left, phase ${short(initial_phase_deg)}°`;
  return text.charAt(0).toUpperCase() + text.slice(1);
}
