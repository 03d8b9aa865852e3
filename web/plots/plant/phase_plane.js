/** The phase plane of two states: directions, nullclines, trajectories and steady states. */

/** @import {Figure, Numbers, Range, Theme, Trace} from "../../core/types.js" */

import { axis, baseLayout } from "../axes.js";
import { escapePlotly } from "../escape.js";

/** @typedef {{name: string, unit: string, low: number, high: number}} PlaneAxis */
/** @typedef {{horizontal: Numbers, vertical: Numbers}} Line */
/**
 * @typedef {object} Plane
 * @property {PlaneAxis} horizontal
 * @property {PlaneAxis} vertical
 * @property {{horizontal: Numbers, vertical: Numbers, d_horizontal: (number | null)[][], d_vertical: (number | null)[][]}} field
 * @property {{state: string, lines: Line[]}[]} nullclines
 * @property {Line[]} trajectories
 * @property {{x: Record<string, number>, verdict: string}[]} steady_states
 */

/** Length of a direction as part of the grid's spacing, and of its barbs as part of that. */
const LENGTH = 0.62;
const BARB = 0.3;

/**
 * Small arrows of one length on the screen: the direction of motion, not its speed.
 * @param {Plane} plane
 */
export function directions({ field, horizontal, vertical }) {
  /** @type {{x: (number | null)[], y: (number | null)[]}} */
  const line = { x: [], y: [] };
  const [sx, sy] = [horizontal.high - horizontal.low, vertical.high - vertical.low];
  const reach = LENGTH / Math.max(1, field.horizontal.length - 1);
  for (const [j, y] of Array.from(field.vertical).entries()) {
    for (const [i, x] of Array.from(field.horizontal).entries()) {
      const [dx, dy] = [field.d_horizontal[j]?.[i], field.d_vertical[j]?.[i]];
      if (dx === null || dx === undefined || dy === null || dy === undefined) continue;
      const size = Math.hypot(dx / sx, dy / sy);
      if (size === 0) continue;
      const [ax, ay] = [(dx / sx / size) * reach, (dy / sy / size) * reach];
      const tip = [ax / 2, ay / 2];
      const barb = (/** @type {number} */ side) => [(tip[0] ?? 0) - BARB * (ax + side * ay * 0.8), (tip[1] ?? 0) - BARB * (ay - side * ax * 0.8)];
      for (const [u = 0, v = 0] of [[-ax / 2, -ay / 2], tip, barb(1), tip, barb(-1)]) {
        line.x.push(x + u * sx);
        line.y.push(y + v * sy);
      }
      line.x.push(null);
      line.y.push(null);
    }
  }
  return line;
}

/** @param {Line[]} lines */
function joined(lines) {
  return { x: lines.flatMap(({ horizontal }) => [...Array.from(horizontal), null]), y: lines.flatMap(({ vertical }) => [...Array.from(vertical), null]) };
}

/** @param {Plane} plane @param {Theme} theme @returns {Figure} */
export function phasePlanePlot(plane, theme) {
  const { horizontal, vertical, nullclines, trajectories, steady_states: steady } = plane;
  const [x, y] = [escapePlotly(horizontal.name), escapePlotly(vertical.name)];
  /** @param {string} name @param {{x: (number | null)[], y: (number | null)[]}} data @param {object} line @returns {Trace} */
  const lines = (name, data, line) => ({ type: "scatter", mode: "lines", name, ...data, line, hoverinfo: "skip" });
  /** @param {string} verdict @param {object} marker @returns {Trace} */
  const points = (verdict, marker) => {
    const those = steady.filter((each) => (each.verdict === "stable") === (verdict === "stable"));
    return { type: "scatter", mode: "markers", name: verdict, x: those.map((each) => each.x[horizontal.name] ?? null), y: those.map((each) => each.x[vertical.name] ?? null), marker: { size: 11, ...marker }, hovertemplate: `${verdict} steady state: ${x} = %{x:.5~g}, ${y} = %{y:.5~g}<extra></extra>` };
  };
  const traces = [
    lines("directions", directions(plane), { color: theme.axis, width: 1 }),
    lines("first", joined(nullclines[0]?.lines ?? []), { color: theme.signal["y_m"], width: 2, dash: "dash" }),
    lines("second", joined(nullclines[1]?.lines ?? []), { color: theme.signal["d"], width: 2, dash: "dot" }),
    lines("trajectories", joined(trajectories), { color: theme.signal["y"], width: 2.25 }),
    points("stable", { color: theme.good }),
    points("unstable", { color: theme.paper, line: { color: theme.bad, width: 2.5 } }),
  ];
  /** @type {{xaxis: Range, yaxis: Range}} */
  const ranges = { xaxis: [horizontal.low, horizontal.high], yaxis: [vertical.low, vertical.high] };
  const named = (/** @type {PlaneAxis} */ { name, unit }) => escapePlotly(unit && unit !== "-" ? `${name} [${unit}]` : name);
  return { traces, ranges, layout: { ...baseLayout(theme), margin: { l: 66, r: 14, t: 8, b: 40 }, xaxis: axis(theme, named(horizontal), ranges.xaxis, { zeroline: false }), yaxis: axis(theme, named(vertical), ranges.yaxis, { zeroline: false }) } };
}
