/** y(t) as the inverse transform has it, with the simulation of the same transform laid over it. */

/** @import {LaplaceAnswer} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Theme} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange, runawayExtent } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** So many marks of the simulation that the line between them is still seen. */
const MARKS = 30;

/**
 * @param {{answer: LaplaceAnswer, timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function laplacePlot({ answer, timeUnit }, theme, held) {
  const { t, y, simulated_t, simulated_y, truncated_at } = answer.response;
  const unit = escapePlotly(timeUnit);
  const every = Math.max(1, Math.floor(simulated_t.length / MARKS));
  const marks = Array.from(simulated_t.keys()).filter((i) => i % every === 0);
  const [low, high] = extent(truncated_at === null ? y : runawayExtent(y, 0), [0]);
  const ranges = {
    xaxis: /** @type {[number, number]} */ ([0, answer.horizon]),
    yaxis: holdRange(held, "yaxis", low, high),
  };
  return {
    traces: [
      {
        type: "scatter",
        mode: "lines",
        name: "y",
        x: t,
        y,
        line: lineOf("y", theme),
        hovertemplate: `y = %{y:.5~g} at %{x:.4~g} ${unit}<extra></extra>`,
      },
      {
        type: "scatter",
        mode: "markers",
        name: "simulated",
        x: marks.map((i) => simulated_t[i] ?? null),
        y: marks.map((i) => simulated_y[i] ?? null),
        marker: { symbol: "circle-open", size: 8, color: theme.signal["simulated"], line: { width: 1.75, color: theme.signal["simulated"] } },
        hovertemplate: `simulated: %{y:.5~g} at %{x:.4~g} ${unit}<extra></extra>`,
      },
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "y", ranges.yaxis),
    },
  };
}
