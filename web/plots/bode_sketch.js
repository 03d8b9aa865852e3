/** The straight lines of a Bode diagram, with a mark at each corner that says what it is. */

/** @import {AsymptotesPanel, Corner, Theme, Trace} from "../core/types.js" */

import { cornerInWords } from "../core/workbench/corners.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** Far past both ends of any axis [dB, deg]. */
const FAR = 1e4;

/**
 * Always the same traces, without points where there is no sketch.
 * @param {AsymptotesPanel | null} sketch
 * @param {Theme} theme
 * @param {string} timeUnit
 * @returns {Trace[]}
 */
export function sketchTraces(sketch, theme, timeUnit) {
  const line = lineOf("sketch", theme);
  const corners = sketch?.corners ?? [];
  return [
    guides(corners, "y", theme),
    guides(corners, "y2", theme),
    { type: "scatter", mode: "lines", name: "asymptotes of |L|", x: sketch?.omega ?? [], y: sketch?.mag_dB ?? [], yaxis: "y", line, hoverinfo: "skip" },
    { type: "scatter", mode: "lines", name: "asymptotes of arg L", x: sketch?.phase_omega ?? [], y: sketch?.phase_deg ?? [], yaxis: "y2", line, hoverinfo: "skip" },
    marks("pole", { symbol: "x-thin", size: 9, line: { color: line.color, width: 2.5 } }),
    marks("zero", { symbol: "circle", size: 9, color: theme.paper, line: { color: line.color, width: 2 } }),
  ];

  /** @param {"pole" | "zero"} kind @param {object} marker @returns {Trace} */
  function marks(kind, marker) {
    const shown = corners.filter((corner) => corner.kind === kind);
    return {
      type: "scatter",
      mode: "markers",
      name: `corners of ${kind}s`,
      x: shown.map(({ omega }) => omega),
      y: shown.map(({ omega }) => (sketch ? levelAt(sketch, omega) : null)),
      yaxis: "y",
      marker,
      text: shown.map((corner) => escapePlotly(cornerInWords(corner, timeUnit)).replace(": ", ":<br>").replace(", ", ",<br>")),
      hovertemplate: "%{text}<extra></extra>",
    };
  }
}

/** @param {Corner[]} corners @param {string} yaxis @param {Theme} theme @returns {Trace} */
function guides(corners, yaxis, theme) {
  return {
    type: "scatter",
    mode: "lines",
    name: "corner frequencies",
    x: corners.flatMap(({ omega }) => [omega, omega, null]),
    y: corners.flatMap(() => [-FAR, FAR, null]),
    yaxis,
    line: { color: theme.axis, width: 1, dash: "dot" },
    hoverinfo: "skip",
  };
}

/** The straight line of the magnitude at ω. @param {AsymptotesPanel} sketch @param {number} omega */
export function levelAt({ omega: grid, mag_dB }, omega) {
  return between(grid, mag_dB, omega);
}

/** The straight line of the phase at ω. @param {AsymptotesPanel} sketch @param {number} omega */
export function phaseLineAt({ phase_omega, phase_deg }, omega) {
  return between(phase_omega, phase_deg, omega);
}

/** @param {number[]} grid @param {number[]} values @param {number} omega @returns {number | null} null beyond the ends */
function between(grid, values, omega) {
  const last = grid.length - 1;
  if (!(omega >= (grid[0] ?? Infinity) && omega <= (grid[last] ?? 0))) return null;
  let i = 1;
  while (i < last && /** @type {number} */ (grid[i]) < omega) i++;
  const [w0, w1] = [grid[i - 1] ?? 1, grid[i] ?? 1];
  const [v0, v1] = [values[i - 1] ?? 0, values[i] ?? 0];
  return w1 === w0 ? v0 : v0 + ((v1 - v0) * Math.log(omega / w0)) / Math.log(w1 / w0);
}
