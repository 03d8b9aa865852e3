/**
 * The closed Nyquist curve in a window of finite size. What lies farther out than the rim is drawn on it, in the
 * direction where it lies; so are the arcs at infinity that a pole on the imaginary axis makes. A turn about −1 is
 * thus a turn that can be seen, for −1 lies inside the rim.
 */

/** @import {IndentationArc, NyquistPanel, Theme, Trace} from "../core/types.js" */

/** Points an arc is drawn with, for each half turn. */
const PER_HALF_TURN = 48;
/** An arc that turns more than once widens by this share, so that it does not cover itself; and a second lies above the first. */
const SPIRAL = 0.09;
const LIFT = 0.05;

/** @typedef {{x: (number | null)[], y: (number | null)[]}} Path */

/**
 * An arc as it is drawn, clockwise from its start. For ω < 0 it is the mirror image, run through backwards.
 * @param {IndentationArc} arc
 * @param {number} radius
 * @param {1 | -1} side
 * @param {number} lift  how much above the rim, as a share of it; the ends are on it
 * @returns {{x: number[], y: number[]}}
 */
export function arcPoints({ start_deg, end_deg, turn_deg }, radius, side = 1, lift = 0) {
  const [from, to] = side > 0 ? [start_deg, end_deg] : [-end_deg, -start_deg];
  const count = Math.ceil((PER_HALF_TURN * turn_deg) / 180);
  const spiral = turn_deg > 360 ? SPIRAL : 0;
  /** @type {number[]} */
  const x = [];
  /** @type {number[]} */
  const y = [];
  /** @param {number} share @param {number} r */
  const add = (share, r) => {
    const angle = ((from + share * (to - from)) * Math.PI) / 180;
    x.push(r * Math.cos(angle));
    y.push(r * Math.sin(angle));
  };
  if (lift > 0) add(0, radius);
  for (let i = 0; i <= count; i++) add(i / count, radius * (1 + lift + (spiral * i) / count));
  if (lift + spiral > 0) add(1, radius);
  return { x, y };
}

/**
 * The curve cut at the rim: what lies inside, and what lies outside laid on the rim.
 * @param {NyquistPanel} nyquist
 * @param {number} radius  Infinity cuts nothing
 * @returns {{inside: Path, outside: Path}}
 */
export function cutAtRim({ omega, re, im, arcs }, radius) {
  /** @type {Path} */
  const inside = { x: [], y: [] };
  /** @type {Path} */
  const outside = { x: [], y: [] };
  /** @param {Path} path @param {number | null} x @param {number | null} y */
  const add = (path, x, y) => {
    path.x.push(x);
    path.y.push(y);
  };
  for (let i = 0; i < re.length; i++) {
    const [x, y] = [re[i] ?? 0, im[i] ?? 0];
    const size = Math.hypot(x, y);
    if (i > 0) {
      const [px, py] = [re[i - 1] ?? 0, im[i - 1] ?? 0];
      const before = Math.hypot(px, py);
      const passed = arcs.some((arc) => arc.omega > (omega[i - 1] ?? 0) && arc.omega < (omega[i] ?? 0));
      if (passed) {
        // Between these two the contour goes round a pole: the arc is drawn on its own.
        add(inside, null, null);
        add(outside, null, null);
      } else if (before <= radius !== size <= radius) {
        const share = crossing(px, py, x, y, radius);
        const [cx, cy] = [px + share * (x - px), py + share * (y - py)];
        if (before <= radius) {
          add(inside, cx, cy);
          add(inside, null, null);
          add(outside, cx, cy);
        } else {
          add(outside, cx, cy);
          add(outside, null, null);
          add(inside, cx, cy);
        }
      }
    }
    if (size <= radius) add(inside, x, y);
    else add(outside, (x * radius) / size, (y * radius) / size);
  }
  return { inside, outside };
}

/** Where a segment that crosses the circle of a radius does so, 0 to 1. @param {number} x0 @param {number} y0 @param {number} x1 @param {number} y1 @param {number} radius */
function crossing(x0, y0, x1, y1, radius) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const a = dx * dx + dy * dy;
  const b = x0 * dx + y0 * dy;
  const c = x0 * x0 + y0 * y0 - radius * radius;
  const root = Math.sqrt(Math.max(0, b * b - a * c));
  const inner = (-b + root) / a;
  return inner >= 0 && inner <= 1 ? inner : (-b - root) / a;
}

