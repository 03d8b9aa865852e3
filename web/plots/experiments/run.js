/** An experiment as it is recorded: the output above, what moves it below, drawn as far as the clock has come. */

/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, leftMargin, niceRange } from "../axes.js";
import { escapePlotly } from "../escape.js";
import { lineOf } from "../signals.js";

/** @typedef {{t: number[], y: (number | null)[]}} Series */
/**
 * @typedef {object} Run
 * @property {Series} y  as measured
 * @property {Series} u  in steps where it is held
 * @property {Series} r  setpoint, or a dead band's edges; empty without
 * @property {Series} turns  turning points
 * @property {Range} window
 * @property {Range | null} yRange  null: grows with what is shown
 * @property {Range | null} uRange
 * @property {string} yName @property {string} uName @property {string} timeUnit
 */

/** The old range where what is shown fits into it, else one with room on both sides. @param {Range | undefined} old @param {Range} data @returns {Range} */
function grown(old, [low, high]) {
  if (!old) return niceRange(low, high);
  if (low >= old[0] && high <= old[1] && high - low > 0.2 * (old[1] - old[0])) return old;
  return niceRange(low - 0.15 * (high - low), high + 0.15 * (high - low));
}

/** @param {Run} run @param {Theme} theme @param {Held} held @returns {Figure} */
export function experimentRunPlot({ y, u, r, turns, window, yRange, uRange, yName, uName, timeUnit }, theme, { ranges: old }) {
  const unit = escapePlotly(timeUnit);
  const ranges = { xaxis: window, yaxis: yRange ?? grown(old["yaxis"], extent(y.y, r.y)), yaxis2: uRange ?? grown(old["yaxis2"], extent(u.y)) };
  /** @param {string} name @param {Series} series @param {string} yaxis @param {string} signal @param {object} [more] @returns {Trace} */
  const trace = (name, series, yaxis, signal, more = {}) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: series.t,
    y: series.y,
    yaxis,
    line: lineOf(signal, theme),
    hovertemplate: `%{y:.5~g} at %{x:.5~g} ${unit}<extra></extra>`,
    ...more,
  });
  return {
    ranges,
    traces: [
      trace("r", r, "y", "r", { hoverinfo: "skip" }),
      trace("y", y, "y", "y"),
      trace("u", u, "y2", "u"),
      trace("turns", turns, "y", "y", { mode: "markers", marker: { size: 7, color: theme.paper, line: { color: theme.signal["u"] ?? theme.ink, width: 2 } } }),
    ],
    layout: {
      ...baseLayout(theme),
      margin: { l: leftMargin(ranges.yaxis, ranges.yaxis2), r: 14, t: 8, b: 40 },
      xaxis: axis(theme, `time [${unit}]`, window, { anchor: "y2", zeroline: false }),
      yaxis: axis(theme, escapePlotly(yName), ranges.yaxis, { domain: [0.36, 1], zeroline: false }),
      yaxis2: axis(theme, escapePlotly(uName), ranges.yaxis2, { domain: [0, 0.27], nticks: 4, zeroline: false }),
    },
  };
}
