/** Responses of the predictor, PI and PID beside each other: y above, u below. */

/** @import {SmithRow} from "../../core/design/smith.js" */
/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { LOOPS } from "../../core/design/smith.js";
import { axis, baseLayout, calmExtent, extent, holdRange, runawayExtent } from "../axes.js";
import { lineOf } from "../signals.js";

/**
 * @param {{rows: SmithRow[], horizon: number, step: "setpoint" | "load", timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function smithResponsePlot({ rows, horizon, step, timeUnit }, theme, held) {
  const target = step === "setpoint" ? 1 : 0;
  const stable = rows.filter(({ closed_loop_stable }) => closed_loop_stable);
  const size = Math.max(0.5, ...stable.map(({ responses }) => Math.max(...extent(responses?.[step].y ?? []).map(Math.abs))));
  const of = (/** @type {"y" | "u"} */ signal, /** @type {(values: import("../../core/types.js").Numbers) => Range} */ calm) =>
    extent(...rows.map(({ responses, closed_loop_stable }) => {
      const values = responses?.[step][signal] ?? [0];
      return closed_loop_stable ? calm(values) : runawayExtent(values, size);
    }));
  const [yLow, yHigh] = extent(of("y", extent), [0, target]);
  const [uLow, uHigh] = extent(of("u", calmExtent), [0]);
  const ranges = { xaxis: /** @type {Range} */ ([0, horizon]), yaxis: holdRange(held, "yaxis", yLow, yHigh), yaxis2: holdRange(held, "yaxis2", uLow, uHigh) };

  /** @param {SmithRow} row @param {"y" | "u"} signal @returns {Trace} */
  const line = ({ name, responses }, signal) => {
    const { label, signal: colour } = LOOPS[name];
    const curve = responses?.[step];
    return { type: "scatter", mode: "lines", name: `${label} ${signal}`, x: curve?.t ?? [], y: curve?.[signal] ?? [], yaxis: signal === "y" ? "y" : "y2", line: { ...lineOf(colour, theme), width: name === "smith" ? 2.75 : 2 }, hovertemplate: `${label}: ${signal} = %{y:.4~g} at %{x:.4~g} ${timeUnit}<extra></extra>` };
  };
  const drawn = rows.toReversed();
  return {
    traces: [
      { type: "scatter", mode: "lines", name: "r", x: [0, horizon], y: [target, target], line: lineOf("r", theme), hoverinfo: "skip" },
      ...drawn.map((row) => line(row, "y")),
      ...drawn.map((row) => line(row, "u")),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${timeUnit}]`, ranges.xaxis, { anchor: "y2", zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "y", ranges.yaxis, { domain: [0.41, 1] }),
      yaxis2: axis(theme, "u", ranges.yaxis2, { domain: [0, 0.34], nticks: 5 }),
    },
  };
}
