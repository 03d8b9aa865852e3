/** A run under state feedback: what happens, what the linear model predicted, and the limits, over one time axis. */

/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";

/** @typedef {{name: string, unit: string, signal: string, t: number[], values: number[], whole: number[], predictedT: number[], predicted: number[], estimate: number[], limits: number[]}} FeedbackRow  estimate: the observer's, empty without one; whole: the values of the complete run, which the axis is for */

const GAP = 0.06;
/** How far beyond what happens the prediction may widen an axis, in parts of what happens. */
const REACH = 0.6;

/** @param {FeedbackRow} row @returns {Range} */
function shown({ whole, predicted, limits }) {
  const [low, high] = whole.length > 0 ? extent(whole) : extent(predicted);
  const reach = REACH * Math.max(high - low, 1e-9);
  const [least, most] = extent(predicted.length > 0 ? predicted : whole, limits.filter((limit) => limit > low - reach && limit < high + reach));
  return [Math.max(Math.min(low, least), low - reach), Math.min(Math.max(high, most), high + reach)];
}

/**
 * @param {{rows: FeedbackRow[], horizon: number, cursor: number, timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function feedbackRunPlot({ rows, horizon, cursor, timeUnit }, theme, held) {
  const unit = escapePlotly(timeUnit);
  const height = (1 - GAP * (rows.length - 1)) / rows.length;
  /** @type {Range} */
  const window = [0, horizon];
  /** @type {Trace[]} */
  const traces = [];
  /** @type {Record<string, Range>} */
  const ranges = { xaxis: window };
  /** @type {Record<string, any>} */
  const axes = {};
  for (const [i, row] of rows.entries()) {
    const number = i === 0 ? "" : String(i + 1);
    const top = 1 - i * (height + GAP);
    const label = escapePlotly(row.name);
    const own = escapePlotly(row.unit);
    const range = holdRange(held, `yaxis${number}`, ...shown(row));
    ranges[`yaxis${number}`] = range;
    axes[`yaxis${number}`] = axis(theme, own ? `${label} [${own}]` : label, range, { domain: [Math.max(0, top - height), top], nticks: 5 });
    /** @param {string} name @param {number[]} x @param {number[]} y @param {object} line @returns {Trace} */
    const curve = (name, x, y, line) => ({ type: "scatter", mode: "lines", name: `${name}${number}`, x, y, yaxis: `y${number}`, line, hovertemplate: `${label}, ${name}: %{y:.4~g} ${own} at %{x:.4~g} ${unit}<extra></extra>` });
    const colour = theme.signal[row.signal] ?? theme.ink;
    /** @type {Trace} */
    const limit = {
      ...curve("limit", row.limits.flatMap(() => [0, horizon, NaN]), row.limits.flatMap((value) => [value, value, NaN]), { color: theme.bad, width: 1.25, dash: "dot" }),
      hoverinfo: "skip",
    };
    traces.push(
      limit,
      curve("linear prediction", row.predictedT, row.predicted, { color: theme.muted, width: 1.75, dash: "dash" }),
      curve("estimate", row.estimate.length > 0 ? row.t.slice(0, row.estimate.length) : [], row.estimate, { color: theme.signal["d"] ?? theme.ink, width: 1.75, dash: "dot" }),
      curve("what happens", row.t, row.values, { color: colour, width: 2.5 }),
      { type: "scatter", mode: "lines", name: `now${number}`, x: [cursor, cursor], y: [...range], yaxis: `y${number}`, line: { color: theme.axis, width: 1 }, hoverinfo: "skip" },
    );
  }
  return {
    traces,
    ranges,
    layout: { ...baseLayout(theme), margin: { l: 70, r: 12, t: 8, b: 40 }, ...axes, xaxis: axis(theme, `time [${unit}]`, window, { anchor: rows.length > 1 ? `y${rows.length}` : "y", zeroline: false, nticks: 8 }) },
  };
}
