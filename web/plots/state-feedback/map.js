/** From where the feedback catches the plant: outcomes on a grid of starts, and the boundary of those caught. */

/** @import {Figure, Range, Theme, Trace} from "../../core/types.js" */

import { contourLines } from "../../core/contours.js";
import { axis, baseLayout } from "../axes.js";
import { escapePlotly } from "../escape.js";

/** @typedef {{label: string, unit: string, values: number[]}} MapSide  values as shown */
/** @typedef {{outcome: string, label: string, kind: "caught" | "lost" | "left" | "open"}} OutcomeLook */

const SYMBOLS = { caught: "circle", lost: "x-thin", left: "line-ew", open: "circle-open" };

/**
 * @param {{x: MapSide, y: MapSide, outcomes: (string | null)[][], looks: OutcomeLook[]}} input  outcomes: null where it is not known yet
 * @param {Theme} theme
 * @returns {Figure}
 */
export function feedbackMapPlot({ x, y, outcomes, looks }, theme) {
  const edge = (/** @type {number[]} */ values) => /** @type {Range} */ ([1.04 * (values[0] ?? -1), 1.04 * (values.at(-1) ?? 1)]);
  const ranges = { xaxis: edge(x.values), yaxis: edge(y.values) };
  const colours = { caught: theme.good, lost: theme.bad, left: theme.signal["u"] ?? theme.ink, open: theme.muted };
  const whole = outcomes.every((row) => row.every((outcome) => outcome !== null));
  const lines = whole ? contourLines(x.values, y.values, outcomes.map((row) => row.map((outcome) => (outcome === "caught" ? 1 : 0))), 0.5) : [];
  /** @type {Trace[]} */
  const traces = looks.map(({ outcome, label, kind }) => {
    const points = outcomes.flatMap((row, j) => row.flatMap((found, i) => (found === outcome ? [/** @type {[number, number]} */ ([x.values[i] ?? 0, y.values[j] ?? 0])] : [])));
    const name = escapePlotly(label);
    return {
      type: "scatter",
      mode: "markers",
      name,
      x: points.map(([at]) => at),
      y: points.map(([, at]) => at),
      marker: { symbol: SYMBOLS[kind], size: kind === "caught" ? 7 : 6, color: colours[kind], line: { color: colours[kind], width: 1.5 } },
      hovertemplate: `${name}<br>from %{x:.3~g} ${escapePlotly(x.unit)}, %{y:.3~g} ${escapePlotly(y.unit)}<extra></extra>`,
    };
  });
  const curve = lines.flatMap((line) => line.concat([[NaN, NaN]]));
  traces.push({ type: "scatter", mode: "lines", name: "boundary", x: curve.map(([at]) => at), y: curve.map(([, at]) => at), line: { color: theme.good, width: 2.5 }, hoverinfo: "skip" });
  const title = (/** @type {MapSide} */ { label, unit }) => escapePlotly(unit ? `${label} [${unit}]` : label);
  return {
    traces,
    ranges,
    layout: { ...baseLayout(theme), dragmode: false, xaxis: axis(theme, title(x), ranges.xaxis, { nticks: 9 }), yaxis: axis(theme, title(y), ranges.yaxis, { nticks: 7 }) },
  };
}
