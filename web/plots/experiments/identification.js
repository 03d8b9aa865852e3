/** A record with the model's answer over it, the lines that the model is read off, what is left over, and the input. */

/** @import {LineName, Lines, Recorded} from "../../core/experiments/types.js" */
/** @import {Figure, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { LINES } from "../../core/experiments/construction.js";
import { stairs } from "../../core/experiments/stairs.js";
import { axis, baseLayout, extent, holdRange, leftMargin } from "../axes.js";
import { escapePlotly } from "../escape.js";
import { lineOf } from "../signals.js";

/** Up to so many samples are drawn one by one; more are a line. */
const DOTS = 400;

/** @typedef {{record: Recorded, y_hat: number[] | null, residuals: (number | null)[] | null, lines: Lines, drawn: LineName[], reads: {t: number[], y: number[]}, tangent: {t: number[], y: number[]}, yName: string, uName: string, timeUnit: string}} Drawn */

/** @param {Drawn} data @param {Theme} theme @param {Held} held @returns {Figure} */
export function identificationPlot({ record, y_hat, residuals, lines, drawn, reads, tangent, yName, uName, timeUnit }, theme, held) {
  const { t, u, y, hold } = record;
  const input = hold === "zero" ? stairs(t, u) : { t, y: u };
  const unit = escapePlotly(timeUnit);
  const span = /** @type {[number, number]} */ ([t[0] ?? 0, t.at(-1) ?? 1]);
  const ranges = {
    xaxis: span,
    yaxis: holdRange(held, "yaxis", ...extent(y, y_hat ?? [])),
    yaxis2: holdRange(held, "yaxis2", ...extent(residuals ?? [], [0])),
    yaxis3: holdRange(held, "yaxis3", ...extent(u, [record.u_before])),
  };
  /** @param {string} name @param {{t: (number | null)[], y: (number | null)[]}} at @param {Partial<Trace>} more @returns {Trace} */
  const trace = (name, at, more) => ({ type: "scatter", mode: "lines", name, x: at.t, y: at.y, hovertemplate: `%{y:.5~g} at %{x:.5~g} ${unit}<extra></extra>`, ...more });
  const colour = theme.signal["construction"] ?? theme.ink;
  const times = drawn.filter((name) => LINES[name].time && name in lines);
  const levels = drawn.filter((name) => !LINES[name].time && name in lines);
  const across = [...span, null];
  const edges = [...ranges.yaxis, null];
  const dots = t.length <= DOTS;
  return {
    ranges,
    traces: [
      trace("levels", { t: levels.flatMap(() => across), y: levels.flatMap((name) => [lines[name] ?? null, lines[name] ?? null, null]) }, { line: { color: colour, width: 1, dash: "dash" }, hoverinfo: "skip" }),
      trace("times", { t: times.flatMap((name) => [lines[name] ?? null, lines[name] ?? null, null]), y: times.flatMap(() => edges) }, { line: { color: colour, width: 1.25, dash: "dot" }, hoverinfo: "skip" }),
      trace("tangent", tangent, { line: { color: colour, width: 2 }, hoverinfo: "skip" }),
      trace("record", { t, y }, dots ? { mode: "markers", marker: { size: 4.5, color: theme.signal["y"] } } : { line: { color: theme.signal["y"] ?? theme.ink, width: 1.25 } }),
      trace("model", { t, y: y_hat ?? [] }, { line: lineOf("model", theme) }),
      trace("reads", reads, { mode: "markers", marker: { size: 8, color: theme.paper, line: { color: colour, width: 2 } }, hoverinfo: "skip" }),
      trace("residuals", { t, y: residuals ?? [] }, { yaxis: "y2", line: { color: theme.muted, width: 1.25 } }),
      trace("input", input, { yaxis: "y3", line: lineOf("u", theme) }),
    ],
    layout: {
      ...baseLayout(theme),
      margin: { l: leftMargin(ranges.yaxis, ranges.yaxis2, ranges.yaxis3), r: 14, t: 22, b: 40 },
      xaxis: axis(theme, `time [${unit}]`, span, { anchor: "y3", zeroline: false }),
      yaxis: axis(theme, escapePlotly(yName), ranges.yaxis, { domain: [0.45, 1], zeroline: false }),
      yaxis2: axis(theme, "residual", ranges.yaxis2, { domain: [0.21, 0.38], nticks: 3 }),
      yaxis3: axis(theme, escapePlotly(uName), ranges.yaxis3, { domain: [0, 0.14], nticks: 3, zeroline: false }),
    },
  };
}
