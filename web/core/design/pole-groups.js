/** Wanted poles as a person moves them: a real pole, or a pair that moves as one; two real ones meet to make a pair. */

/** @import {Complex} from "../types.js" */

/** @typedef {{id: number, re: number, im: number}} PoleGroup  im >= 0; above 0 it is a pair */

let last = 0;
/** @param {number} re @param {number} im @returns {PoleGroup} */
function group(re, im) {
  last += 1;
  return { id: last, re, im };
}

/** @param {Complex[]} poles @returns {PoleGroup[]} */
export function groupsOf(poles) {
  return poles.filter(([, im]) => im >= 0).map(([re, im]) => group(re, im));
}

/** @param {PoleGroup[]} groups @returns {Complex[]} */
export function polesOf(groups) {
  return groups.flatMap(({ re, im }) => /** @type {Complex[]} */ (im > 0 ? [[re, im], [re, -im]] : [[re, 0]]));
}

/** @param {PoleGroup[]} groups */
export function countOf(groups) {
  return groups.reduce((sum, { im }) => sum + (im > 0 ? 2 : 1), 0);
}

/**
 * One of them moved: a real pole that leaves the axis takes the nearest other real one with it, a pair that comes to
 * the axis falls apart. The number of poles stays.
 * @param {PoleGroup[]} groups
 * @param {number} id
 * @param {{re: number, im: number}} to  an im below zero counts as its size
 * @returns {PoleGroup[]}
 */
export function moveGroup(groups, id, to) {
  const moved = groups.find((each) => each.id === id);
  if (!moved) return groups;
  const im = Math.abs(to.im);
  const put = (/** @type {PoleGroup[]} */ rest, /** @type {number} */ height) => rest.map((each) => (each.id === id ? { id, re: to.re, im: height } : each));
  if (moved.im > 0 && im === 0) return [...put(groups, 0), group(to.re, 0)];
  if (moved.im > 0 || im === 0) return put(groups, im);
  const [partner] = groups.filter((each) => each.id !== id && each.im === 0).toSorted((a, b) => Math.abs(a.re - to.re) - Math.abs(b.re - to.re));
  if (!partner) return put(groups, 0);
  return put(groups.filter((each) => each.id !== partner.id), im);
}

/**
 * No more poles than are needed: the fastest real ones go first, then the fastest pair. What is then missing is added
 * by the server.
 * @param {PoleGroup[]} groups
 * @param {number} required
 */
export function trimmed(groups, required) {
  let left = groups;
  while (countOf(left) > required) {
    const real = left.filter(({ im }) => im === 0);
    const [fastest] = (real.length > 0 ? real : left).toSorted((a, b) => Math.hypot(b.re, b.im) - Math.hypot(a.re, a.im));
    left = left.filter((each) => each !== fastest);
  }
  return left;
}

/** Damping and natural frequency of a pair. @param {PoleGroup} pair */
export function dampingOf({ re, im }) {
  const omega_n = Math.hypot(re, im);
  return { zeta: -re / omega_n, omega_n };
}
