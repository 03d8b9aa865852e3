/** Steady states over an input: stable ones solid, unstable ones dashed, with turning and Hopf points. */

/** @import {Figure, Numbers, Theme, Trace} from "../../core/types.js" */
/** @import {Held} from "../axes.js" */

import { axis, baseLayout, extent, holdRange } from "../axes.js";
import { escapePlotly } from "../escape.js";

/** @typedef {{values: Numbers, y: Numbers, pieces: {first: number, last: number, stable: boolean}[]}} Branch */
/** @typedef {{value: number, y: number}} Point */

/**
 * One line of several pieces, with gaps between.
 * @param {Branch[]} branches @param {boolean} stable
 * @returns {{x: (number | null)[], y: (number | null)[]}}
 */
export function piecesOf(branches, stable) {
  /** @type {{x: (number | null)[], y: (number | null)[]}} */
  const line = { x: [], y: [] };
  for (const { values, y, pieces } of branches) {
    for (const piece of pieces) {
      if (piece.stable !== stable) continue;
      line.x.push(...values.slice(piece.first, piece.last + 1), null);
      line.y.push(...y.slice(piece.first, piece.last + 1), null);
    }
  }
  return line;
}

/**
 * @param {{branches: Branch[], turning: Point[], hopf: Point[], now: Point[], low: number, high: number, over: string, overUnit: string, of: string, ofUnit: string}} map
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function steadyMapPlot({ branches, turning, hopf, now, low, high, over, overUnit, of, ofUnit }, theme, held) {
  const [x, y] = [escapePlotly(over), escapePlotly(of)];
  const hover = `${y} = %{y:.5~g} ${escapePlotly(ofUnit)} at ${x} = %{x:.5~g} ${escapePlotly(overUnit)}`;
  /** @param {string} name @param {Point[]} points @param {object} marker @returns {Trace} */
  const marks = (name, points, marker) => ({ type: "scatter", mode: "markers", name, x: points.map(({ value }) => value), y: points.map((point) => point.y), marker: { size: 10, ...marker }, hovertemplate: `${name}: ${hover}<extra></extra>` });
  const traces = [
    { type: "scatter", mode: /** @type {const} */ ("lines"), name: "stable", ...piecesOf(branches, true), line: { color: theme.signal["y"], width: 2.5 }, hovertemplate: `stable: ${hover}<extra></extra>` },
    { type: "scatter", mode: /** @type {const} */ ("lines"), name: "unstable", ...piecesOf(branches, false), line: { color: theme.bad, width: 2, dash: "dash" }, hovertemplate: `unstable: ${hover}<extra></extra>` },
    marks("turning point", turning, { color: theme.ink, symbol: "diamond" }),
    marks("Hopf point", hopf, { color: theme.signal["d"], symbol: "star", size: 13 }),
    marks("as it is set", now, { color: theme.paper, symbol: "circle", line: { color: theme.ink, width: 2 } }),
  ];
  const ranges = { xaxis: /** @type {[number, number]} */ ([low, high]), yaxis: holdRange(held, "yaxis", ...extent(...branches.map((branch) => branch.y))) };
  const named = (/** @type {string} */ name, /** @type {string} */ unit) => escapePlotly(unit ? `${name} [${unit}]` : name);
  return { traces, ranges, layout: { ...baseLayout(theme), margin: { l: 66, r: 14, t: 8, b: 40 }, xaxis: axis(theme, named(over, overUnit), ranges.xaxis, { zeroline: false }), yaxis: axis(theme, named(of, ofUnit), ranges.yaxis, { zeroline: false }) } };
}
