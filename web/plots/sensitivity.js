/** The gang of six against frequency, and against time. */

/** @import {Figure, GangStepsPanel, SensitivityPanel, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange, runawayExtent } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** @typedef {"S" | "PS" | "CS" | "T" | "CFS" | "TF"} GangMember */

const FLOOR_DB = -60;

/**
 * @param {{sensitivity: SensitivityPanel, curves: GangMember[], timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function sensitivityPlot({ sensitivity, curves, timeUnit }, theme, held) {
  const { omega } = sensitivity;
  const unit = escapePlotly(timeUnit);
  const traces = curves.map(
    (name) =>
      /** @type {Trace} */ ({
        type: "scatter",
        mode: "lines",
        name,
        x: omega,
        y: sensitivity[`${name}_dB`] ?? [],
        line: lineOf(name, theme),
        hovertemplate: `|${name}| = %{y:.2f} dB at %{x:.4~g} rad/${unit}<extra></extra>`,
      }),
  );
  const [low, high] = extent(...curves.map((name) => sensitivity[`${name}_dB`] ?? []), [0]);
  const ranges = {
    xaxis:
      held.moving && held.ranges["xaxis"]
        ? held.ranges["xaxis"]
        : /** @type {[number, number]} */ ([Math.log10(omega[0] ?? 0.01), Math.log10(omega[omega.length - 1] ?? 100)]),
    yaxis: holdRange(held, "yaxis", Math.max(low, FLOOR_DB), Math.max(high, 6), 10),
  };
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `ω [rad/${unit}]`, ranges.xaxis, { type: "log", dtick: 1, zeroline: false }),
      yaxis: axis(theme, "magnitude [dB]", ranges.yaxis, { zerolinewidth: 1.5, zerolinecolor: theme.muted }),
    },
  };
}

/**
 * Responses to unit steps.
 * @param {{steps: GangStepsPanel, curves: GangMember[], stable: boolean, timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function gangStepsPlot({ steps, curves, stable, timeUnit }, theme, held) {
  const unit = escapePlotly(timeUnit);
  const traces = curves.map(
    (name) =>
      /** @type {Trace} */ ({
        type: "scatter",
        mode: "lines",
        name,
        x: steps.t,
        y: steps[name],
        line: lineOf(name, theme),
        hovertemplate: `${name}: %{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>`,
      }),
  );
  const extents = curves.map((name) => (stable ? extent(steps[name]) : runawayExtent(steps[name], 1)));
  const [low, high] = extent(extents.flat(), [0, 1]);
  const end = steps.t[steps.t.length - 1] ?? 1;
  const ranges = { xaxis: held.moving && held.ranges["xaxis"] ? held.ranges["xaxis"] : /** @type {[number, number]} */ ([0, end]), yaxis: holdRange(held, "yaxis", low, high) };
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `t [${unit}]`, ranges.xaxis),
      yaxis: axis(theme, "step response", ranges.yaxis),
    },
  };
}
