/** The plane of Kc and tau_I of a PI controller: limit of stability, contours of Ms and of the error, rules, optimum. */

/** @import {GainMapAnswer, Optimum, TradeOffPoint} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Range, Theme, Trace} from "../core/types.js" */

import { contourLines } from "../core/contours.js";
import { formatNumber } from "../core/format.js";
import { formatShort } from "../core/roots.js";
import { axis, baseLayout } from "./axes.js";
import { escapePlotly } from "./escape.js";

const MS_LEVELS = [1.2, 1.4, 1.6, 2, 3];
/** Error over the smallest on the map. */
const ERROR_LEVELS = [1.25, 2, 4];
/** Closer than this, in parts of the axes, marks share one label. */
const CLOSE = 0.045;

/** @typedef {{number: number, label: string, Kc: number, tau_I: number}} Mark */

/** @param {GainMapAnswer} map */
export function mapRanges({ Kc, tau_I }) {
  const ends = (/** @type {number[]} */ values) => /** @type {Range} */ ([Math.log10(Math.abs(values[0] ?? 1)), Math.log10(Math.abs(values.at(-1) ?? 10))]);
  return { xaxis: ends(Kc), yaxis: ends(tau_I) };
}

/** The smallest error on the map, if there is a stable setting. @param {GainMapAnswer} map */
export function smallestError({ value }) {
  const found = value.flat().filter((v) => v !== null);
  return found.length > 0 ? Math.min(...found) : null;
}

/**
 * Contours through reciprocals: where the loop is unstable both Ms and the error are beyond all bounds, and their
 * reciprocals go to zero there without a jump. An error that is not known, of a loop that has not settled, ends a line.
 * @param {GainMapAnswer} map
 * @param {(number | null)[][]} values
 * @param {number[]} levels
 */
function contours({ Kc, tau_I, Ms }, values, levels) {
  const x = Kc.map((K) => Math.log10(Math.abs(K)));
  const y = tau_I.map((tau) => Math.log10(tau));
  const z = values.map((row, j) => row.map((v, i) => (v !== null ? 1 / v : Ms[j]?.[i] === null ? 0 : NaN)));
  return levels.map((level) => ({ level, lines: contourLines(x, y, z, 1 / level) }));
}

/** 1, 2, 5, 10 ... between the ends of a logarithmic axis: Plotly's own ticks are of two sizes. @param {Range} range */
function ticks([low, high]) {
  const values = [];
  for (let power = Math.floor(low); power <= high; power++) for (const lead of [1, 2, 5]) values.push(Number((lead * 10 ** power).toPrecision(3)));
  return { tickmode: "array", tickvals: values, ticktext: values.map((value) => formatShort(value)) };
}

/** Marks that lie together, each with the numbers of all. @param {Mark[]} marks @param {Record<string, Range>} ranges */
function clusters(marks, ranges) {
  /** @type {{x: number, y: number, numbers: number[]}[]} */
  const found = [];
  const width = (/** @type {string} */ name) => (ranges[name]?.[1] ?? 1) - (ranges[name]?.[0] ?? 0);
  for (const { number, Kc, tau_I } of marks) {
    const [x, y] = [Math.log10(Kc), Math.log10(tau_I)];
    const near = found.find((other) => Math.abs(other.x - x) < CLOSE * width("xaxis") && Math.abs(other.y - y) < CLOSE * width("yaxis"));
    if (near) near.numbers.push(number);
    else found.push({ x, y, numbers: [number] });
  }
  return found;
}

/** Without the scraps beside cells of unknown error. @param {import("../core/contours.js").Point[][]} lines */
function asCurve(lines) {
  /** @type {[number | null, number | null][]} */
  const points = [];
  for (const line of lines) {
    if (line.length <= 3) continue;
    for (const [x, y] of line) points.push([10 ** x, 10 ** y]);
    points.push([null, null]);
  }
  return { x: points.map(([x]) => x), y: points.map(([, y]) => y) };
}

/**
 * @param {{map: GainMapAnswer, marks: Mark[], tradeOff: TradeOffPoint[], optimum: Optimum | null, timeUnit: string}} input
 * @param {Theme} theme
 * @returns {Figure}
 */
