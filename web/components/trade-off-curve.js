/** The price of robustness as a small picture: the least error for each Ms, and where the present loop is. */

import { formatNumber, toInput } from "../core/format.js";
import { clamp, createScale } from "../core/scale.js";
import { svg } from "./dom.js";

const SIZE = { width: 300, height: 132 };
const FRAME = { left: 40, right: 292, top: 8, bottom: 104 };
const MS_TICKS = [1.2, 1.6, 2, 2.4];
const STEPS = [1, 2, 5];

/** @typedef {{Ms: number, value: number}} CurvePoint */

/** Round numbers on a logarithmic axis. @param {number} low @param {number} high */
function roundNumbers(low, high) {
  const ticks = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); decade += 1) {
    for (const step of STEPS) {
      const value = step * 10 ** decade;
      if (value >= low && value <= high) ticks.push(value);
    }
  }
  const every = Math.ceil(ticks.length / 4);
  return ticks.filter((_, k) => k % every === 0);
}

/**
 * @param {CurvePoint[]} curve  at least two, in increasing order of Ms
 * @param {CurvePoint | null} now  drawn on the edge where it is beyond the curve's range
 * @returns {SVGElement}
 */
export function tradeOffCurve(curve, now) {
  const values = curve.map(({ value }) => value);
  const x = createScale({ min: curve[0]?.Ms ?? 1, max: curve.at(-1)?.Ms ?? 2, log: false });
  const y = createScale({ min: 0.8 * Math.min(...values), max: 1.6 * Math.max(...values), log: true });
  const across = (/** @type {number} */ Ms) => FRAME.left + x.toPosition(Ms) * (FRAME.right - FRAME.left);
  const up = (/** @type {number} */ value) => FRAME.bottom - y.toPosition(value) * (FRAME.bottom - FRAME.top);
  const place = (/** @type {CurvePoint} */ { Ms, value }) => `${across(Ms).toFixed(1)},${up(value).toFixed(1)}`;
  const beyond = now !== null && (clamp(now.Ms, x.min, x.max) !== now.Ms || clamp(now.value, y.min, y.max) !== now.value);
  const words = `Least IAE against the sensitivity peak Ms: from ${formatNumber(values[0])} at Ms ${formatNumber(x.min)} to ${formatNumber(values.at(-1))} at ${formatNumber(x.max)}.`;
  return svg(
    "svg",
    { class: "trade-off-curve", viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, role: "img", "aria-label": words },
    svg("path", { class: "trade-off-axes", d: `M${FRAME.left},${FRAME.top}V${FRAME.bottom}H${FRAME.right}` }),
    ...MS_TICKS.filter((Ms) => Ms >= x.min && Ms <= x.max).map((Ms) => svg("text", { x: across(Ms), y: FRAME.bottom + 14, "text-anchor": "middle" }, String(Ms))),
    ...roundNumbers(y.min, y.max).map((value) => svg("text", { x: FRAME.left - 5, y: up(value) + 4, "text-anchor": "end" }, toInput(value))),
    svg("text", { class: "trade-off-name", x: FRAME.left + 5, y: FRAME.top + 9 }, "IAE"),
    svg("text", { class: "trade-off-name", x: FRAME.right, y: SIZE.height - 2, "text-anchor": "end" }, "Ms"),
    svg("polyline", { class: "trade-off-best", points: curve.map(place).join(" ") }),
    now && svg("rect", { class: beyond ? "trade-off-now beyond" : "trade-off-now", x: across(now.Ms) - 4.5, y: up(now.value) - 4.5, width: 9, height: 9 }),
  );
}
