/** The settings of a PI controller that make the loop stable, over gain and integral time, and the present one. */

/** @import {PiCut} from "../core/workbench/analysis-types.js" */
/** @import {Figure, Range, Theme} from "../core/types.js" */

import { axis, baseLayout } from "./axes.js";
import { escapePlotly } from "./escape.js";

/** How many decades are shown above and below the present gain. */
const DECADES = 1.5;

/**
 * Integral times to cut the region at: the same for all settings of about one size, so that they need not be asked for again.
 * @param {number} tau_I
 * @param {number} [count]
 */
export function cutsAround(tau_I, count = 36) {
  const low = Math.floor(Math.log10(tau_I) - 0.7);
  return Array.from({ length: count }, (_, k) => Number((10 ** (low + (3 * k) / (count - 1))).toPrecision(5)));
}

/**
 * The region as polygons: the k-th stable range from cut to cut, as long as there are as many.
 * @param {PiCut[]} cuts
 * @param {Range} gains  an open end is drawn up to these
 * @returns {{x: (number | null)[], y: (number | null)[]}}
 */
export function regionOutline(cuts, [least, most]) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  let from = 0;
  while (from < cuts.length) {
    const ranges = cuts[from]?.gain_ranges.length ?? 0;
    let to = from + 1;
    while (to < cuts.length && cuts[to]?.gain_ranges.length === ranges) to += 1;
    const run = cuts.slice(from, to);
    const inside = (/** @type {number | null | undefined} */ K, /** @type {number} */ open) => Math.min(most, Math.max(least, K ?? open));
    for (let k = 0; k < ranges; k++) {
      const right = run.map((cut) => inside(cut.gain_ranges[k]?.high, most));
      const left = run.map((cut) => inside(cut.gain_ranges[k]?.low, least)).toReversed();
      const heights = run.map(({ tau_I }) => tau_I);
      x.push(...right, ...left, right[0] ?? null, null);
      y.push(...heights, ...heights.toReversed(), heights[0] ?? null, null);
    }
    from = to;
  }
  return { x, y };
}

/**
 * @param {{cuts: PiCut[], Kc: number, tau_I: number, timeUnit: string}} input  Kc positive; the sign is the action's
 * @param {Theme} theme
 * @param {{ranges: import("../core/types.js").Ranges, moving: boolean}} held
 * @returns {Figure}
 */
export function piRegionPlot({ cuts, Kc, tau_I, timeUnit }, theme, held) {
  const middle = Math.round(Math.log10(Kc) * 2) / 2;
  const old = held.ranges["xaxis"];
  const kept = old && Math.log10(Kc) > old[0] + 0.2 && Math.log10(Kc) < old[1] - 0.2;
  const taus = cuts.map((cut) => Math.log10(cut.tau_I));
  const ranges = {
    xaxis: kept || (held.moving && old) ? old : /** @type {Range} */ ([middle - DECADES, middle + DECADES]),
    yaxis: /** @type {Range} */ ([taus[0] ?? -1, taus.at(-1) ?? 2]),
  };
  const gains = /** @type {Range} */ (ranges.xaxis.map((power) => 10 ** power));
  const { x, y } = regionOutline(cuts, gains);
  return {
    traces: [
      {
        type: "scatter",
        mode: "lines",
        name: "stable",
        x,
        y,
        line: { color: theme.good, width: 1.5 },
        fill: "toself",
        fillcolor: `${theme.good}2e`,
        hoverinfo: "skip",
      },
      {
        type: "scatter",
        mode: "markers",
        name: "present",
        x: [Kc],
        y: [tau_I],
        marker: { symbol: "square", size: 11, color: theme.signal["pole"], line: { color: theme.paper, width: 1.5 } },
        hovertemplate: "Kc = %{x:.4~g}, τI = %{y:.4~g}<extra></extra>",
      },
    ],
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, "gain Kc", ranges.xaxis, { type: "log", dtick: 1, zeroline: false }),
      yaxis: axis(theme, `integral time τI [${escapePlotly(timeUnit)}]`, ranges.yaxis, { type: "log", dtick: 1, zeroline: false }),
    },
  };
}
