/** The structure of a Smith predictor: the model runs ahead of the plant, and what it missed comes back as well. */

import { svg } from "./dom.js";

const ARROW = "smith-arrow";

export function smithDiagram() {
  const wire = (/** @type {string} */ d, signal = "e") => svg("path", { d, class: `wire wire-${signal}`, "marker-end": `url(#${ARROW})` });
  const line = (/** @type {string} */ d, signal = "e") => svg("path", { d, class: `wire wire-${signal}` });
  const sum = (/** @type {number} */ x, /** @type {number} */ y) => svg("circle", { cx: x, cy: y, r: 8, class: "sum" });
  const node = (/** @type {number} */ x, /** @type {number} */ y, kind = "") => svg("circle", { cx: x, cy: y, r: 2.75, class: `node ${kind}` });
  const text = (/** @type {number} */ x, /** @type {number} */ y, /** @type {string} */ words, kind = "") => svg("text", { x, y, class: kind }, words);
  const block = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ width, /** @type {string} */ words) =>
    svg("g", { class: "smith-block" }, svg("rect", { x, y: y - 17, width, height: 34, rx: 5 }), text(x + width / 2, y + 5, words, "smith-symbol"));
  const words =
    "Block diagram of the Smith predictor. The controller's output u goes to the plant P and to the model. The model without its dead time, G0, is fed back at once. The model with its dead time is compared with y, and the difference is fed back as well.";
  return svg(
    "svg",
    { viewBox: "0 0 400 196", class: "loop-diagram smith-diagram", role: "img", "aria-label": words },
    svg("defs", {}, svg("marker", { id: ARROW, viewBox: "0 0 10 10", refX: 9, refY: 5, markerWidth: 7, markerHeight: 7, orient: "auto-start-reverse" }, svg("path", { d: "M0 1 10 5 0 9z", class: "arrow-head" }))),
    svg("rect", { x: 138, y: 84, width: 206, height: 74, rx: 8, class: "smith-model" }),
    text(146, 152, "predictor", "smith-note"),
    wire("M12 44H31", "r"),
    wire("M47 44H65"),
    wire("M81 44H94"),
    block(94, 44, 44, "C"),
    wire("M138 44H197", "u"),
    wire("M205 12V36", "d"),
    wire("M213 44H230", "u"),
    block(230, 44, 60, "P"),
    wire("M290 44H388", "y"),
    // into the model
    line("M158 44V110", "u"),
    wire("M158 110H174", "u"),
    block(174, 110, 42, "G₀"),
    wire("M216 110H244"),
    block(244, 110, 52, "e⁻ᶿˢ"),
    wire("M296 110H355"),
    wire("M363 44V102", "y"),
    // back: at once, and what the model missed
    line("M228 110V170H73"),
    wire("M73 170V52"),
    line("M363 118V186H39", "d"),
    wire("M39 186V52", "d"),
    sum(39, 44),
    sum(73, 44),
    sum(205, 44),
    sum(363, 110),
    node(158, 44, "node-u"),
    node(228, 110, "node-e"),
    node(363, 44),
    text(4, 38, "r"),
    text(211, 14, "d"),
    text(150, 36, "u"),
    text(382, 36, "y"),
    text(28, 64, "−"),
    text(62, 64, "−"),
    text(345, 104, "−"),
    text(250, 182, "missed", "smith-note"),
  );
}
