/** From data to the `d` of an SVG path, in pixels: pure arithmetic, fast enough for every frame. */

/** @import {Numbers} from "../core/types.js" */

/**
 * One axis as an affine map; `log` takes the decimal logarithm first.
 * @typedef {{slope: number, start: number, log: boolean}} PixelAxis
 */

/** SVG coordinates are single precision: farther out than this a line would tremble. */
const FAR = 20000;

/** @param {PixelAxis} axis @param {number | null | undefined} value @returns {number} NaN where it has no place */
export function toPixel({ slope, start, log }, value) {
  if (value === null || value === undefined) return NaN;
  return start + slope * (log ? Math.log10(value) : value);
}

/** The other way. @param {PixelAxis} axis @param {number} pixel */
export function toValue({ slope, start, log }, pixel) {
  const value = (pixel - start) / slope;
  return log ? 10 ** value : value;
}

/** @param {number} value */
function short(value) {
  return Math.round(value * 100) / 100;
}

/**
 * @param {Numbers | (number | null)[]} x
 * @param {Numbers | (number | null)[]} y
 * @param {PixelAxis} xAxis
 * @param {PixelAxis} yAxis
 * @returns {string} empty where there is nothing to draw
 */
export function linePath(x, y, xAxis, yAxis) {
  let d = "";
  let points = 0;
  let px = NaN;
  let py = NaN;
  let down = false;
  const count = Math.min(x.length, y.length);
  for (let i = 0; i < count; i++) {
    const qx = toPixel(xAxis, x[i]);
    const qy = toPixel(yAxis, y[i]);
    if (!(Number.isFinite(qx) && Number.isFinite(qy))) {
      px = NaN;
      down = false;
      continue;
    }
    const near = Math.abs(qx) < FAR && Math.abs(qy) < FAR;
    if (near && (down || Number.isNaN(px))) {
      d += `${down ? "L" : "M"}${short(qx)},${short(qy)}`;
      down = true;
      points++;
    } else if (!Number.isNaN(px)) {
      const part = clipSegment(px, py, qx, qy);
      if (part) {
        if (!down) d += `M${short(part[0])},${short(part[1])}`;
        d += `L${short(part[2])},${short(part[3])}`;
        points += 2;
      }
      down = near;
    }
    px = qx;
    py = qy;
  }
  return points > 1 ? d : "";
}

/**
 * The part of a segment inside the square |x|, |y| <= FAR (Liang and Barsky), or null.
 * @param {number} x0
 * @param {number} y0
 * @param {number} x1
 * @param {number} y1
 * @returns {[number, number, number, number] | null}
 */
export function clipSegment(x0, y0, x1, y1) {
  let from = 0;
  let to = 1;
  const dx = x1 - x0;
  const dy = y1 - y0;
  for (const [step, room] of [
    [-dx, x0 + FAR],
    [dx, FAR - x0],
    [-dy, y0 + FAR],
    [dy, FAR - y0],
  ]) {
    if (step === undefined || room === undefined) continue;
    if (step === 0) {
      if (room < 0) return null;
    } else if (step < 0) from = Math.max(from, room / step);
    else to = Math.min(to, room / step);
  }
  return from > to ? null : [x0 + from * dx, y0 + from * dy, x0 + to * dx, y0 + to * dy];
}
