/** The gang of four against frequency. */

/** @import {Figure, SensitivityPanel, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** @typedef {"S" | "PS" | "CS" | "T"} GangMember */

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
        y: sensitivity[`${name}_dB`],
        line: lineOf(name, theme),
        hovertemplate: `|${name}| = %{y:.2f} dB at %{x:.4~g} rad/${unit}<extra></extra>`,
      }),
  );
  const [low, high] = extent(...curves.map((name) => sensitivity[`${name}_dB`]), [0]);
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
