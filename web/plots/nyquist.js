/** Nyquist plot: L(iω) and its mirror, the point −1, the unit circle, and the direction of growing ω. */

/** @import {Figure, IndentationArc, MarginsPanel, NyquistPanel, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { arcPoints, cutAtRim, rimTraces } from "./nyquist_rim.js";
import { ghostLine, lineOf } from "./signals.js";

/** What matters happens about −1; a curve that comes from far away (an integrator, a high gain) is cut here. */
const NEAR = { least: 1.6, most: 5 };
/** The rim, as a share of the way from the origin to the nearest edge: room for an arc that widens, and its arrows. */
const RIM = 0.84;
const CIRCLE = Array.from({ length: 121 }, (_, i) => (i * Math.PI) / 60);

/**
 * @typedef {object} NyquistInput
 * @property {NyquistPanel} nyquist
 * @property {MarginsPanel | null} margins
 * @property {boolean} whole  the whole curve instead of the neighbourhood of −1
 * @property {NyquistPanel[]} ghosts
 */

/**
 * @param {NyquistInput} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function nyquistPlot({ nyquist, margins, whole, ghosts }, theme, held) {
  const line = lineOf("L", theme);
  const reach = reachOf(nyquist, whole, nearOf(margins));
  const box = Number.isFinite(reach) ? squareOf(reach / RIM) : windowOf(nyquist);
  const ranges = {
    xaxis: holdRange(held, "xaxis", box.re[0], box.re[1]),
    yaxis: holdRange(held, "yaxis", box.im[0], box.im[1]),
  };
  const rim = Number.isFinite(reach) ? RIM * Math.min(...[...ranges.xaxis, ...ranges.yaxis].map(Math.abs)) : Infinity;
  const { inside, outside } = cutAtRim(nyquist, rim);
  const mirrored = inside.y.map((value) => (value === null ? null : -value));
  const arrowAt = whole && Number.isFinite(rim) ? 0.4 * rim : 1.25;
  const size = 0.03 * (ranges.yaxis[1] - ranges.yaxis[0]);
  const hover = "L = %{x:.4~g} %{y:+.4~g} i";

  /** @type {Trace[]} */
  const traces = [
    {
      type: "scatter",
      mode: "lines",
      name: "unit circle",
      x: CIRCLE.map(Math.cos),
      y: CIRCLE.map(Math.sin),
      line: { color: theme.axis, width: 1.25, dash: "dash" },
      hoverinfo: "skip",
    },
    ...ghosts.map((ghost) => /** @type {Trace} */ ({ type: "scatter", mode: "lines", name: "kept L", x: ghost.re, y: ghost.im, line: ghostLine(theme), hoverinfo: "skip" })),
    { type: "scatter", mode: "lines", name: "ω < 0", x: inside.x, y: mirrored, line: { ...line, width: 1.25, dash: "dash" }, hoverinfo: "skip" },
    { type: "scatter", mode: "lines", name: "ω > 0", ...inside, line, hovertemplate: `${hover}<extra></extra>` },
    ...rimTraces(nyquist, rim, outside, theme),
    arrow(nyquist, ranges, arrowAt, size, 1, line.color),
    arrow(nyquist, ranges, arrowAt, size, -1, line.color),
    crossings(margins, theme),
    {
      type: "scatter",
      mode: "markers",
      name: "−1",
      x: [-1],
      y: [0],
      marker: { symbol: "cross-thin", size: 15, line: { color: theme.bad, width: 3 } },
      hovertemplate: "the point −1<extra></extra>",
    },
  ];
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, "Re L", ranges.xaxis),
      // One scale on both axes: the unit circle is a circle, and an angle is an angle.
      yaxis: axis(theme, "Im L", ranges.yaxis, { scaleanchor: "x", scaleratio: 1 }),
      annotations: Number.isFinite(rim) ? nyquist.arcs.map((arc) => arcLabel(arc, rim, theme)) : [],
    },
  };
}

/** How far out the neighbourhood of −1 goes: far enough for where the curve crosses the negative real axis. @param {MarginsPanel | null} margins */
function nearOf(margins) {
  const reaches = (margins?.phase_crossovers ?? []).map(({ GM }) => 1.15 / GM).filter((reach) => reach < NEAR.most);
  return Math.max(NEAR.least, ...reaches);
}

/**
 * The radius from which on the curve is drawn on the rim; Infinity where all of it is shown as it is.
 * @param {NyquistPanel} nyquist
 * @param {boolean} whole
 * @param {number} near
 */
