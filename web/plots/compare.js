/** Responses of y with several controllers, each in a colour and dash of its own, and bands for a model that errs. */

/** @import {ComparedRow} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange, runawayExtent } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** @typedef {ComparedRow & {signal: string}} Case  a row with the signal whose colour and dash it has */

/**
 * @param {{cases: Case[], horizon: number, step: "setpoint" | "load", timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function comparePlot({ cases, horizon, step, timeUnit }, theme, held) {
  const unit = escapePlotly(timeUnit);
  const drawn = cases.filter(({ responses }) => responses);
  const size = step === "setpoint" ? 1 : Math.max(0.1, ...drawn.filter(({ closed_loop_stable }) => closed_loop_stable).map(({ load }) => Math.abs(load?.["peak"] ?? 0)));
  const extents = drawn.map(({ responses, closed_loop_stable, sensitivity }) => {
    const y = responses?.[step].y ?? [];
    const band = sensitivity?.[step];
    if (!closed_loop_stable) return runawayExtent(y, size);
    return band ? extent(y, band.low, band.high) : extent(y);
  });
  const [low, high] = extent(...extents, [0, step === "setpoint" ? 1 : 0]);
  const ranges = {
    xaxis: /** @type {Range} */ ([0, horizon]),
    yaxis: holdRange(held, "yaxis", low, high),
  };

  /** @type {Trace[]} */
  const bands = drawn.flatMap(({ signal, label, sensitivity }) => {
    const band = sensitivity?.[step];
    if (!sensitivity || !band) return [];
    const t = Array.from(sensitivity.t);
    const colour = theme.signal[signal] ?? theme.ink;
    return {
      type: "scatter",
      mode: "lines",
      name: `band ${escapePlotly(label)}`,
      x: [...t, ...t.toReversed()],
      y: [...band.high, ...Array.from(band.low).toReversed()],
      line: { color: colour, width: 0 },
      fill: "toself",
      fillcolor: `${colour}1a`,
      hoverinfo: "skip",
    };
  });
  const target = step === "setpoint" ? 1 : 0;
  return {
    traces: [
      ...bands,
      { type: "scatter", mode: "lines", name: "r", x: [0, horizon], y: [target, target], line: lineOf("r", theme), hoverinfo: "skip" },
      // The present settings come first and are drawn last: they lie on top.
      ...drawn.toReversed().map(
        ({ signal, label, responses }) =>
          /** @type {Trace} */ ({
            type: "scatter",
            mode: "lines",
            name: escapePlotly(label),
            x: responses?.[step].t ?? [],
            y: responses?.[step].y ?? [],
            line: lineOf(signal, theme),
            hovertemplate: `${escapePlotly(label)}: %{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>`,
          }),
      ),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "process output y", ranges.yaxis),
    },
  };
}
