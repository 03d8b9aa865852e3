/** The limits of a loop's bandwidth, a row each, over the frequency axis of S and T. */

/** @import {LimitAnswer, LimitsAnswer} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Numbers, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { LIMIT_NAMES } from "../core/workbench/limits.js";
import { formatNumber } from "../core/format.js";
import { axis, baseLayout, holdRange } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

const FLOOR_DB = -40;
const CEILING_DB = 20;

/**
 * Whole decades around all that is marked, no wider than the marks ask for.
 * @param {(number | null)[]} marks
 * @param {Numbers} omega
 * @returns {Range}
 */
export function decadesAround(marks, omega) {
  const there = marks.filter((mark) => mark !== null && mark > 0).map((mark) => Math.log10(Number(mark)));
  if (there.length === 0) return [Math.log10(omega[0] ?? 0.01), Math.log10(omega[omega.length - 1] ?? 100)];
  return [Math.floor(Math.min(...there) - 0.5), Math.ceil(Math.max(...there) + 0.5)];
}

/** The best S up to its first summit: beyond it goes up and down without end. @param {Numbers} values */
function firstRise(values) {
  const summit = Array.from(values).findIndex((value, i) => i > 0 && value < Number(values[i - 1]));
  return summit === -1 ? values : values.slice(0, summit);
}

/**
 * @param {{answer: LimitsAnswer, timeUnit: string}} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function limitsPlot({ answer, timeUnit }, theme, held) {
  const { limits, window, omega_c, curves } = answer;
  const unit = escapePlotly(timeUnit);
  const order = Object.keys(LIMIT_NAMES);
  const rows = limits.filter(({ omega }) => omega !== null).toSorted((a, b) => order.indexOf(a.id) - order.indexOf(b.id));
  const xaxis = decadesAround([omega_c, ...rows.map(({ omega }) => omega)], curves.omega);
  const [from, to] = [10 ** xaxis[0], 10 ** xaxis[1]];
  // The first row is at the top, and what all leave above it.
  const heightOf = (/** @type {number} */ row) => rows.length - 1 - row;
  const top = rows.length;

  /** @param {(limit: LimitAnswer, edge: number) => [number, number]} ends */
  const bars = (ends) => ({
    x: rows.flatMap((limit) => [...ends(limit, Math.max(Number(limit.omega), from)), null]),
    y: rows.flatMap((_, row) => [heightOf(row), heightOf(row), null]),
  });
  const allowed = bars(({ side }, edge) => (side === "lower" ? [edge, to] : [from, edge]));
  const forbidden = bars(({ side }, edge) => (side === "lower" ? [from, edge] : [edge, to]));
  const left = window.open ? [Math.max(window.low ?? from, from), Math.min(window.high ?? to, to)] : [];
  const label = (/** @type {LimitAnswer} */ { side, omega, id }) => `${LIMIT_NAMES[id]}: ωc ${side === "lower" ? "above" : "below"} ${formatNumber(omega)} rad/${unit}`;

  /** @param {Partial<Trace>} trace @returns {Trace} */
  const upper = (trace) => /** @type {Trace} */ ({ type: "scatter", mode: "lines", hoverinfo: "skip", yaxis: "y", ...trace });
  const dB = (/** @type {Numbers} */ values) => Array.from(values, (value) => 20 * Math.log10(Math.max(value, 1e-12)));
  /** @param {"S" | "T" | "model_error" | "ideal_S"} name @param {Numbers} values @returns {Trace} */
  const curve = (name, values) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: curves.omega.slice(0, values.length),
    y: dB(values),
    yaxis: "y2",
    line: lineOf(name, theme),
    hovertemplate: `${name.replace("_", " ")}: %{y:.1f} dB at %{x:.4~g} rad/${unit}<extra></extra>`,
  });
  const sizes = dB(curves.S).concat(dB(curves.T)).filter((value) => value > FLOOR_DB);
  const ranges = {
    xaxis,
    yaxis: /** @type {Range} */ ([-0.7, top + 0.7]),
    yaxis2: holdRange(held, "yaxis2", FLOOR_DB, Math.min(CEILING_DB, Math.max(6, ...sizes)), 10),
  };
  const now = omega_c === null ? [] : [omega_c, omega_c];
  const nowLine = { color: theme.ink, dash: "dash", width: 1.5 };
  return {
    traces: [
      upper({ name: "forbidden", ...forbidden, line: { color: theme.bad, dash: "dot", width: 2.5 } }),
      upper({ name: "allowed", ...allowed, line: { color: `${theme.good}59`, width: 11 } }),
      upper({ name: "left", x: left, y: left.map(() => top), line: { color: theme.good, width: 13 } }),
      upper({
        name: "edges",
        mode: "markers",
        x: rows.map(({ omega }) => omega),
        y: rows.map((_, row) => heightOf(row)),
        marker: { color: rows.map(({ binding }) => (binding ? theme.bad : theme.muted)), size: rows.map(({ binding }) => (binding ? 11 : 7)), symbol: rows.map(({ binding }) => (binding ? "diamond" : "circle")) },
        text: rows.map(label),
        hoverinfo: "all",
        hovertemplate: "%{text}<extra></extra>",
      }),
      upper({ name: "now", x: now, y: now.map((_, i) => (i ? top + 0.7 : -0.7)), line: nowLine }),
      curve("ideal_S", firstRise(curves.ideal_S ?? [])),
      curve("model_error", Array.from(curves.model_error, (value) => 1 / Math.max(value, 1e-9))),
      curve("T", curves.T),
      curve("S", curves.S),
      upper({ name: "now below", x: now, y: now.map((_, i) => (i ? CEILING_DB * 2 : FLOOR_DB * 2)), yaxis: "y2", line: nowLine }),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      margin: { l: 98, r: 14, t: 10, b: 40 },
      xaxis: axis(theme, `ω [rad/${unit}]`, xaxis, { type: "log", dtick: 1, zeroline: false, anchor: "y2" }),
      yaxis: axis(theme, "", ranges.yaxis, {
        domain: [0.44, 1],
        zeroline: false,
        showgrid: false,
        tickmode: "array",
        ticks: "",
        tickvals: [top, ...rows.map((_, row) => heightOf(row))],
        ticktext: [window.open ? "<b>Left for ωc</b>" : "<b>Nothing left</b>", ...rows.map(({ id, binding }) => (binding ? `<b>${LIMIT_NAMES[id]}</b>` : LIMIT_NAMES[id]))],
      }),
      yaxis2: axis(theme, "magnitude [dB]", ranges.yaxis2, { domain: [0, 0.37], nticks: 5, zerolinewidth: 1.5, zerolinecolor: theme.muted }),
    },
  };
}
