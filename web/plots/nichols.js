/** Nichols plot: the open loop's phase against its magnitude, over the grid of the closed loop. */

/** @import {BodePanel, Figure, MarginsPanel, Range, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { escapePlotly } from "./escape.js";
import { M_LEVELS_DB, mContour, N_LEVELS_DEG, nContour, onEveryTurn, openLoop, turnsOf } from "./nichols_grid.js";
import { ghostLine, lineOf, NO_CURVE } from "./signals.js";

/** What lies farther out says nothing about the loop and would squeeze what does. */
const LIMITS = { mag_dB: /** @type {Range} */ ([-40, 40]), phase_deg: /** @type {Range} */ ([-720, 180]) };
/** Below this [dB] dead time turns the phase on and on: such a point widens no axis. */
const FAINT_DB = -15;

/** The grid never changes: M and N contours on the turn from −360° to 0°. */
const M_CONTOURS = M_LEVELS_DB.map((level) => mContour(10 ** (level / 20)));
const N_CONTOURS = N_LEVELS_DEG.map(nContour);

/**
 * @typedef {object} NicholsInput
 * @property {BodePanel} bode
 * @property {MarginsPanel | null} margins
 * @property {BodePanel[]} ghosts
 * @property {string} timeUnit
 */

/**
 * @param {NicholsInput} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function nicholsPlot({ bode, margins, ghosts, timeUnit }, theme, held) {
  const { omega } = bode;
  const L = bode.L ?? NO_CURVE;
  const unit = escapePlotly(timeUnit);
  const seen = Array.from(L.phase_deg).filter((_, i) => inside(L.mag_dB[i], [FAINT_DB, LIMITS.mag_dB[1]]));
  const phases = clip(extent(seen, [-225, -89]), LIMITS.phase_deg);
  const levels = clip(extent(L.mag_dB, [-20, 20]), LIMITS.mag_dB);
  const ranges = { xaxis: holdRange(held, "xaxis", phases[0], phases[1], 45), yaxis: holdRange(held, "yaxis", levels[0], levels[1], 10) };

  /** @type {Trace[]} */
  const traces = [
    contours("N contours", onEveryTurn(N_CONTOURS, ranges.xaxis), theme),
    contours("M contours", onEveryTurn(M_CONTOURS, ranges.xaxis), theme),
    peakContour(margins, ranges.xaxis, theme),
    ...ghosts.map((ghost) => /** @type {Trace} */ ({ type: "scatter", mode: "lines", name: "kept L", x: ghost.L?.phase_deg ?? [], y: ghost.L?.mag_dB ?? [], line: ghostLine(theme), hoverinfo: "skip" })),
    {
      type: "scatter",
      mode: "lines",
      name: "L",
      x: L.phase_deg,
      y: L.mag_dB,
      line: lineOf("L", theme),
      customdata: omega,
      hovertemplate: `ω = %{customdata:.4~g} rad/${unit}<br>%{x:.1f}°, %{y:.2f} dB<extra></extra>`,
    },
    decades(bode, theme, unit),
    ...marginTraces(bode, margins, theme, unit),
    {
      type: "scatter",
      mode: "markers",
      name: "−1",
      x: turnsOf(ranges.xaxis).map((turn) => turn - 180),
      y: turnsOf(ranges.xaxis).map(() => 0),
      marker: { symbol: "cross-thin", size: 15, line: { color: theme.bad, width: 3 } },
      hovertemplate: "the point −1: %{x}°, 0 dB<extra></extra>",
    },
  ];
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, "arg L [°]", ranges.xaxis, { dtick: ranges.xaxis[1] - ranges.xaxis[0] > 405 ? 90 : 45, zeroline: false }),
      yaxis: axis(theme, "|L| [dB]", ranges.yaxis, { zerolinewidth: 1.25, zerolinecolor: theme.muted }),
      annotations: labels(ranges, theme),
    },
  };
}

/** @param {number | undefined} value @param {Range} limits */
function inside(value, [low, high]) {
  return value !== undefined && value >= low && value <= high;
}

/** @param {Range} range @param {Range} limits @returns {Range} */
function clip([low, high], [min, max]) {
  return [Math.max(low, min), Math.min(high, max)];
}

/** @param {string} name @param {{x: (number | null)[], y: (number | null)[]}} points @param {Theme} theme @returns {Trace} */
function contours(name, { x, y }, theme) {
  return { type: "scatter", mode: "lines", name, x, y, line: { color: theme.axis, width: 0.75, dash: name.startsWith("N") ? "dot" : "solid" }, hoverinfo: "skip" };
}

/** The contour of the peak of T, which the curve just touches. @param {MarginsPanel | null} margins @param {Range} phases @param {Theme} theme @returns {Trace} */
function peakContour(margins, phases, theme) {
  const Mt = margins?.Mt ?? null;
  const { x, y } = Mt === null ? { x: [], y: [] } : onEveryTurn([mContour(Mt)], phases);
  return { type: "scatter", mode: "lines", name: "|T| = Mt", x, y, line: { color: theme.signal["T"] ?? theme.ink, width: 1.75, dash: "dash" }, hoverinfo: "skip" };
}

