/** The Nyquist contour in the s-plane: up the imaginary axis, round its poles on their right, back at infinity. */

/** @import {IndentationArc} from "../core/types.js" */

import { svg } from "./dom.js";

const SIZE = 64;
const AXIS = 22;
const MIDDLE = SIZE / 2;
const RADIUS = 28;
const DENT = 5;

/** @param {IndentationArc[]} arcs  of poles with ω ≥ 0 @returns {SVGElement} */
export function contourSketch(arcs) {
  const heights = [...new Set(arcs.flatMap(({ omega }) => [omega, -omega]))].toSorted((a, b) => a - b);
  const top = Math.max(...heights);
  // To scale they might lie on each other: evenly spaced, in their order.
  const rungs = heights.filter((height) => height > 0).length;
  const place = (/** @type {number} */ height) => {
    const order = heights.filter((other) => other > 0 && other <= Math.abs(height)).length;
    return MIDDLE - (top === 0 ? 0 : (Math.sign(height) * order * (RADIUS - 10)) / rungs);
  };
  const up = heights.map((height) => `V${place(height) + DENT}A${DENT},${DENT} 0 0 0 ${AXIS},${place(height) - DENT}`).join("");
  const path = `M${AXIS},${MIDDLE + RADIUS}${up}V${MIDDLE - RADIUS}`;
  const cross = (/** @type {number} */ height) => `M${AXIS - 3},${place(height) - 3}l6,6m0,-6l-6,6`;
  const words = `The contour goes up the imaginary axis, round ${heights.length === 1 ? "the pole on it" : `${heights.length} poles on it`} in small half circles on the right, and back along a half circle at infinity.`;
  return svg(
    "svg",
    { class: "contour-sketch", viewBox: `0 0 ${SIZE} ${SIZE}`, width: SIZE, height: SIZE, role: "img", "aria-label": words },
    svg("path", { class: "contour-axes", d: `M4,${MIDDLE}H${SIZE - 4}M${AXIS},2V${SIZE - 2}` }),
    svg("path", { class: "contour-far", d: `M${AXIS},${MIDDLE - RADIUS}A${RADIUS},${RADIUS} 0 0 1 ${AXIS},${MIDDLE + RADIUS}` }),
    svg("path", { class: "contour-path", d: path }),
    svg("path", { class: "contour-arrow", d: `M${AXIS - 3.5},${MIDDLE + RADIUS - 5}L${AXIS},${MIDDLE + RADIUS - 10}L${AXIS + 3.5},${MIDDLE + RADIUS - 5}` }),
    svg("path", { class: "contour-poles", d: heights.map(cross).join("") }),
  );
}