/**
 * The whole closed curve in the order in which the contour runs: ω from −∞ to 0, the arc at the origin, ω from 0 to
 * ∞, with the arcs at the poles on the way; what is outside the rim on it.
 * @param {NyquistPanel} nyquist
 * @param {number} radius
 * @returns {{x: number[], y: number[]}}
 */
export function closedCurve(nyquist, radius) {
  const { omega, re, im, arcs } = nyquist;
  /** @type {{x: number[], y: number[]}} */
  const half = { x: [], y: [] };
  const pending = arcs.filter((arc) => arc.omega > 0);
  for (let i = 0; i < re.length; i++) {
    while (pending[0] && pending[0].omega < (omega[i] ?? 0)) {
      const arc = arcPoints(/** @type {IndentationArc} */ (pending.shift()), radius);
      half.x.push(...arc.x);
      half.y.push(...arc.y);
    }
    const [x, y] = [re[i] ?? 0, im[i] ?? 0];
    const shrink = Math.min(1, radius / Math.max(Math.hypot(x, y), 1e-300));
    half.x.push(x * shrink);
    half.y.push(y * shrink);
  }
  const origin = arcs.find((arc) => arc.omega === 0);
  const arc = origin ? arcPoints(origin, radius) : { x: [], y: [] };
  return {
    x: [...half.x.toReversed(), ...arc.x, ...half.x],
    y: [...half.y.toReversed().map((value) => -value), ...arc.y, ...half.y],
  };
}

/**
 * Rim, arcs and the arrows on them; always the same traces.
 * @param {NyquistPanel} nyquist
 * @param {number} radius  Infinity where there is no rim
 * @param {Path} outside
 * @param {Theme} theme
 * @returns {Trace[]}
 */
export function rimTraces({ arcs }, radius, outside, theme) {
  const color = theme.signal["infinity"] ?? theme.ink;
  /** @type {Path} */
  const lines = { x: [], y: [] };
  /** @type {Path} */
  const arrows = { x: [], y: [] };
  /** @type {(string | null)[]} */
  const words = [];
  let lift = 0;
  for (const arc of Number.isFinite(radius) ? arcs : []) {
    for (const side of arc.omega === 0 ? /** @type {const} */ ([1]) : /** @type {const} */ ([1, -1])) {
      const { x, y } = arcPoints(arc, radius, side, lift);
      lift += LIFT;
      lines.x.push(...x, null);
      lines.y.push(...y, null);
      words.push(...x.map(() => arcInWords(arc, side)), null);
      for (let quarter = 90; quarter < arc.turn_deg; quarter += 180) arrowAt(arrows, x, y, Math.round(((x.length - 1) * quarter) / arc.turn_deg), 0.055 * radius);
    }
  }
  const mirrored = outside.y.map((value) => (value === null ? null : -value));
  return [
    { type: "scatter", mode: "lines", name: "beyond the rim", x: [...outside.x, null, ...outside.x], y: [...outside.y, null, ...mirrored], line: { color: theme.signal["L"] ?? theme.ink, width: 1.5, dash: "dot" }, hoverinfo: "skip" },
    { type: "scatter", mode: "lines", name: "at infinity", ...lines, line: { color, width: 2.25, dash: "longdash" }, text: words, hovertemplate: "%{text}<extra></extra>" },
    { type: "scatter", mode: "lines", name: "direction at infinity", ...arrows, line: { color, width: 2.25 }, hoverinfo: "skip" },
  ];
}

/** @param {IndentationArc} arc @param {1 | -1} side */
function arcInWords({ omega, multiplicity, turn_deg }, side) {
  const place = omega === 0 ? "the origin" : `${side > 0 ? "" : "−"}${Number(omega.toPrecision(4))}i`;
  return `at infinity: ${turn_deg}° clockwise<br>${multiplicity === 1 ? "pole" : `${multiplicity} poles`} at ${place}`;
}

/** A chevron at the i-th point, along the path. @param {Path} path @param {number[]} x @param {number[]} y @param {number} i @param {number} size */
function arrowAt(path, x, y, i, size) {
  const [dx, dy] = [(x[i + 1] ?? 0) - (x[i - 1] ?? 0), (y[i + 1] ?? 0) - (y[i - 1] ?? 0)];
  const length = Math.hypot(dx, dy) || 1;
  const [ux, uy] = [(dx / length) * size, (dy / length) * size];
  const [px, py] = [x[i] ?? 0, y[i] ?? 0];
  path.x.push(px - ux - 0.7 * uy, px + 0.6 * ux, px - ux + 0.7 * uy, null);
  path.y.push(py - uy + 0.7 * ux, py + 0.6 * uy, py - uy - 0.7 * ux, null);
}
