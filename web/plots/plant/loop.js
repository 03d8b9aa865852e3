/** A plant under control: setpoint, output and what the sensor says above, controller output below. */

/** @import {Figure, Numbers, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";
import { lineOf } from "../signals.js";

/**
 * @param {{t: Numbers, r: Numbers, y: Numbers, y_m: Numbers, u: Numbers, output: string, outputUnit: string, input: string, inputUnit: string, timeUnit: string}} run
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function plantLoopPlot({ t, r, y, y_m, u, output, outputUnit, input, inputUnit, timeUnit }, theme, held) {
  /** @param {string} name @param {string} signal @param {Numbers} values @param {string} unit @param {string} yaxis @returns {Trace} */
  const line = (name, signal, values, unit, yaxis) => ({
    type: "scatter",
    mode: "lines",
    name: signal,
    x: t,
    y: values,
    yaxis,
    line: lineOf(signal, theme),
    hovertemplate: `${escapePlotly(name)} = %{y:.5~g} ${escapePlotly(unit)} at %{x:.4~g} ${escapePlotly(timeUnit)}<extra></extra>`,
  });
  const traces = [line("setpoint", "r", r, outputUnit, "y"), line("measured", "y_m", y_m, outputUnit, "y"), line(output, "y", y, outputUnit, "y"), line(input, "u", u, inputUnit, "y2")];
  const ranges = {
    xaxis: /** @type {[number, number]} */ ([t[0] ?? 0, t.at(-1) ?? 1]),
    yaxis: holdRange(held, "yaxis", ...extent(r, y, y_m)),
    yaxis2: holdRange(held, "yaxis2", ...extent(u)),
  };
  const named = (/** @type {string} */ name, /** @type {string} */ unit) => escapePlotly(unit ? `${name} [${unit}]` : name);
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      margin: { l: 66, r: 14, t: 8, b: 40 },
      xaxis: axis(theme, `time [${escapePlotly(timeUnit)}]`, ranges.xaxis, { anchor: "y2", zeroline: false }),
      yaxis: axis(theme, named(output, outputUnit), ranges.yaxis, { domain: [0.42, 1], zeroline: false }),
      yaxis2: axis(theme, named(input, inputUnit), ranges.yaxis2, { domain: [0, 0.34], nticks: 4, zeroline: false }),
    },
  };
}
