/** The answer of a system to any input: y above with what it is the sum of, u below, on one time axis. */

/** @import {ResponseAnswer} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Numbers, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange, runawayExtent } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { lineOf } from "./signals.js";

/** More terms than this are a grey surface. */
const MOST_TERMS = 60;

/**
 * One impulse of the input and what it gives: h, later by `at` and as large as the slice is.
 * @param {Numbers} t  evenly spaced
 * @param {Numbers} h
 * @param {number} at
 * @param {number} weight
 * @returns {number[]}
 */
export function shiftedImpulse(t, h, at, weight) {
  const step = (t[1] ?? 1) - (t[0] ?? 0);
  return Array.from(h, (_, i) => {
    const place = i - at / step;
    if (place < 0) return 0;
    const low = Math.floor(place);
    const [a, b] = [h[low] ?? 0, h[low + 1] ?? h[low] ?? 0];
    return weight * (a + (place - low) * (b - a));
  });
}

/**
 * The terms that the answer is the sum of, and the sum.
 * @param {ResponseAnswer} answer
 * @returns {{terms: Numbers[], total: Numbers | null}}
 */
export function termsOf({ t, superposition, convolution }) {
  if (superposition) {
    const free = superposition.free.some((value) => value !== 0) ? [superposition.free] : [];
    return { terms: [...free, ...superposition.terms.map(({ y }) => y)], total: superposition.total };
  }
  if (!convolution) return { terms: [], total: null };
  const { times, weights, h, total } = convolution;
  const used = Array.from(weights, (weight, k) => ({ weight, at: times[k] ?? 0 })).filter(({ weight }) => weight !== 0);
  return { terms: used.length > MOST_TERMS ? [] : used.map(({ weight, at }) => shiftedImpulse(t, h, at, weight)), total };
}

/**
 * @param {{answer: ResponseAnswer, staircase: boolean, timeUnit: string}} input  a staircase has upright steps
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function responsePlot({ answer, staircase, timeUnit }, theme, held) {
  const { t, u, horizon, truncated_at } = answer;
  const unit = escapePlotly(timeUnit);
  // A sum from rest stands beside the response from rest.
  const y = answer.convolution?.exact ?? answer.y;
  const { terms, total } = termsOf(answer);

  /** @param {string} name @param {Numbers} values @param {string} yaxis @param {Partial<Trace>} [more] @returns {Trace} */
  const line = (name, values, yaxis, more) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: t.slice(0, values.length),
    y: values,
    yaxis,
    line: lineOf(name, theme),
    hovertemplate: `${name} = %{y:.4~g} at %{x:.4~g} ${unit}<extra></extra>`,
    ...more,
  });

  const traces = [
    ...terms.map((values) => line("term", values, "y", { hoverinfo: "skip", hovertemplate: "" })),
    line("u", u, "y2", staircase ? { line: { ...lineOf("u", theme), shape: "hv" } } : {}),
    line("y", y, "y"),
    ...(total ? [line("sum", total, "y")] : []),
  ];
  const [yLow, yHigh] = extent(truncated_at === null ? y : runawayExtent(y, 0), [0], ...(truncated_at === null ? terms : []), total && truncated_at === null ? total : [0]);
  const [uLow, uHigh] = extent(u, [0]);
  const ranges = {
    xaxis: /** @type {[number, number]} */ ([0, horizon]),
    yaxis: holdRange(held, "yaxis", yLow, yHigh),
    yaxis2: holdRange(held, "yaxis2", uLow, uHigh),
  };
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `time [${unit}]`, ranges.xaxis, { anchor: "y2", zeroline: false, nticks: 9 }),
      yaxis: axis(theme, "y", ranges.yaxis, { domain: [0.38, 1] }),
      yaxis2: axis(theme, "u", ranges.yaxis2, { domain: [0, 0.3], nticks: 4 }),
    },
  };
}
