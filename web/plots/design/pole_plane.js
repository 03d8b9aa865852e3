/** The s-plane in which poles are wanted: lines of constant damping and of settling time, the plant, the wanted poles. */

/** @import {Complex, Figure, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { round125 } from "../../core/plant/pace.js";
import { formatShort } from "../../core/roots.js";
import { axis, baseLayout, holdRange } from "../axes.js";
import { windowOf } from "../poles.js";
import { escapePlotly } from "../escape.js";

export const DAMPINGS = [0.3, 0.5, 0.7, 0.9];
/** Settling to two per cent takes four time constants. */
const SETTLED = 4;
const SETTLING_AT = [0.2, 0.55];
/** Labels nearer to each other than this share of the plot would lie on one another. */
const APART = 0.13;

/**
 * Where a ray of this damping leaves the window, above the axis.
 * @param {number} zeta @param {Range} re @param {Range} im
 * @returns {{x: number, y: number}}
 */
export function rayEnd(zeta, re, im) {
  const slope = Math.sqrt(1 - zeta * zeta) / zeta;
  const [left, top] = [-re[0], im[1]];
  return left * slope <= top ? { x: -left, y: left * slope } : { x: -top / slope, y: top };
}

/**
 * @param {{wanted: Complex[], poles: Complex[], zeros: Complex[], timeUnit: string}} input  poles and zeros of the plant
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function polePlane({ wanted, poles, zeros, timeUnit }, theme, held) {
  const { re, im } = windowOf([...wanted, ...poles, ...zeros]);
  const ranges = { xaxis: holdRange(held, "xaxis", ...re), yaxis: holdRange(held, "yaxis", ...im) };
  const [left] = ranges.xaxis;
  const far = 10 * Math.max(...[...ranges.xaxis, ...ranges.yaxis].map(Math.abs));
  const ends = DAMPINGS.map((zeta) => {
    const { x, y } = rayEnd(zeta, ranges.xaxis, ranges.yaxis);
    return { zeta, x, y };
  });
  const settling = [...new Set(SETTLING_AT.map((share) => round125(SETTLED / Math.max(-share * left, 1e-9))))].map((time) => ({ time, x: -SETTLED / time })).filter(({ x }) => x > left && x < 0);

  const near = (/** @type {{x: number, y: number}} */ a, /** @type {{x: number, y: number}} */ b) => Math.abs(a.x - b.x) < APART * (ranges.xaxis[1] - left) && Math.abs(a.y - b.y) < APART * (ranges.yaxis[1] - ranges.yaxis[0]);
  const labelled = ends.filter((end, i) => !ends.slice(0, i).some((other, j) => near(end, other) && !ends.slice(0, j).some((before) => near(other, before))));

  /** @param {string} name @param {Complex[]} points @param {object} marker @returns {Trace} */
  const dots = (name, points, marker) => ({ type: "scatter", mode: "markers", name, x: points.map(([x]) => x), y: points.map(([, y]) => y), marker, hovertemplate: `${name}<br>s = %{x:.4~g} %{y:+.4~g} j<extra></extra>` });
  /** @param {string} name @param {{x: (number | null)[], y: (number | null)[]}} points @returns {Trace} */
  const guide = (name, { x, y }) => ({ type: "scatter", mode: "lines", name, x, y, line: { color: theme.axis, width: 1, dash: "dot" }, hoverinfo: "skip" });
  const label = (/** @type {object} */ more) => ({ showarrow: false, font: { size: theme.fontSize - 1, color: theme.muted }, bgcolor: theme.paper, borderpad: 1, ...more });

  return {
    traces: [
      guide("damping", { x: ends.flatMap(({ x }) => [x, 0, x, null]), y: ends.flatMap(({ y }) => [y, 0, -y, null]) }),
      guide("settling", { x: settling.flatMap(({ x }) => [x, x, null]), y: settling.flatMap(() => [...ranges.yaxis, null]) }),
      dots("zero of the plant", zeros, { symbol: "circle-open", size: 10, color: theme.ink, line: { color: theme.ink, width: 2 } }),
      dots("pole of the plant", poles, { symbol: "x-thin", size: 11, line: { color: theme.ink, width: 2.25 } }),
      dots("wanted pole", wanted, { symbol: "square", size: 9, color: theme.signal["pole"] ?? theme.ink, line: { color: theme.paper, width: 1.5 } }),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, "Re s", ranges.xaxis, { zerolinewidth: 1.5, zerolinecolor: theme.muted, nticks: 8 }),
      yaxis: axis(theme, "Im s", ranges.yaxis),
      annotations: [
        ...labelled.map(({ zeta, x, y }) => label({ x: 0.94 * x, y: 0.94 * y, text: `ζ ${zeta}` })),
        ...settling.map(({ time, x }) => label({ x, y: 0, yref: "paper", yanchor: "bottom", text: `${formatShort(time)} ${escapePlotly(timeUnit)}` })),
      ],
      shapes: [{ type: "rect", layer: "below", xref: "x", yref: "paper", x0: 0, x1: far, y0: 0, y1: 1, fillcolor: theme.bad, opacity: 0.06, line: { width: 0 } }],
    },
  };
}
