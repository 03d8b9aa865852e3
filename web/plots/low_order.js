/** Low-order models over the true step response of the plant. */

/** @import {ApproximateAnswer} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Numbers, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/**
 * @param {{answer: ApproximateAnswer, type: "FOPDT" | "SOPDT", timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure | null} null where there is no step response to come near to
 */
export function lowOrderPlot({ answer, type, timeUnit }, theme, held) {
  const { t, y } = answer;
  if (!t || !y) return null;
  const unit = escapePlotly(timeUnit);
  const models = answer.models.filter((model) => model.type === type && model.y);
  /** @param {string} name @param {Numbers} values @returns {Trace} */
  const line = (name, values) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: t,
    y: values,
    line: lineOf(name, theme),
    hovertemplate: `${name.replace("_", " ")}: %{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>`,
  });
  const [low, high] = extent(y, [0], ...models.map((model) => model.y ?? []));
  const ranges = {
    xaxis: /** @type {[number, number]} */ ([0, t[t.length - 1] ?? 1]),
    yaxis: holdRange(held, "yaxis", low, high),
  };
  return {
    traces: [line("y", y), ...models.map((model) => line(model.method, model.y ?? []))],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "step response y", ranges.yaxis),
    },
  };
}