/** A dot at every power of ten of ω. @param {BodePanel} bode @param {Theme} theme @param {string} unit @returns {Trace} */
function decades({ omega, L }, theme, unit) {
  const { mag_dB, phase_deg } = L ?? NO_CURVE;
  /** @type {number[]} */
  const at = [];
  /** @type {number[]} */
  const x = [];
  /** @type {number[]} */
  const y = [];
  for (let i = 1; i < phase_deg.length; i++) {
    const [w0, w1] = [omega[i - 1] ?? 0, omega[i] ?? 0];
    const decade = 10 ** Math.floor(Math.log10(w1) + 1e-9);
    if (!(w0 < decade * (1 - 1e-9) && decade <= w1 * (1 + 1e-9))) continue;
    const share = Math.log(decade / w0) / Math.log(w1 / w0);
    at.push(decade);
    x.push((phase_deg[i - 1] ?? 0) + share * ((phase_deg[i] ?? 0) - (phase_deg[i - 1] ?? 0)));
    y.push((mag_dB[i - 1] ?? 0) + share * ((mag_dB[i] ?? 0) - (mag_dB[i - 1] ?? 0)));
  }
  return { type: "scatter", mode: "markers", name: "decades of ω", x, y, customdata: at, marker: { symbol: "circle", size: 6, color: lineOf("L", theme).color }, hovertemplate: `ω = %{customdata:~g} rad/${unit}<extra></extra>` };
}

/**
 * Straight up from the curve to 0 dB at ω180, straight across to −180° at ωc, each on the turn where the curve is.
 * @param {BodePanel} bode
 * @param {MarginsPanel | null} margins
 * @param {Theme} theme
 * @param {string} unit
 * @returns {Trace[]}
 */
function marginTraces({ omega, L }, margins, theme, unit) {
  const color = theme.signal["margin"] ?? theme.ink;
  /** @param {number} w */
  const turn = (w) => {
    let i = 0;
    while (i < omega.length - 1 && /** @type {number} */ (omega[i]) < w) i++;
    return L?.phase_deg[i] ?? -180;
  };
  /** @param {number} angle @param {number} w */
  const near = (angle, w) => angle + 360 * Math.round((turn(w) - angle) / 360);
  const gain = margins?.omega_180 != null && margins.GM_dB != null ? { x: near(-180, margins.omega_180), y: -margins.GM_dB, omega: margins.omega_180 } : null;
  const phase = margins?.omega_c != null && margins.PM_deg != null ? { x: near(margins.PM_deg - 180, margins.omega_c), PM: margins.PM_deg, omega: margins.omega_c } : null;
  /** @param {string} name @param {number[]} x @param {number[]} y @returns {Trace} */
  const stem = (name, x, y) => ({ type: "scatter", mode: "lines", name, x, y, line: { color, width: 3 }, hoverinfo: "skip" });
  return [
    stem("GM", gain ? [gain.x, gain.x] : [], gain ? [gain.y, 0] : []),
    stem("PM", phase ? [phase.x, phase.x - phase.PM] : [], phase ? [0, 0] : []),
    {
      type: "scatter",
      mode: "markers",
      name: "margins",
      x: [gain?.x ?? null, phase?.x ?? null],
      y: [gain?.y ?? null, phase ? 0 : null],
      customdata: [gain?.omega ?? null, phase?.omega ?? null],
      marker: { symbol: "circle", size: 9, color: theme.paper, line: { color, width: 2 } },
      hovertemplate: `ω = %{customdata:.4~g} rad/${unit}<br>%{x:.1f}°, %{y:.2f} dB<extra></extra>`,
    },
  ];
}

/** The M contours' levels: those above 0 dB where they close over the point −1, the others at the right edge. @param {{xaxis: Range, yaxis: Range}} ranges @param {Theme} theme */
function labels({ xaxis, yaxis }, theme) {
  return M_LEVELS_DB.flatMap((level) => {
    const M = 10 ** (level / 20);
    const over = level > 0;
    // Above −1 at −180°; at the edge where T lags as much as L, near enough for a label.
    const y = over ? 20 * Math.log10(M / (M - 1)) : levelAtEdge(M, xaxis[1]);
    if (y === null || !inside(y, yaxis) || (over && !inside(-180, xaxis))) return [];
    return [
      {
        x: over ? -180 : xaxis[1],
        y,
        text: `${String(level).replace("-", "−")} dB`,
        showarrow: false,
        xanchor: over ? "center" : "right",
        yanchor: "middle",
        bgcolor: theme.paper,
        borderpad: 1,
        font: { size: theme.fontSize - 2, color: theme.muted },
      },
    ];
  });
}

/** Magnitude [dB] of L on |T| = M at a phase of L; null where the contour does not get there. @param {number} M @param {number} phase_deg */
function levelAtEdge(M, phase_deg) {
  const turned = phase_deg - 360 * Math.ceil(phase_deg / 360);
  // The phase of L falls with that of T along a contour of M < 1: halve the interval.
  let [low, high] = [-360 + 1e-6, -1e-6];
  if (M >= 1) return null;
  for (let i = 0; i < 50; i++) {
    const middle = 0.5 * (low + high);
    if (openLoop(M, middle)[0] < turned) low = middle;
    else high = middle;
  }
  return openLoop(M, low)[1];
}
