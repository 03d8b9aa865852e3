/** Outputs with their setpoints, and inputs, of several loops over one time: side by side, or below each other. */

/** @import {Figure, Numbers, Range, Ranges, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange, runawayExtent } from "../axes.js";
import { escapePlotly } from "../escape.js";
import { lineOf } from "../signals.js";

/** @typedef {{name: string, unit: string, values: Numbers, setpoint: number | null}} ResponseRow  setpoint null: in manual, or an input */

/** Share of the height between two rows. */
const GAP = 0.06;
/** What is smaller than this part of the step is rounding: a decoupled output stays at zero. */
const ROUNDING = 1e-9;
/** Where the second column starts. */
const SECOND = 0.54;

/**
 * @param {{t: Numbers, outputs: ResponseRow[], inputs: ResponseRow[], horizon: number, timeUnit: string, stable: boolean, size: number, wide: boolean}} response
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function mimoResponsesPlot({ t, outputs, inputs, horizon, timeUnit, stable, size, wide }, theme, held) {
  const unit = escapePlotly(timeUnit);
  const columns = wide ? [outputs, inputs] : [[...outputs, ...inputs]];
  /** @type {Trace[]} */
  const traces = [];
  /** @type {Ranges} */
  const ranges = {};
  /** @type {Record<string, any>} */
  const axes = {};
  let count = 0;
  for (const [column, rows] of columns.entries()) {
    const height = (1 - GAP * (rows.length - 1)) / rows.length;
    const x = column === 0 ? "" : String(column + 1);
    ranges[`xaxis${x}`] = /** @type {Range} */ ([0, horizon]);
    for (const [i, { name, unit: own, values, setpoint }] of rows.entries()) {
      count += 1;
      const number = count === 1 ? "" : String(count);
      const signal = outputs.some((row) => row.name === name) ? "y" : "u";
      const label = escapePlotly(name);
      const top = 1 - i * (height + GAP);
      const [low, high] = stable ? extent(values, setpoint === null ? [0] : [0, setpoint]) : runawayExtent(values, size);
      const reach = /** @type {Range} */ (Math.max(-low, high) < ROUNDING * Math.abs(size) ? [0, Math.abs(size)] : [low, high]);
      const range = holdRange(held, `yaxis${number}`, ...reach);
      ranges[`yaxis${number}`] = range;
      axes[`yaxis${number}`] = axis(theme, own && own !== "-" ? `${label} [${escapePlotly(own)}]` : label, range, { domain: [Math.max(0, top - height), top], nticks: 5, anchor: `x${x}` });
      const on = { xaxis: `x${x}`, yaxis: `y${number}` };
      const line = setpoint === null ? { x: [], y: [] } : { x: [0, 0, horizon], y: [0, setpoint, setpoint] };
      traces.push(/** @type {Trace} */ ({ type: "scatter", mode: "lines", name: `r ${label}`, ...line, ...on, line: lineOf("r", theme), hoverinfo: "skip" }));
      traces.push(/** @type {Trace} */ ({ type: "scatter", mode: "lines", name: label, x: t, y: values, ...on, line: lineOf(signal, theme), hovertemplate: `${label} = %{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>` }));
    }
    const domain = wide ? (column === 0 ? [0, 1 - SECOND] : [SECOND, 1]) : [0, 1];
    axes[`xaxis${x}`] = axis(theme, `t [${unit}]`, /** @type {Range} */ (ranges[`xaxis${x}`]), { domain, anchor: `y${count === 1 ? "" : count}`, zeroline: false, nticks: 7 });
  }
  return { traces, ranges, layout: { ...baseLayout(theme), margin: { l: 62, r: 14, t: 8, b: 40 }, ...axes } };
}
