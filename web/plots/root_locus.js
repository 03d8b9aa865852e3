/** Root locus: where the closed-loop poles go as the gain grows, and where they are now. */

/** @import {Complex, Figure, PolesPanel, Range, RootLocusPanel, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, holdRange } from "./axes.js";

/** What of a locus is in a window, as the server follows it at that scale. @typedef {Pick<RootLocusPanel, "branches" | "view">} CloseUp */

/**
 * @typedef {object} RootLocusInput
 * @property {RootLocusPanel | null} locus  null where there is none to draw
 * @property {RootLocusPanel | null} negative  the same for gains of the other sign, where it is wanted
 * @property {CloseUp | null} closeUp  in place of the locus where the student has zoomed in
 * @property {CloseUp | null} negativeCloseUp
 * @property {PolesPanel} poles
 */

/**
 * @param {RootLocusInput} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function rootLocusPlot({ locus, negative, closeUp, negativeCloseUp, poles }, theme, held) {
  const view = locus?.view ?? viewOf(poles.poles);
  const ranges = { xaxis: hold(held, "xaxis", view.re), yaxis: hold(held, "yaxis", view.im) };
  const far = 10 * Math.max(...[...ranges.xaxis, ...ranges.yaxis].map(Math.abs));
  const pole = theme.signal["pole"] ?? theme.ink;

  const traces = [
    asymptotes([locus, negative], far, theme),
    branches("locus for K < 0", negative, negativeCloseUp, { color: theme.signal["locus-negative"] ?? theme.muted, width: 1.75, dash: "dash" }, -1),
    branches("locus", locus, closeUp, { color: theme.signal["locus"] ?? theme.muted, width: 2 }, 1),
    marks("imaginary-axis crossing", [locus, negative], (one) => one.imaginary_axis_crossings.flatMap(({ omega, K }) => (omega === 0 ? [{ s: [0, 0], K }] : [{ s: [0, omega], K }, { s: [0, -omega], K }])), {
      symbol: "circle",
      size: 8,
      color: theme.paper,
      line: { color: theme.bad, width: 2 },
    }),
    marks("breakaway", [locus, negative], ({ breakaways }) => breakaways, { symbol: "diamond", size: 7, color: theme.paper, line: { color: theme.muted, width: 1.5 } }),
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

/**
 * All branches in one trace with gaps between them: their number may change without a new trace. In the window of a
 * close-up its own points stand for those of the whole.
 * @param {string} name
 * @param {RootLocusPanel | null} locus
 * @param {CloseUp | null} closeUp
 * @param {object} line
 * @param {1 | -1} sign  of the gain
 * @returns {Trace}
 */
function branches(name, locus, closeUp, line, sign) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  /** @type {(number | null)[]} */
  const gains = [];
  /** @param {number | null} re @param {number | null} im @param {number | null} gain */
  const add = (re, im, gain) => {
    x.push(re);
    y.push(im);
    gains.push(gain);
  };
  const within = closeUp ? inView(closeUp) : () => false;
  for (const { first, re, im } of locus?.branches ?? []) {
    for (let i = 0; i < re.length; i++) {
      const [a, b] = [re[i] ?? NaN, im[i] ?? NaN];
      if (within(a, b)) add(null, null, null);
      else add(a, b, sign * (locus?.gains?.[first + i] ?? NaN));
    }
    add(null, null, null);
  }
  for (const { re, im, gains: own } of closeUp?.branches ?? []) {
    for (let i = 0; i < re.length; i++) add(re[i] ?? null, im[i] ?? null, sign * (own?.[i] ?? NaN));
    add(null, null, null);
  }
  return { type: "scatter", mode: "lines", name, x, y, line, customdata: gains, hovertemplate: "Kc = %{customdata:.4~g}<br>s = %{x:.4~g} %{y:+.4~g} i<extra></extra>" };
}

/** @param {CloseUp} closeUp @returns {(re: number, im: number) => boolean} */
function inView({ view: { re, im } }) {
  return (a, b) => a > re[0] && a < re[1] && b > im[0] && b < im[1];
}

/** @param {(RootLocusPanel | null)[]} loci @param {number} far @param {Theme} theme @returns {Trace} */
function asymptotes(loci, far, theme) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  for (const locus of loci) {
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
  }
  return { type: "scatter", mode: "lines", name: "asymptotes", x, y, line: { color: theme.axis, width: 1.25, dash: "dash" }, hoverinfo: "skip" };
}

/**
 * Points of both loci that have a gain.
 * @param {string} name
 * @param {(RootLocusPanel | null)[]} loci  for positive gains, then for negative ones
 * @param {(locus: RootLocusPanel) => {s: Complex, K: number}[]} pick
 * @param {object} marker
 * @returns {Trace}
 */
function marks(name, loci, pick, marker) {
  const points = loci.flatMap((locus, i) => (locus ? pick(locus).map(({ s, K }) => ({ s, K: i === 0 ? K : -K })) : []));
  return { ...dots(name, points.map(({ s }) => s), marker), customdata: points.map(({ K }) => K), hovertemplate: `${name} at Kc = %{customdata:.4~g}<br>s = %{x:.4~g} %{y:+.4~g} i<extra></extra>` };
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
