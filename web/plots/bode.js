/** Bode plot of the open loop, with both margins drawn where they are read. */

/** @import {AsymptotesPanel, BodePanel, Figure, MarginsPanel, Numbers, Theme, Trace} from "../core/types.js" */
/** @import {Held} from "./axes.js" */

import { axis, baseLayout, extent, holdRange } from "./axes.js";
import { sketchTraces } from "./bode_sketch.js";
import { escapePlotly } from "./escape.js";
import { ghostLine, lineOf, NO_CURVE } from "./signals.js";

/** Magnitudes and phases beyond these say nothing about the loop and would squeeze what does. */
const LIMITS = { mag_dB: [-80, 80], phase_deg: [-450, 270] };

/** @typedef {"L" | "P" | "C"} BodeCurve */

/**
 * @typedef {object} BodeInput
 * @property {BodePanel} bode
 * @property {MarginsPanel | null} margins
 * @property {BodeCurve[]} curves
 * @property {AsymptotesPanel | null} sketch  straight lines of L, where they are wanted
 * @property {BodePanel[]} ghosts
 * @property {string} timeUnit
 */

/**
 * @param {BodeInput} input
 * @param {Theme} theme
 * @param {Held} held
 * @returns {Figure}
 */
export function bodePlot({ bode, margins, curves, sketch, ghosts, timeUnit }, theme, held) {
  const { omega } = bode;
  const unit = escapePlotly(timeUnit);

  /** @param {BodeCurve} curve @param {"mag_dB" | "phase_deg"} part @returns {Trace} */
  const line = (curve, part) => ({
    type: "scatter",
    mode: "lines",
    name: curve,
    x: omega,
    y: (bode[curve] ?? NO_CURVE)[part],
    yaxis: part === "mag_dB" ? "y" : "y2",
    line: lineOf(curve, theme),
    hovertemplate: `${curve}: ${part === "mag_dB" ? "%{y:.2f} dB" : "%{y:.1f}°"} at %{x:.4~g} rad/${unit}<extra></extra>`,
  });

  const traces = [
    ...ghosts.flatMap((ghost) => ghostTraces(ghost, theme)),
    reference(omega, 0, "y", theme),
    reference(omega, -180, "y2", theme),
    ...sketchTraces(sketch, theme, timeUnit),
    ...curves.flatMap((curve) => [line(curve, "mag_dB"), line(curve, "phase_deg")]),
    ...marginTraces(bode, margins, theme, unit),
  ];

  const shown = curves.map((curve) => bode[curve] ?? NO_CURVE);
  const mag = clip(extent(...shown.map((r) => r.mag_dB)), LIMITS.mag_dB);
  const phase = clip(extent(...shown.map((r) => r.phase_deg), sketch?.phase_deg ?? [], [-180]), LIMITS.phase_deg);
  const [first, last] = [Math.log10(omega[0] ?? 0.01), Math.log10(omega[omega.length - 1] ?? 100)];
  const ranges = {
    xaxis: held.moving && held.ranges["xaxis"] ? held.ranges["xaxis"] : /** @type {[number, number]} */ ([first, last]),
    yaxis: holdRange(held, "yaxis", mag[0], mag[1], 20),
    yaxis2: holdRange(held, "yaxis2", phase[0], phase[1], 45),
  };
  const phaseSpan = ranges.yaxis2[1] - ranges.yaxis2[0];
  const magSpan = ranges.yaxis[1] - ranges.yaxis[0];
  return {
    traces,
    ranges,
    layout: {
      ...baseLayout(theme),
      xaxis: axis(theme, `ω [rad/${unit}]`, ranges.xaxis, { type: "log", anchor: "y2", dtick: 1, zeroline: false }),
      yaxis: axis(theme, "|L| [dB]", ranges.yaxis, { domain: [0.54, 1], dtick: magSpan > 100 ? 40 : 20, zeroline: false }),
      yaxis2: axis(theme, "arg L [°]", ranges.yaxis2, { domain: [0, 0.46], dtick: phaseSpan > 270 ? 90 : phaseSpan > 90 ? 45 : 15, zeroline: false }),
    },
  };
}

/** @param {[number, number]} range @param {number[]} limits @returns {[number, number]} */
function clip([low, high], [min = low, max = high]) {
  return [Math.min(Math.max(low, min), max - 20), Math.max(Math.min(high, max), min + 20)];
}

/** @param {BodePanel} ghost @param {Theme} theme @returns {Trace[]} */
function ghostTraces(ghost, theme) {
  return /** @type {const} */ (["mag_dB", "phase_deg"]).map((part) => ({
    type: "scatter",
    mode: "lines",
    name: "kept L",
    x: ghost.omega,
    y: (ghost.L ?? NO_CURVE)[part],
    yaxis: part === "mag_dB" ? "y" : "y2",
    line: ghostLine(theme),
    hoverinfo: "skip",
  }));
}

