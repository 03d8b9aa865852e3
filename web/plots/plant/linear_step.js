/** The step of a linear model beside that of the plant it was made from. */

/** @import {Figure, Numbers, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";

/**
 * @param {{t: Numbers, linear: (number | null)[], nonlinear: (number | null)[], output: string, unit: string, timeUnit: string}} step
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function linearStepPlot({ t, linear, nonlinear, output, unit, timeUnit }, theme, held) {
  const name = escapePlotly(output);
  /** @param {string} what @param {(number | null)[]} y @param {object} line @returns {Trace} */
  const curve = (what, y, line) => ({ type: "scatter", mode: "lines", name: what, x: t, y, line, hovertemplate: `${what}: ${name} = %{y:.5~g} at %{x:.4~g} ${escapePlotly(timeUnit)}<extra></extra>` });
  const traces = [curve("plant", nonlinear, { color: theme.signal["y"], width: 2.5 }), curve("linear model", linear, { color: theme.signal["u"], width: 2, dash: "dash" })];
  // An unstable linear model runs away for ever; the plant does not: what the plant does is to be seen.
  const [low, high] = extent(nonlinear);
  const room = 1.5 * (high - low || Math.abs(high) || 1);
  const [least, most] = extent(linear, nonlinear);
  const ranges = { xaxis: /** @type {[number, number]} */ ([t[0] ?? 0, t.at(-1) ?? 1]), yaxis: holdRange(held, "yaxis", Math.max(least, low - room), Math.min(most, high + room)) };
  return { traces, ranges, layout: { ...baseLayout(theme), margin: { l: 66, r: 14, t: 8, b: 40 }, xaxis: axis(theme, `time [${escapePlotly(timeUnit)}]`, ranges.xaxis, { zeroline: false }), yaxis: axis(theme, escapePlotly(unit ? `${output} [${unit}]` : output), ranges.yaxis, { zeroline: false }) } };
}
