/** Relative gains, or singular values and condition numbers, over frequency; and what a loop sees of the others. */

/** @import {Figure, Numbers, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";
import { lineOf } from "../signals.js";

/** @typedef {{name: string, signal: string, values: Numbers | number[]}} Curve */

/**
 * Curves over one axis.
 * @param {{x: Numbers, curves: Curve[], xTitle: string, yTitle: string, log: boolean, logY?: boolean, unit: string, show?: Range, most?: Range}} input  show: what the axis holds in any case; most: where it ends, wherever the curves go
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function curvesPlot({ x, curves, xTitle, yTitle, log, logY = false, unit, show, most = [-Infinity, Infinity] }, theme, held) {
  const traces = curves.map(
    ({ name, signal, values }) =>
      /** @type {Trace} */ ({
        type: "scatter",
        mode: "lines",
        name: escapePlotly(name),
        x,
        y: values,
        line: lineOf(signal, theme),
        hovertemplate: `${escapePlotly(name)} = %{y:.4~g} at %{x:.4~g} ${escapePlotly(unit)}<extra></extra>`,
      }),
  );
  const [lowest, highest] = extent(...curves.map(({ values }) => values), show ?? []);
  const [low, high] = [Math.max(lowest, most[0]), Math.min(highest, most[1])];
  const [first, last] = [x[0] ?? 0.01, x[x.length - 1] ?? 100];
  const ranges = {
    xaxis: /** @type {Range} */ (log ? [Math.log10(first), Math.log10(last)] : [first, last]),
    yaxis: logY ? holdRange(held, "yaxis", Math.log10(Math.max(low, 1e-12)), Math.log10(Math.max(high, 1e-11))) : holdRange(held, "yaxis", low, high),
  };
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, escapePlotly(xTitle), ranges.xaxis, log ? { type: "log", dtick: 1, zeroline: false } : { zeroline: false }),
      yaxis: axis(theme, escapePlotly(yTitle), ranges.yaxis, logY ? { type: "log", zeroline: false } : {}),
    },
  };
}

/** Magnitude of a complex curve. @param {{re: Numbers, im: Numbers}} curve */
export function magnitude({ re, im }) {
  return Array.from(re, (value, k) => Math.hypot(value, im[k] ?? 0));
}
