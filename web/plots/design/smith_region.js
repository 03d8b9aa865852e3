/** Plants on which loops stay stable, in a plane of their mismatch: the region of one filled, the limits of all. */

/** @import {SmithRegion} from "../../core/design/smith.js" */
/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */

import { contourLines } from "../../core/contours.js";
import { LOOPS, pctOf } from "../../core/design/smith.js";
import { axis, baseLayout } from "../axes.js";

const COLUMNS = 161;
/** Distances from a limit are of interest up to this share of the axis. */
const REACH = 0.15;
const HAIR = 1e-6;

/** @type {Record<string, string>} */
export const AXIS_NAMES = { K: "gain", tau: "time constants", theta: "dead time" };

/**
 * How far inside (above zero) or outside of the stable stretches a point lies, along its row; an end of the axis is no
 * limit. Contours at zero are exact where they cross a row.
 * @param {number} at @param {[number, number][]} stretches @param {Range} range
 */
export function insideBy(at, stretches, [low, high]) {
  const cap = REACH * (high - low);
  const inside = stretches.find(([a, b]) => at >= a && at <= b);
  if (inside) return Math.min(inside[0] > low ? at - inside[0] : cap, inside[1] < high ? inside[1] - at : cap, cap);
  return -Math.min(cap, ...stretches.map(([a, b]) => (at < a ? a - at : at - b)));
}

/** @param {import("../../core/contours.js").Point[][]} lines @returns {{x: (number | null)[], y: (number | null)[]}} in per cent */
function asCurve(lines) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  for (const line of lines) {
    for (const [along, across] of line) {
      x.push(pctOf(along));
      y.push(pctOf(across));
    }
    x.push(null);
    y.push(null);
  }
  return { x, y };
}

/**
 * @param {SmithRegion} region
 * @param {Theme} theme
 * @returns {Figure}
 */
export function smithRegionPlot({ along, across, along_range, across_range, rows, loops }, theme) {
  const [low, high] = along_range;
  const x = Array.from({ length: COLUMNS }, (_, i) => low + ((high - low) * i) / (COLUMNS - 1));
  const fields = loops.map(({ name, intervals }) => ({ name, z: intervals?.map((stretches) => x.map((at) => insideBy(at, stretches, along_range))) ?? null }));
  const ranges = { xaxis: /** @type {Range} */ ([pctOf(low), pctOf(high)]), yaxis: /** @type {Range} */ ([pctOf(across_range[0]), pctOf(across_range[1])]) };

  const smith = fields.find(({ name }) => name === "smith")?.z ?? null;
  const outside = -REACH * (high - low);
  // A rim outside of the axes closes the region where it leaves them.
  const rimmed = smith ? [x.map(() => outside), ...smith, x.map(() => outside)].map((row) => [outside].concat(row, outside)) : [];
  const [first = 0, last = 1] = [rows[0], rows.at(-1)];
  const area = smith ? contourLines([low - HAIR, ...x, high + HAIR], [first - HAIR, ...rows, last + HAIR], rimmed, 0) : [];
  const colour = (/** @type {string} */ signal) => theme.signal[signal] ?? theme.ink;

  /** @type {Trace[]} */
  const traces = [
    { type: "scatter", mode: "lines", name: "stable", ...asCurve(area), line: { width: 0 }, fill: "toself", fillcolor: `${colour("now")}24`, hoverinfo: "skip" },
    ...fields.toReversed().map(({ name, z }) => {
      const { signal, label } = LOOPS[name];
      const limit = asCurve(z ? contourLines(x, rows, z, 0) : []);
      return /** @type {Trace} */ ({
        type: "scatter",
        mode: "lines",
        name: label,
        x: limit.x,
        y: limit.y,
        line: { color: colour(signal), width: name === "smith" ? 2.75 : 2, dash: name === "smith" ? "solid" : name === "PI" ? "dash" : "dot" },
        hovertemplate: `limit of ${label}: %{x:.0f} %, %{y:.0f} %<extra></extra>`,
      });
    }),
    { type: "scatter", mode: "markers", name: "model", x: [0], y: [0], marker: { symbol: "cross-thin", size: 13, line: { color: theme.ink, width: 2 } }, hovertemplate: "the plant is as the model says<extra></extra>" },
  ];
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `${AXIS_NAMES[along]} of the plant, against the model [%]`, ranges.xaxis, { zerolinecolor: theme.axis, nticks: 8 }),
      yaxis: axis(theme, `${AXIS_NAMES[across]} [%]`, ranges.yaxis, { zerolinecolor: theme.axis }),
    },
  };
}