export function gainMapPlot({ map, marks, tradeOff, optimum, timeUnit }, theme) {
  const unit = escapePlotly(timeUnit);
  const ranges = mapRanges(map);
  const least = smallestError(map);
  const colour = (/** @type {string} */ name) => theme.signal[name] ?? theme.ink;
  const best = tradeOff.flatMap(({ optimum: found, Ms_limit }) => (found?.controller.tau_I ? [{ Ms_limit, Kc: Math.abs(found.controller.Kc), tau_I: found.controller.tau_I, value: found.value }] : []));
  /** @type {object[]} */
  const annotations = [];

  /**
   * Lines of some levels, labelled each where it comes nearest to a side of the map: Ms to the upper one, errors to the left.
   * @param {string} name @param {string} shade @param {string} dash @param {ReturnType<typeof contours>} levels @param {"top" | "left"} side @returns {Trace}
   */
  const family = (name, shade, dash, levels, side) => {
    const [axisOf, index] = side === "top" ? /** @type {const} */ ([ranges.yaxis, 1]) : /** @type {const} */ ([ranges.xaxis, 0]);
    const aim = axisOf[0] + (side === "top" ? 0.94 : 0.06) * (axisOf[1] - axisOf[0]);
    for (const { level, lines } of levels) {
      const [at] = lines.flat().toSorted((a, b) => Math.abs(a[index] - aim) - Math.abs(b[index] - aim));
      if (at) annotations.push({ x: at[0], y: at[1], text: formatNumber(level), showarrow: false, font: { size: theme.fontSize - 1, color: shade }, bgcolor: theme.paper, borderpad: 1 });
    }
    return { type: "scatter", mode: "lines", name, ...asCurve(levels.flatMap(({ lines }) => lines)), line: { color: shade, width: 1.25, dash }, hoverinfo: "skip" };
  };

  /** @type {Trace[]} */
  const traces = [
    family("Ms", colour("contour"), "dash", contours(map, map.Ms, MS_LEVELS), "top"),
    family("IAE", colour("y"), "solid", least === null ? [] : contours(map, map.value, ERROR_LEVELS.map((times) => times * least)), "left"),
    {
      type: "scatter",
      mode: "lines",
      name: "limit",
      x: map.boundary.Kc.map((K) => (K === null ? null : Math.abs(K))),
      y: map.boundary.tau_I,
      line: { color: theme.bad, width: 3 },
      hovertemplate: "limit of stability: Kc = %{x:.4~g}, τI = %{y:.4~g}<extra></extra>",
    },
    {
      type: "scatter",
      mode: "lines+markers",
      name: "trade-off",
      x: best.map(({ Kc }) => Kc),
      y: best.map(({ tau_I }) => tau_I),
      text: best.map(({ Ms_limit, value }) => `Ms ≤ ${Ms_limit}: IAE ${formatShort(value)}`),
      line: { color: colour("optimal"), width: 2 },
      marker: { size: 6, color: colour("optimal") },
      hovertemplate: "%{text}, Kc = %{x:.4~g}, τI = %{y:.4~g}<extra></extra>",
    },
    {
      type: "scatter",
      mode: "markers",
      name: "rules",
      x: marks.map(({ Kc }) => Kc),
      y: marks.map(({ tau_I }) => tau_I),
      text: marks.map(({ number, label }) => `${number} ${escapePlotly(label)}`),
      marker: { symbol: "circle", size: 8, color: colour("rule"), line: { color: theme.paper, width: 1 } },
      hovertemplate: "%{text}: Kc = %{x:.4~g}, τI = %{y:.4~g}<extra></extra>",
    },
    {
      type: "scatter",
      mode: "markers",
      name: "optimal",
      x: optimum?.controller.tau_I ? [Math.abs(optimum.controller.Kc)] : [],
      y: optimum?.controller.tau_I ? [optimum.controller.tau_I] : [],
      marker: { symbol: "star", size: 15, color: colour("optimal"), line: { color: theme.paper, width: 1.5 } },
      hovertemplate: "best: Kc = %{x:.4~g}, τI = %{y:.4~g}<extra></extra>",
    },
  ];
  for (const { x, y, numbers } of clusters(marks, ranges)) {
    annotations.push({ x, y, text: numbers.join(", "), showarrow: false, xanchor: "left", xshift: 4, yshift: 8, font: { size: theme.fontSize - 1, color: colour("rule") } });
  }
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      annotations,
      xaxis: axis(theme, (map.Kc[0] ?? 1) < 0 ? "gain −Kc (direct action)" : "gain Kc", ranges.xaxis, { type: "log", zeroline: false, ...ticks(ranges.xaxis) }),
      yaxis: axis(theme, `integral time τI [${unit}]`, ranges.yaxis, { type: "log", zeroline: false, ...ticks(ranges.yaxis) }),
    },
  };
}
