/** Poles of the plant and of the closed loop in the complex plane. */

/** @import {Complex, Figure, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, holdRange } from "./axes.js";

/** Poles that dead time adds lie ever farther out: the window is for the slowest of them. */
const SHOWN_WITH_DEAD_TIME = 6;

/**
 * A window with the imaginary axis in it.
 * @param {Complex[]} poles
 * @returns {{re: Range, im: Range}}
 */
export function windowOf(poles) {
  const re = poles.map(([x]) => x);
  const im = poles.map(([, y]) => Math.abs(y));
  const reach = Math.max(...re.map(Math.abs), ...im) || 1;
  const [left, right] = [Math.min(0, ...re), Math.max(0, ...re)];
  const height = Math.max(...im, 0.35 * reach);
  return { re: [left - 0.15 * reach, Math.max(right, 0.2 * reach) + 0.1 * reach], im: [-1.15 * height, 1.15 * height] };
}

/**
 * @param {{plant: Complex[], loop: Complex[], complete: boolean}} input  loop empty where it is not known
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function polesPlot({ plant, loop, complete }, theme, held) {
  const slowest = complete ? loop : loop.slice(0, SHOWN_WITH_DEAD_TIME);
  const { re, im } = windowOf([...plant, ...slowest]);
  const ranges = { xaxis: holdRange(held, "xaxis", ...re), yaxis: holdRange(held, "yaxis", ...im) };
  const far = 10 * Math.max(...[...ranges.xaxis, ...ranges.yaxis].map(Math.abs));
  /** @param {string} name @param {Complex[]} points @param {object} marker @returns {Trace} */
  const dots = (name, points, marker) => ({
    type: "scatter",
    mode: "markers",
    name,
    x: points.map(([x]) => x),
    y: points.map(([, y]) => y),
    marker,
    hovertemplate: `${name}<br>s = %{x:.4~g} %{y:+.4~g} j<extra></extra>`,
  });
  return {
    traces: [
      dots("plant", plant, { symbol: "x-thin", size: 11, line: { color: theme.ink, width: 2.25 } }),
      dots("closed loop", loop, { symbol: "square", size: 9, color: theme.signal["pole"] ?? theme.ink, line: { color: theme.paper, width: 1.5 } }),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, "Re s", ranges.xaxis, { zerolinewidth: 1.5, zerolinecolor: theme.muted }),
      yaxis: axis(theme, "Im s", ranges.yaxis),
      shapes: [{ type: "rect", layer: "below", xref: "x", yref: "paper", x0: 0, x1: far, y0: 0, y1: 1, fillcolor: theme.bad, opacity: 0.06, line: { width: 0 } }],
    },
  };
}