/** @param {Numbers} omega @param {number} level @param {string} yaxis @param {Theme} theme @returns {Trace} */
function reference(omega, level, yaxis, theme) {
  return {
    type: "scatter",
    mode: "lines",
    name: "reference",
    // Far past both ends, so that it fills the axis however it is zoomed.
    x: [(omega[0] ?? 0.01) / 1e3, (omega[omega.length - 1] ?? 100) * 1e3],
    y: [level, level],
    yaxis,
    line: { color: theme.axis, width: 1.25, dash: "dash" },
    hoverinfo: "skip",
  };
}

/**
 * The gain margin as a stem from |L| up to 0 dB at ω180, the phase margin as a stem from −180° at ωc.
 * @param {BodePanel} bode
 * @param {MarginsPanel | null} margins
 * @param {Theme} theme
 * @param {string} unit
 * @returns {Trace[]}
 */
function marginTraces(bode, margins, theme, unit) {
  const gain = margins?.omega_180 != null && margins.GM_dB != null ? { omega: margins.omega_180, dB: -margins.GM_dB } : null;
  const phase = margins?.omega_c != null && margins.PM_deg != null ? { omega: margins.omega_c, deg: phaseAt(bode, margins.omega_c, margins.PM_deg) } : null;
  const turn = phase ? phase.deg - /** @type {number} */ (margins?.PM_deg) : -180;
  const color = theme.signal["margin"] ?? theme.ink;
  /** @param {string} name @param {number[]} x @param {number[]} y @param {string} yaxis @returns {Trace} */
  const stem = (name, x, y, yaxis) => ({ type: "scatter", mode: "lines", name, x, y, yaxis, line: { color, width: 3 }, hoverinfo: "skip" });
  /** @param {string} name @param {number | null} x @param {number | null} y @param {string} yaxis @param {string} text @returns {Trace} */
  const dot = (name, x, y, yaxis, text) => ({
    type: "scatter",
    mode: "markers",
    name,
    x: [x],
    y: [y],
    yaxis,
    marker: { symbol: "circle", size: 9, color: theme.paper, line: { color, width: 2 } },
    hovertemplate: `${text}<extra></extra>`,
  });
  return [
    stem("GM", gain ? [gain.omega, gain.omega] : [], gain ? [0, gain.dB] : [], "y"),
    stem("PM", phase ? [phase.omega, phase.omega] : [], phase ? [turn, phase.deg] : [], "y2"),
    dot("ω180", gain?.omega ?? null, gain?.dB ?? null, "y", `ω180 = %{x:.4~g} rad/${unit}, |L| = %{y:.2f} dB`),
    dot("ωc", phase?.omega ?? null, phase?.deg ?? null, "y2", `ωc = %{x:.4~g} rad/${unit}, arg L = %{y:.1f}°`),
    dot("ωc on 0 dB", phase?.omega ?? null, phase ? 0 : null, "y", `ωc = %{x:.4~g} rad/${unit}`),
    dot("ω180 on −180°", gain?.omega ?? null, gain ? phaseTurn(bode, gain.omega) : null, "y2", `ω180 = %{x:.4~g} rad/${unit}`),
  ];
}

/** The curve's phase at ω, on the turn where it is drawn. @param {BodePanel} bode @param {number} omega */
function curvePhase(bode, omega) {
  const { omega: grid } = bode;
  const { phase_deg } = bode.L ?? NO_CURVE;
  let i = 1;
  while (i < grid.length - 1 && /** @type {number} */ (grid[i]) < omega) i++;
  const [w0, w1] = [grid[i - 1] ?? 1, grid[i] ?? 1];
  const [p0, p1] = [phase_deg[i - 1] ?? 0, phase_deg[i] ?? 0];
  const share = w1 === w0 ? 0 : Math.log(omega / w0) / Math.log(w1 / w0);
  return p0 + Math.min(1, Math.max(0, share)) * (p1 - p0);
}

/** The margin is exact, the curve sampled: take the margin's value on the curve's turn. @param {BodePanel} bode @param {number} omega @param {number} PM_deg */
function phaseAt(bode, omega, PM_deg) {
  const exact = PM_deg - 180;
  return exact + 360 * Math.round((curvePhase(bode, omega) - exact) / 360);
}

/** @param {BodePanel} bode @param {number} omega */
function phaseTurn(bode, omega) {
  return phaseAt(bode, omega, 0);
}