function reachOf({ re, im, arcs }, whole, near) {
  if (!whole) return near;
  if (arcs.length === 0) return Infinity;
  // Next to a pole on the axis the curve has no end: as far as its last bend or crossing, and well beyond.
  let far = near;
  for (let i = 1; i < re.length - 1; i++) {
    const size = Math.hypot(re[i] ?? 0, im[i] ?? 0);
    const [before, after] = [Math.hypot(re[i - 1] ?? 0, im[i - 1] ?? 0), Math.hypot(re[i + 1] ?? 0, im[i + 1] ?? 0)];
    const crosses = (im[i - 1] ?? 0) < 0 !== (im[i] ?? 0) < 0 || (re[i - 1] ?? 0) < 0 !== (re[i] ?? 0) < 0;
    if ((crosses || (size >= before && size > after)) && size < 1e4) far = Math.max(far, size);
  }
  return 2.5 * far;
}

/** @param {number} half @returns {{re: Range, im: Range}} */
function squareOf(half) {
  return { re: [-half, half], im: [-half, half] };
}

/** @param {NyquistPanel} nyquist @returns {{re: Range, im: Range}} */
function windowOf({ re, im }) {
  const reach = Math.max(...extent(im, [1]).map(Math.abs));
  return { re: extent(re, [-1.5, 1]), im: [-reach, reach] };
}

/** How far L turns at infinity, inside its arc and off the arrow on it. @param {IndentationArc} arc @param {number} rim @param {Theme} theme */
function arcLabel(arc, rim, theme) {
  const { x, y } = arcPoints(arc, 0.95 * rim);
  const at = Math.round(((x.length - 1) * 45) / arc.turn_deg);
  const [re, im] = [x[at] ?? 0, y[at] ?? 0];
  return {
    x: re,
    y: im,
    text: `∞: ${arc.turn_deg}° ↻`,
    showarrow: false,
    xanchor: re > 0 ? "right" : "left",
    yanchor: im > 0 ? "top" : "bottom",
    font: { size: theme.fontSize - 1, color: theme.signal["infinity"] ?? theme.ink },
  };
}

/**
 * A chevron on the curve where it passes through the middle of what is shown.
 * @param {NyquistPanel} nyquist
 * @param {{xaxis: Range, yaxis: Range}} ranges
 * @param {number} about  distance from the origin to look for a place at
 * @param {number} size
 * @param {1 | -1} side  1 for ω > 0, −1 for its mirror, which runs the other way
 * @param {string} color
 * @returns {Trace}
 */
function arrow({ re, im }, ranges, about, size, side, color) {
  /** @type {Trace} */
  const trace = { type: "scatter", mode: "lines", name: "direction", x: [], y: [], line: { color, width: 2.25 }, hoverinfo: "skip" };
  // A little outside the unit circle the arrow is in sight, and off −1 and the margins.
  let best = -1;
  let miss = Infinity;
  for (let i = 1; i < re.length - 1; i++) {
    const [x, y] = [re[i] ?? 0, im[i] ?? 0];
    if (x < ranges.xaxis[0] || x > ranges.xaxis[1] || y < ranges.yaxis[0] || y > ranges.yaxis[1]) continue;
    const distance = Math.abs(Math.hypot(x, y) - about);
    if (distance < miss) [best, miss] = [i, distance];
  }
  if (best < 0) return trace;
  const [x, y] = [re[best] ?? 0, side * (im[best] ?? 0)];
  const dx = side * ((re[best + 1] ?? 0) - (re[best - 1] ?? 0));
  const dy = (im[best + 1] ?? 0) - (im[best - 1] ?? 0);
  const length = Math.hypot(dx, dy) || 1;
  const [ux, uy] = [(dx / length) * size, (dy / length) * size];
  trace.x = [x - ux - 0.6 * uy, x + ux * 0.6, x - ux + 0.6 * uy];
  trace.y = [y - uy + 0.6 * ux, y + uy * 0.6, y - uy - 0.6 * ux];
  return trace;
}

/** @param {MarginsPanel | null} margins @param {Theme} theme @returns {Trace} */
function crossings(margins, theme) {
  const angle = margins?.PM_deg != null ? ((margins.PM_deg - 180) * Math.PI) / 180 : null;
  const color = theme.signal["margin"] ?? theme.ink;
  return {
    type: "scatter",
    mode: "markers",
    name: "margins",
    x: [margins?.GM != null ? -1 / margins.GM : null, angle === null ? null : Math.cos(angle)],
    y: [margins?.GM != null ? 0 : null, angle === null ? null : Math.sin(angle)],
    marker: { symbol: "circle", size: 9, color: theme.paper, line: { color, width: 2 } },
    hovertemplate: "L = %{x:.4~g} %{y:+.4~g} i<extra></extra>",
  };
}
