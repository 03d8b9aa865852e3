/** The root locus as a table: what is constructed by hand first, then the branches. */

/** @import {Complex, PolesPanel, RootLocusPanel, Table} from "../types.js" */

/** @typedef {(string | number | null)[]} Row */

/**
 * @param {PolesPanel} poles
 * @param {RootLocusPanel | null} locus
 * @param {RootLocusPanel | null} negative  for gains of the other sign
 * @returns {Table}
 */
export function locusTable(poles, locus, negative) {
  const now = poles.poles.map((s) => row("closed-loop pole now", s, poles.K));
  const fixed = locus ? [...locus.open_loop_poles.map((s) => row("open-loop pole", s, 0)), ...locus.open_loop_zeros.map((s) => row("open-loop zero", s, null))] : [];
  const lead = [...now, ...fixed, ...(locus ? construction(locus, 1) : []), ...(negative ? construction(negative, -1) : [])];
  return {
    header: ["what", "Re s", "Im s", "Kc", "angle [°]"],
    rows: [...lead, ...(locus ? branchRows(locus, 1) : []), ...(negative ? branchRows(negative, -1) : [])],
    lead: lead.length,
  };
}

/** @param {string} what @param {Complex} s @param {number | null} K @param {number | null} [angle] @returns {Row} */
function row(what, [re, im], K, angle = null) {
  return [what, re, im, K, angle];
}

/** @param {RootLocusPanel} locus @param {1 | -1} sign @returns {Row[]} */
function construction({ breakaways, imaginary_axis_crossings, asymptotes, departure_angles, arrival_angles }, sign) {
  const which = sign > 0 ? "" : ", K < 0";
  return [
    ...breakaways.map(({ s, K }) => row(`breakaway${which}`, s, sign * K)),
    ...imaginary_axis_crossings.map(({ omega, K }) => row(`axis crossing${which}`, [0, omega], sign * K)),
    ...departure_angles.map(({ s, angle_deg }) => row(`departure from pole${which}`, s, 0, angle_deg)),
    ...arrival_angles.map(({ s, angle_deg }) => row(`arrival at zero${which}`, s, null, angle_deg)),
    ...(asymptotes?.angles_deg ?? []).map((angle) => row(`asymptote from the centroid${which}`, [asymptotes?.centroid ?? 0, 0], null, angle)),
    ...(asymptotes?.horizontal ?? []).map((level) => /** @type {Row} */ ([`horizontal asymptote${which}`, null, level, null, 0])),
  ];
}

/** On the real axis rounding leaves an imaginary part that means nothing. @param {number | null} im @param {number} re */
function cleaned(im, re) {
  return im !== null && Math.abs(im) < 1e-12 * Math.abs(re) ? 0 : im;
}

/** @param {RootLocusPanel} locus @param {1 | -1} sign @returns {Row[]} */
function branchRows({ branches, gains }, sign) {
  return branches.flatMap(({ first, re, im }, n) =>
    Array.from(re, (value, i) => [`branch ${n + 1}${sign > 0 ? "" : ", K < 0"}`, value, cleaned(im[i] ?? null, value), sign * (gains?.[first + i] ?? NaN), null]),
  );
}
