/** A run of a plant: signals one above the other over one time axis, with what has happened on the way. */

/** @import {Figure, Numbers, Range, Ranges, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, niceRange } from "../axes.js";
import { escapePlotly } from "../escape.js";

/** @typedef {{name: string, unit: string, signal: string, values: (number | null)[]}} Row */

/** Share of the height between two rows. */
const GAP = 0.05;

/**
 * The old range where the data fits into it, else one that holds both: an axis that grows does not breathe.
 * @param {Ranges} ranges @param {string} name @param {Range} data
 * @returns {Range}
 */
function grown(ranges, name, [low, high]) {
  const old = ranges[name];
  if (!old) return niceRange(low, high);
  return low >= old[0] && high <= old[1] ? old : niceRange(Math.min(low, old[0]), Math.max(high, old[1]));
}

/**
 * @param {{t: Numbers | number[], rows: Row[], window: Range, cursor: number | null, timeUnit: string}} run
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function plantRunPlot({ t, rows, window, cursor, timeUnit }, theme, { ranges: old }) {
  const unit = escapePlotly(timeUnit);
  const height = (1 - GAP * (rows.length - 1)) / rows.length;
  /** @type {Trace[]} */
  const traces = [];
  /** @type {Ranges} */
  const ranges = { xaxis: window };
  /** @type {Record<string, any>} */
  const axes = {};
  for (const [i, { name, unit: own, signal, values }] of rows.entries()) {
    const number = i === 0 ? "" : String(i + 1);
    const top = 1 - i * (height + GAP);
    const label = escapePlotly(name);
    const range = grown(old, `yaxis${number}`, extent(values));
    ranges[`yaxis${number}`] = range;
    axes[`yaxis${number}`] = axis(theme, own ? `${label} [${escapePlotly(own)}]` : label, range, { domain: [Math.max(0, top - height), top], nticks: 5, zeroline: false });
    traces.push({
      type: "scatter",
      mode: "lines",
      name: label,
      x: /** @type {number[]} */ (t),
      y: /** @type {number[]} */ (values),
      yaxis: `y${number}`,
      line: { color: theme.signal[signal] ?? theme.ink, width: 2.25 },
      hovertemplate: `${label} = %{y:.5~g} ${escapePlotly(own)} at %{x:.5~g} ${unit}<extra></extra>`,
    });
    traces.push({ type: "scatter", mode: "lines", name: `cursor${number}`, x: cursor === null ? [] : [cursor, cursor], y: cursor === null ? [] : [...range], yaxis: `y${number}`, line: { color: theme.muted, width: 1, dash: "dot" }, hoverinfo: "skip" });
  }
  const lowest = rows.length > 1 ? `y${rows.length}` : "y";
  return {
    traces,
    ranges,
    layout: { ...baseLayout(theme), margin: { l: 66, r: 14, t: 8, b: 40 }, ...axes, xaxis: axis(theme, `time [${unit}]`, window, { anchor: lowest, zeroline: false, nticks: 8 }) },
  };
}
