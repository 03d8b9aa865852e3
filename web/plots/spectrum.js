/** A signal and its samples above, the amplitude at each frequency below. */

/** @import {SpectrumAnswer} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Numbers, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** Upright lines from zero to each value. @param {Numbers} x @param {Numbers} y */
function stems(x, y) {
  return { x: Array.from(x).flatMap((at) => [at, at, null]), y: Array.from(y).flatMap((value) => [0, value, null]) };
}

/**
 * @param {{answer: SpectrumAnswer, signal: string, timeUnit: string}} input  the signal whose colour the samples have
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function spectrumPlot({ answer, signal, timeUnit }, theme, held) {
  const { t, values, frequency, amplitude, curves, lines, highest, expected } = answer;
  const unit = escapePlotly(timeUnit);
  const end = curves ? (curves.t[curves.t.length - 1] ?? 1) : (t[t.length - 1] ?? 1);
  const fastest = Math.max(highest, ...(lines ?? []).map((line) => line.frequency)) * 1.06;
  const tallest = Math.max(...amplitude, ...(lines ?? []).map((line) => line.amplitude)) * 1.08;
  const aliased = lines?.some((line) => line.aliased) ?? false;
  const [low, high] = extent(values, curves?.signal ?? []);
  const ranges = {
    xaxis: /** @type {Range} */ ([-0.02 * end, 1.02 * end]),
    xaxis2: /** @type {Range} */ ([-0.02 * fastest, fastest]),
    yaxis: holdRange(held, "yaxis", low, high),
    yaxis2: holdRange(held, "yaxis2", 0, tallest),
  };
  /** @param {string} name @param {Partial<Trace>} more @returns {Trace} */
  const trace = (name, more) => /** @type {Trace} */ ({ type: "scatter", mode: "lines", name, hoverinfo: "skip", ...more });
  const below = { xaxis: "x2", yaxis: "y2" };
  const colour = theme.signal[signal] ?? theme.ink;
  return {
    traces: [
      trace("signal", { line: lineOf("signal", theme), x: curves?.t ?? [], y: curves?.signal ?? [] }),
      trace("seen", { line: lineOf("seen", theme), x: aliased ? (curves?.t ?? []) : [], y: aliased ? (curves?.seen ?? []) : [] }),
      trace("samples", {
        mode: curves ? "markers" : "lines",
        x: t,
        y: values,
        line: { ...lineOf("samples", theme), color: colour },
        marker: { color: colour, size: 6 },
        hovertemplate: `%{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>`,
      }),
      trace("half_rate", { ...below, line: lineOf("half_rate", theme), x: [highest, highest], y: [0, 10 * tallest] }),
      trace("spectrum", { ...below, ...stems(frequency, amplitude), line: { ...lineOf("spectrum", theme), color: colour } }),
      // The mean is taken out of the signal, and with it what the noise has at 0.
      trace("expected", { ...below, x: expected ? frequency.slice(1) : [], y: expected?.slice(1) ?? [], line: lineOf("expected", theme) }),
      trace("bins", {
        ...below,
        mode: "markers",
        x: frequency,
        y: amplitude,
        marker: { color: colour, size: frequency.length > 100 ? 3 : 6 },
        hovertemplate: `%{y:.4~g} at %{x:.4~g} per ${unit}<extra></extra>`,
      }),
      trace("lines", {
        ...below,
        mode: "markers",
        x: (lines ?? []).map((line) => line.frequency),
        y: (lines ?? []).map((line) => line.amplitude),
        marker: { color: theme.signal["seen"], size: 12, symbol: "circle-open", line: { width: 2 } },
        hovertemplate: `the sine: %{y:.4~g} at %{x:.4~g} per ${unit}<extra></extra>`,
      }),
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { anchor: "y", zeroline: false, nticks: 9 }),
      yaxis: axis(theme, lines ? "signal" : signal, ranges.yaxis, { domain: [0.6, 1], nticks: 5 }),
      xaxis2: axis(theme, `frequency [1/${unit}]`, ranges.xaxis2, { anchor: "y2", zeroline: false, nticks: 9 }),
      yaxis2: axis(theme, "amplitude", ranges.yaxis2, { domain: [0, 0.42], nticks: 5 }),
    },
  };
}
