/** ln |S| over an even frequency axis, with the areas below and above zero. */

/** @import {BodeIntegralAnswer} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** Towards 0 the curve of a loop with an integrator goes down without end. */
const LOWEST = -4;

/**
 * @param {{answer: BodeIntegralAnswer, timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function bodeIntegralPlot({ answer: { omega, ln_S }, timeUnit }, theme, held) {
  const unit = escapePlotly(timeUnit);
  /** @param {string} name @param {(value: number) => number} part @param {string} colour @returns {Trace} */
  const area = (name, part, colour) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: omega,
    y: Array.from(ln_S, part),
    line: { color: colour, width: 0 },
    fill: "tozeroy",
    fillcolor: `${colour}33`,
    hoverinfo: "skip",
  });
  const [low, high] = extent(ln_S, [0]);
  const ranges = {
    xaxis: /** @type {Range} */ ([0, omega[omega.length - 1] ?? 1]),
    yaxis: holdRange(held, "yaxis", Math.max(low, LOWEST), Math.max(high, 0.1)),
  };
  return {
    traces: [
      area("gained", (value) => Math.min(value, 0), theme.good),
      area("paid", (value) => Math.max(value, 0), theme.bad),
      { type: "scatter", mode: "lines", name: "S", x: omega, y: ln_S, line: lineOf("S", theme), hovertemplate: `ln |S| = %{y:.4~g} at %{x:.4~g} rad/${unit}<extra></extra>` },
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `ω [rad/${unit}], even scale`, ranges.xaxis, { zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "ln |S|", ranges.yaxis, { zerolinewidth: 1.5, zerolinecolor: theme.muted }),
    },
  };
}
