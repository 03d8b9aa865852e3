/** The s-plane of a state feedback: poles of the plant, of the feedback and of the observer. */

/** @import {Complex, Figure, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, holdRange } from "../axes.js";
import { windowOf } from "../poles.js";

/**
 * @param {{plant: Complex[], feedback: Complex[], observer: Complex[]}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function feedbackPolesPlot({ plant, feedback, observer }, theme, held) {
  const { re, im } = windowOf([...plant, ...feedback, ...observer]);
  const ranges = { xaxis: holdRange(held, "xaxis", ...re), yaxis: holdRange(held, "yaxis", ...im) };
  const far = 10 * Math.max(...[...ranges.xaxis, ...ranges.yaxis].map(Math.abs));
  /** @param {string} name @param {Complex[]} points @param {object} marker @returns {Trace} */
  const dots = (name, points, marker) => ({ type: "scatter", mode: "markers", name, x: points.map(([x]) => x), y: points.map(([, y]) => y), marker, hovertemplate: `${name}<br>s = %{x:.4~g} %{y:+.4~g} j<extra></extra>` });
  return {
    traces: [
      dots("plant", plant, { symbol: "x-thin", size: 11, line: { color: theme.ink, width: 2.25 } }),
      dots("observer", observer, { symbol: "circle-open", size: 10, line: { color: theme.signal["P"] ?? theme.ink, width: 2.25 }, color: theme.signal["P"] ?? theme.ink }),
      dots("feedback", feedback, { symbol: "square", size: 10, color: theme.signal["pole"] ?? theme.ink, line: { color: theme.paper, width: 1.5 } }),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      margin: { l: 46, r: 10, t: 8, b: 38 },
      dragmode: false,
      xaxis: axis(theme, "Re s", ranges.xaxis, { zerolinewidth: 1.5, zerolinecolor: theme.muted }),
      yaxis: axis(theme, "Im s", ranges.yaxis, { nticks: 5 }),
      shapes: [{ type: "rect", layer: "below", xref: "x", yref: "paper", x0: 0, x1: far, y0: 0, y1: 1, fillcolor: theme.bad, opacity: 0.06, line: { width: 0 } }],
    },
  };
}
