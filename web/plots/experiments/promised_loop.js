/** The loop on the true plant, and over it what the model promised. */

/** @import {Figure, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, calmExtent, extent, holdRange, leftMargin } from "../axes.js";
import { escapePlotly } from "../escape.js";
import { lineOf } from "../signals.js";

/** How far beyond what was promised a curve may still make the axes grow. */
const BEYOND = 4;

/** @typedef {{t: number[], y: number[], u: number[]}} Curve */

/** @param {{true_: Curve, promised: Curve | null, r: {t: number[], y: number[]}, until: number, yName: string, uName: string, timeUnit: string}} run @param {Theme} theme @param {Held} held @returns {Figure} */
export function promisedLoopPlot({ true_, promised, r, until, yName, uName, timeUnit }, theme, held) {
  const unit = escapePlotly(timeUnit);
  const model = promised ?? { t: [], y: [], u: [] };
  const start = r.y[0] ?? 0;
  const sizes = (/** @type {number[]} */ values, /** @type {number} */ about) => values.map((value) => Math.abs(value - about));
  const reach = BEYOND * Math.max(1e-12, ...sizes(r.y, start), ...sizes(model.y, start));
  // A loop that runs away may leave the picture, or it would flatten the promise.
  const near = (/** @type {number[]} */ values, /** @type {number} */ about, /** @type {number} */ most) => values.map((value) => Math.min(about + most, Math.max(about - most, value)));
  const u0 = model.u[0] ?? 0;
  const uReach = promised ? BEYOND * Math.max(1e-12, ...sizes([...calmExtent(model.u)], u0)) : Infinity;
  const ranges = {
    xaxis: /** @type {[number, number]} */ ([0, until]),
    yaxis: holdRange(held, "yaxis", ...extent(near(true_.y, start, reach), model.y, r.y)),
    yaxis2: holdRange(held, "yaxis2", ...extent(near(calmExtent(true_.u), u0, uReach), promised ? calmExtent(model.u) : [])),
  };
  /** @param {string} name @param {number[]} t @param {number[]} y @param {string} signal @param {string} yaxis @returns {Trace} */
  const trace = (name, t, y, signal, yaxis) => ({ type: "scatter", mode: "lines", name, x: t, y, yaxis, line: lineOf(signal, theme), hovertemplate: `${name}: %{y:.5~g} at %{x:.5~g} ${unit}<extra></extra>` });
  return {
    ranges,
    traces: [
      trace("setpoint", r.t, r.y, "r", "y"),
      trace("true plant", true_.t, true_.y, "y", "y"),
      trace("promised", model.t, model.y, "model", "y"),
      trace("u", true_.t, true_.u, "u", "y2"),
      trace("u promised", model.t, model.u, "model", "y2"),
    ],
    layout: {
      ...baseLayout(theme),
      margin: { l: leftMargin(ranges.yaxis, ranges.yaxis2), r: 14, t: 8, b: 40 },
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { anchor: "y2", zeroline: false }),
      yaxis: axis(theme, escapePlotly(yName), ranges.yaxis, { domain: [0.36, 1], zeroline: false }),
      yaxis2: axis(theme, escapePlotly(uName), ranges.yaxis2, { domain: [0, 0.27], nticks: 4, zeroline: false }),
    },
  };
}
