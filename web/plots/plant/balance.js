/** What is generated and what is taken away over one state: they meet at the steady states. */

/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";

const COLOURS = ["u", "y", "d", "y_m"];

/**
 * @param {{values: (number | null)[], curves: {name: string, values: (number | null)[]}[], steady: {x: number, y: number, stable: boolean}[], state: string, stateUnit: string, unit: string, low: number, high: number}} balance
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function balancePlot({ values, curves, steady, state, stateUnit, unit, low, high }, theme, held) {
  const x = escapePlotly(state);
  /** @type {Trace[]} */
  const lines = curves.map((curve, i) => ({
    type: "scatter",
    mode: "lines",
    name: escapePlotly(curve.name),
    x: values,
    y: curve.values,
    line: { color: theme.signal[COLOURS[i % COLOURS.length] ?? "y"], width: 2.5, dash: i === 1 ? "dash" : "solid" },
    hovertemplate: `${escapePlotly(curve.name)} = %{y:.5~g} at ${x} = %{x:.5~g}<extra></extra>`,
  }));
  const marks = (/** @type {boolean} */ stable) => steady.filter((each) => each.stable === stable);
  /** @type {Trace[]} */
  const points = [true, false].map((stable) => ({ type: "scatter", mode: /** @type {const} */ ("markers"), name: stable ? "stable" : "unstable", x: marks(stable).map((each) => each.x), y: marks(stable).map((each) => each.y), marker: stable ? { size: 11, color: theme.good } : { size: 11, color: theme.paper, line: { color: theme.bad, width: 2.5 } }, hovertemplate: `${stable ? "stable" : "unstable"} at ${x} = %{x:.5~g}<extra></extra>` }));
  /** @type {{xaxis: Range, yaxis: Range}} */
  const ranges = { xaxis: [low, high], yaxis: holdRange(held, "yaxis", ...extent(...curves.map((curve) => curve.values))) };
  return { traces: [...lines, ...points], ranges, layout: { ...baseLayout(theme), margin: { l: 66, r: 14, t: 8, b: 40 }, xaxis: axis(theme, escapePlotly(stateUnit ? `${state} [${stateUnit}]` : state), ranges.xaxis, { zeroline: false }), yaxis: axis(theme, escapePlotly(unit), ranges.yaxis) } };
}
