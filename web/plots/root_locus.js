/** Root locus: where the closed-loop poles go as the gain grows, and where they are now. */

/** @import {Complex, Figure, PolesPanel, Range, RootLocusPanel, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, holdRange } from "./axes.js";

/**
 * @typedef {object} RootLocusInput
 * @property {RootLocusPanel | null} locus  null where there is none to draw
 * @property {PolesPanel} poles
 */

/**
 * @param {RootLocusInput} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function rootLocusPlot({ locus, poles }, theme, held) {
  const view = locus?.view ?? viewOf(poles.poles);
  const ranges = { xaxis: hold(held, "xaxis", view.re), yaxis: hold(held, "yaxis", view.im) };
  const far = 10 * Math.max(...[...ranges.xaxis, ...ranges.yaxis].map(Math.abs));
  const pole = theme.signal["pole"] ?? theme.ink;

  const traces = [
    asymptotes(locus, far, theme),
    branches(locus, theme),
    dots("imaginary-axis crossings", (locus?.imaginary_axis_crossings ?? []).flatMap(({ omega }) => /** @type {Complex[]} */ ([[0, omega], [0, -omega]])), {
      symbol: "circle",
      size: 8,
      color: theme.paper,
      line: { color: theme.bad, width: 2 },
    }),
    dots("breakaways", (locus?.breakaways ?? []).map(({ s }) => s), { symbol: "diamond", size: 7, color: theme.paper, line: { color: theme.muted, width: 1.5 } }),
    dots("open-loop zeros", locus?.open_loop_zeros ?? [], { symbol: "circle-open", size: 11, color: theme.ink, line: { color: theme.ink, width: 2 } }),
    dots("open-loop poles", locus?.open_loop_poles ?? [], { symbol: "x-thin", size: 10, line: { color: theme.ink, width: 2.25 } }),
    dots("closed-loop poles", poles.poles, { symbol: "square", size: 10, color: pole, line: { color: theme.paper, width: 1.5 } }),
  ];
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, "Re s", ranges.xaxis, { zerolinewidth: 1.5, zerolinecolor: theme.muted }),
      yaxis: axis(theme, "Im s", ranges.yaxis),
      // The half plane of instability never moves, so it may be a shape.
      shapes: [
        { type: "rect", layer: "below", xref: "x", yref: "paper", x0: 0, x1: far, y0: 0, y1: 1, fillcolor: theme.bad, opacity: 0.06, line: { width: 0 } },
      ],
    },
  };
}

/** The server's window is the natural one: taken as it is, unless the one held still shows all of it. @param {Held} held @param {string} name @param {Range} wanted */
function hold(held, name, wanted) {
  const old = held.ranges[name];
  if (!old) return wanted;
  const kept = holdRange(held, name, wanted[0], wanted[1]);
  return kept === old ? old : wanted;
}

/** @param {Complex[]} poles @returns {{re: Range, im: Range}} */
function viewOf(poles) {
  // Without a locus the slowest poles tell the story; those that dead time adds lie far out.
  const sizes = poles.map(([re, im]) => Math.hypot(re, im)).toSorted((a, b) => a - b);
  const reach = 1.3 * (sizes[Math.min(3, sizes.length - 1)] ?? 1);
  return { re: [-reach, reach / 3], im: [-reach, reach] };
}

/** All branches in one trace with gaps between them: their number may change without a new trace. @param {RootLocusPanel | null} locus @param {Theme} theme @returns {Trace} */
function branches(locus, theme) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  /** @type {(number | null)[]} */
  const gains = [];
  for (const { first, re, im } of locus?.branches ?? []) {
    x.push(...re, null);
    y.push(...im, null);
    gains.push(...(locus?.gains ?? []).slice(first, first + re.length), null);
  }
  return {
    type: "scatter",
    mode: "lines",
    name: "locus",
    x,
    y,
    line: { color: theme.signal["locus"] ?? theme.muted, width: 2 },
    ...{ customdata: gains },
    hovertemplate: "Kc = %{customdata:.4~g}<br>s = %{x:.4~g} %{y:+.4~g} i<extra></extra>",
  };
}

/** @param {RootLocusPanel | null} locus @param {number} far @param {Theme} theme @returns {Trace} */
function asymptotes(locus, far, theme) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  const centre = locus?.asymptotes?.centroid;
  if (centre !== null && centre !== undefined) {
    for (const degrees of locus?.asymptotes?.angles_deg ?? []) {
      const angle = (degrees * Math.PI) / 180;
      x.push(centre, centre + far * Math.cos(angle), null);
      y.push(0, far * Math.sin(angle), null);
    }
  }
  for (const level of locus?.asymptotes?.horizontal ?? []) {
    x.push(0, far, null);
    y.push(level, level, null);
  }
  return { type: "scatter", mode: "lines", name: "asymptotes", x, y, line: { color: theme.axis, width: 1.25, dash: "dash" }, hoverinfo: "skip" };
}

/** @param {string} name @param {Complex[]} points @param {object} marker @returns {Trace} */
function dots(name, points, marker) {
  return {
    type: "scatter",
    mode: "markers",
    name,
    x: points.map(([re]) => re),
    y: points.map(([, im]) => im),
    marker,
    hovertemplate: `${name}<br>s = %{x:.4~g} %{y:+.4~g} i<extra></extra>`,
  };
}
