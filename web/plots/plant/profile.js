/** States in a row, such as the trays of a column, as they are now and as they were at the start. */

/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";

/**
 * @param {{index: number[], now: number[], first: number[], stem: string, unit: string}} profile
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function profilePlot({ index, now, first, stem, unit }, theme, held) {
  const name = escapePlotly(stem);
  /** @param {string} what @param {number[]} x @param {object} line @returns {Trace} */
  const curve = (what, x, line) => ({ type: "scatter", mode: "lines", name: what, x, y: index, line, hovertemplate: `${what}: ${name} = %{x:.4~g} at %{y}<extra></extra>` });
  const traces = [curve("at the start", first, { color: theme.muted, width: 1.5, dash: "dash" }), curve("now", now, { color: theme.signal["y"], width: 2.5 })];
  const [low, high] = extent(now, first);
  const old = held.ranges["xaxis"];
  // While it moves the axis only grows.
  const fits = old !== undefined && low >= old[0] && high <= old[1];
  /** @type {{xaxis: Range, yaxis: Range}} */
  const ranges = { xaxis: fits ? old : holdRange({ ranges: {}, moving: false }, "xaxis", low, high), yaxis: [(index[0] ?? 1) - 0.5, (index.at(-1) ?? 1) + 0.5] };
  return { traces, ranges, layout: { ...baseLayout(theme), xaxis: axis(theme, escapePlotly(unit ? `${stem} [${unit}]` : stem), ranges.xaxis, { zeroline: false }), yaxis: axis(theme, "number", ranges.yaxis, { zeroline: false }) } };
}
