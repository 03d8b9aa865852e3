/** Step responses: y with its setpoint above (and what a sensor makes of y), u below, on one time axis. */

/** @import {Figure, Metrics, Numbers, StepPanel, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { nearestIndex } from "../core/format.js";
import { axis, baseLayout, calmExtent, extent, holdRange, runawayExtent } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { ghostLine, lineOf } from "./signals.js";

/**
 * @typedef {object} StepInput
 * @property {StepPanel} step
 * @property {Metrics | null} metrics
 * @property {boolean} stable
 * @property {"setpoint" | "load"} signal
 * @property {StepPanel[]} ghosts
 * @property {string} timeUnit
 */

/**
 * @param {StepInput} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function stepResponse({ step, metrics, stable, signal, ghosts, timeUnit }, theme, held) {
  const { t, horizon } = step;
  const { y, u, y_m } = step[signal];
  const target = signal === "setpoint" ? 1 : 0;
  const unit = escapePlotly(timeUnit);
  const hover = `%{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>`;

  /** @param {keyof typeof import("./signals.js").SIGNALS} name @param {Numbers} x @param {Numbers} values @param {string} yaxis @returns {Trace} */
  const line = (name, x, values, yaxis) => ({
    type: "scatter",
    mode: "lines",
    name,
    x,
    y: values,
    yaxis,
    line: lineOf(name, theme),
    hovertemplate: `${name} = ${hover}`,
  });

  const peak = stable && metrics?.t_peak != null && metrics.peak != null && (metrics.overshoot_pct ?? 1) > 0 ? { t: metrics.t_peak, y: metrics.peak } : null;
  const settled = stable && metrics?.t_settle != null ? metrics.t_settle : null;

  /** @type {Trace[]} */
  const traces = [
    ...ghosts.flatMap((ghost) => [ghostTrace(ghost, "y", signal, theme), ghostTrace(ghost, "u", signal, theme)]),
    { ...line("r", [0, 0, horizon], [0, target, target], "y"), hoverinfo: "skip" },
    settleTrace(settled, t, y, theme),
    line("u", t.slice(0, u.length), u, "y2"),
    ...(y_m ? [line("y_m", t.slice(0, y_m.length), y_m, "y")] : []),
    line("y", t.slice(0, y.length), y, "y"),
    {
      type: "scatter",
      mode: "markers",
      name: "peak",
      x: [peak?.t ?? null],
      y: [peak?.y ?? null],
      yaxis: "y",
      marker: { symbol: "circle", size: 9, color: theme.paper, line: { color: theme.signal["y"], width: 2 } },
      hovertemplate: `peak ${hover}`,
    },
  ];

  const [yLow, yHigh] = extent(stable ? y : runawayExtent(y, target), [0, target]);
  const [uLow, uHigh] = stable ? calmExtent(u) : runawayExtent(u, 0);
  const ranges = {
    xaxis: held.moving && held.ranges["xaxis"] ? held.ranges["xaxis"] : /** @type {[number, number]} */ ([0, horizon]),
    yaxis: holdRange(held, "yaxis", yLow, yHigh),
    yaxis2: holdRange(held, "yaxis2", Math.min(0, uLow), Math.max(0, uHigh)),
  };
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { anchor: "y2", zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "y", ranges.yaxis, { domain: [0.41, 1] }),
      yaxis2: axis(theme, "u", ranges.yaxis2, { domain: [0, 0.34], nticks: 5 }),
    },
  };
}

/**
 * @param {StepPanel} ghost
 * @param {"y" | "u"} name
 * @param {"setpoint" | "load"} signal
 * @param {Theme} theme
 * @returns {Trace}
 */
function ghostTrace(ghost, name, signal, theme) {
  const values = ghost[signal][name];
  return {
    type: "scatter",
    mode: "lines",
    name: `kept ${name}`,
    x: ghost.t.slice(0, values.length),
    y: values,
    yaxis: name === "y" ? "y" : "y2",
    line: ghostLine(theme),
    hoverinfo: "skip",
  };
}

/**
 * A drop line from y to the time axis where it has settled.
 * @param {number | null} at
 * @param {Numbers} t
 * @param {Numbers} y
 * @param {Theme} theme
 * @returns {Trace}
 */
function settleTrace(at, t, y, theme) {
  const value = at === null ? null : (y[nearestIndex(t, at)] ?? null);
  return {
    type: "scatter",
    mode: "lines",
    name: "settled",
    x: value === null ? [] : [at, at],
    y: value === null ? [] : [0, value],
    yaxis: "y",
    line: { color: theme.muted, width: 1.25, dash: "dot" },
    hoverinfo: "skip",
  };
}
