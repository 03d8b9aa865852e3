/** Plain marks: lines, boxes, discs, rulers, and words and numbers. */

/** @import {Scene, Shape} from "./scene.js" */

import { formatFixed, formatNumber, UNDEFINED } from "../../core/format.js";
import { set, svg } from "../dom.js";
import { arrowHead, boundsOf, roundedPath } from "./geometry.js";
import { nameSpans, splitName } from "./names.js";
import { ShapeError } from "./scene.js";

/** @type {Record<string, string>} */
const DASHES = { dashed: "6 4", dotted: "0.1 4.500" };

/** @param {Shape} shape @param {Scene} scene */
export function line(shape, scene) {
  const points = scene.points(shape);
  const width = scene.size(shape, "width", 1.75);
  const path = svg("path", {
    d: roundedPath(points, 0) + (shape["closed"] ? "Z" : ""),
    class: "line",
    "stroke-width": width,
    "stroke-dasharray": DASHES[shape["dash"]] ?? null,
  });
  const ends = shape["arrow"] ?? "none";
  const heads = [];
  const length = 8 + 1.5 * width;
  if (ends === "end" || ends === "both") heads.push(arrowHead(points[points.length - 2], points[points.length - 1], length));
  if (ends === "start" || ends === "both") heads.push(arrowHead(points[1], points[0], length));
  const tips = svg("path", { d: heads.join("") });
  scene.colour(shape, "stroke", "ink", (colour) => {
    path.style.stroke = colour;
    tips.style.fill = colour;
  });
  scene.colour(shape, "fill", "none", (colour) => (path.style.fill = colour));
  return { nodes: [path, tips], box: boundsOf(points) };
}

/** @param {Shape} shape @param {Scene} scene */
export function box(shape, scene) {
  const width = scene.size(shape, "width");
  const height = scene.size(shape, "height");
  const rect = svg("rect", { width, height, rx: shape["radius"] ?? 0, class: "outlined" });
  paint(rect, shape, scene);
  return { nodes: [rect], box: [0, 0, width, height] };
}

/** @param {Shape} shape @param {Scene} scene */
export function disc(shape, scene) {
  const circle = svg("circle", { class: "outlined" });
  let reach = 0;
  scene.number(shape, "r", 0, (r) => {
    reach = Math.max(0, r);
    circle.setAttribute("r", String(reach));
  });
  paint(circle, shape, scene);
  return { nodes: [circle], box: [-reach, -reach, 2 * reach, 2 * reach] };
}

/** @param {SVGElement} node @param {Shape} shape @param {Scene} scene */
function paint(node, shape, scene) {
  scene.colour(shape, "fill", "none", (colour) => (node.style.fill = colour));
  scene.colour(shape, "stroke", "ink", (colour) => (node.style.stroke = colour));
}

/** @param {Shape} shape @param {Scene} scene */
export function ruler(shape, scene) {
  const length = scene.size(shape, "length");
  const step = scene.size(shape, "step");
  const [low, high] = shape["range"] ?? [];
  if (!(low < high) || (high - low) / step > 50) throw new ShapeError("range", "must increase, with at most 50 steps");
  const marks = [];
  let d = `M0 0H${length}`;
  for (let i = 0; low + i * step <= high + 1e-9 * step; i += 1) {
    // 3 steps of 0.4 from -1.2 are 0, not 2e-16
    const value = Math.abs(low + i * step) < 1e-9 * step ? 0 : low + i * step;
    const x = (length * (value - low)) / (high - low);
    d += `M${x} 0v6`;
    marks.push(svg("text", { x, y: 9, class: "ruler-number" }, String(Number(value.toPrecision(6))).replace("-", "−")));
  }
  return { nodes: [svg("path", { d, class: "tick" }), ...marks], box: [0, 0, length, 24] };
}

/** @param {Shape} shape @param {Scene} scene */
export function text(shape, scene) {
  const words = shape["text"];
  if (typeof words !== "string") throw new ShapeError("text", "must be a text");
  const node = svg("text", { class: `words words-${shape["size"] ?? "m"}`, "text-anchor": shape["align"] ?? "start" }, words);
  scene.colour(shape, "fill", "ink", (colour) => (node.style.fill = colour));
  return { nodes: [node], box: [0, 0, 0, 0] };
}

/** Which a text's computed length leaves out, in em. */
const SPACE_BEFORE_VALUE = 0.45;
const SPACE_BEFORE_UNIT = 0.25;

/**
 * How far a chip must move sideways so that nothing of it is cut off, whatever the size of the text.
 * @param {SVGElement} node @param {number} left @param {number} right
 */
function intoView(node, left, right) {
  const picture = /** @type {SVGSVGElement | null} */ (node.ownerSVGElement);
  const outer = /** @type {SVGGraphicsElement | null} */ (/** @type {unknown} */ (node.parentNode));
  const [toScreen, ofView] = [outer?.getCTM(), picture?.getCTM()];
  if (!picture || !toScreen || !ofView) return 0;
  const place = ofView.inverse().multiply(toScreen);
  const { x, width } = picture.viewBox.baseVal;
  const [start, end] = [place.e + left, place.e + right];
  return Math.max(x + 2 - start, Math.min(0, x + width - 2 - end));
}

/** Name, value and unit on a chip that grows where it must and never shrinks: nothing jumps. @param {Shape} shape @param {Scene} scene */
export function readout(shape, scene) {
  const signal = shape["signal"];
  if (typeof signal !== "string") throw new ShapeError("signal", "must be the name of a signal");
  if (typeof (shape["name"] ?? signal) !== "string") throw new ShapeError("name", "must be a text");
  const { digits = 3, decimals, times = 1, align = "start" } = shape;
  const name = shape["name"] ?? signal;
  const { spans, dy } = nameSpans(name);
  const value = svg("tspan", { class: "readout-value", dx: `${SPACE_BEFORE_VALUE}em`, dy });
  const unit = svg("tspan", { class: "readout-unit", dx: `${SPACE_BEFORE_UNIT}em` });
  const bare = shape["bare"] === true;
  if (bare) set(value, { dx: null, dy: null });
  const words = svg("text", { class: "readout-text", "text-anchor": align }, ...(bare ? [] : spans), value, unit);
  const chip = svg("rect", { class: "chip" });
  const node = svg("g", { class: "readout" }, chip, words);

  let height = 14;
  let width = 0;
  // digits are all as wide: what has been measured once is known for every number of its form
  /** @type {Map<string, number>} */
  const measures = new Map();
  const fit = () => {
    const form = (value.textContent ?? "").replaceAll(/\d/g, "0");
    const measured = measures.get(form) ?? /** @type {SVGTextElement} */ (words).getComputedTextLength();
    if (!measured) return;
    measures.set(form, measured);
    const wanted = measured + ((bare ? 0 : SPACE_BEFORE_VALUE) + (unit.textContent ? SPACE_BEFORE_UNIT : 0)) * height;
    const pad = 0.5 * height;
    if (width >= wanted + 2 * pad) return;
    width = wanted + 2 * pad;
    const left = align === "start" ? 0 : align === "end" ? -width : -width / 2;
    const anchor = align === "start" ? pad : align === "end" ? -pad : 0;
    words.setAttribute("x", String(anchor));
    node.setAttribute("transform", `translate(${intoView(node, left, left + width)} 0)`);
    for (const [attribute, size] of Object.entries({ x: left, y: -0.85 * height, width, height: 1.7 * height, rx: 0.4 * height })) chip.setAttribute(attribute, String(size));
  };
  const show = (/** @type {number | undefined} */ now) => {
    const scaled = now === undefined ? undefined : now * times;
    const shown = decimals === undefined ? formatNumber(scaled, digits) : formatFixed(scaled, decimals);
    if (value.textContent === shown) return;
    value.textContent = shown;
    fit();
  };
  const setUnit = (/** @type {Record<string, string>} */ units) => {
    unit.textContent = shape["unit"] ?? units[signal] ?? "";
    width = 0;
    measures.clear();
    fit();
  };
  setUnit({});
  scene.watch(signal, "signal", show);
  scene.onUnits.push(setUnit);
  scene.onTextSize.push((size) => {
    height = size;
    width = 0;
    measures.clear();
    fit();
  });
  const { base, sub } = splitName(name);
  scene.readouts.push({
    describe: () => `${[base, sub].filter(Boolean).join(" ")} ${value.textContent === UNDEFINED ? "unknown" : value.textContent} ${unit.textContent}`.trim(),
  });
  return { nodes: [node], box: [0, 0, 0, 0] };
}

/** @param {Shape} shape @param {Scene} scene */
export function instrument(shape, scene) {
  const r = scene.size(shape, "r", 18);
  const nodes = [svg("circle", { r, class: "body" })];
  if (shape["mount"] === "panel") nodes.push(svg("path", { d: `M${-r} 0H${r}`, class: "thin" }));
  const words = String(shape["letters"] ?? "");
  // four letters are as wide as the circle allows; a panel's stand above its line
  const size = Math.min(shape["mount"] === "panel" ? 0.66 * r : 0.78 * r, (2.1 * r) / Math.max(1, words.length));
  const letters = svg("text", { class: "letters", y: shape["mount"] === "panel" ? -0.42 * r : 0, "font-size": size }, words);
  return { nodes: [...nodes, letters], box: [-r, -r, 2 * r, 2 * r] };
}

/** @param {Shape} shape @param {Scene} scene */
export function dpCell(shape, scene) {
  const w = scene.size(shape, "width");
  const hh = scene.size(shape, "height");
  const bow = 0.22 * w;
  const low = svg("rect", { width: w, height: hh, rx: 8, class: "dp-low" });
  const high = svg("path", { class: "dp-high" });
  const diaphragm = svg("path", { class: "diaphragm" });
  scene.number(shape, "deflection", 0, (value) => {
    const x = w / 2 + 2 * bow * Math.min(1, Math.max(-1, value));
    high.setAttribute("d", `M${w / 2} 1Q${x} ${hh / 2} ${w / 2} ${hh - 1}H8Q1 ${hh - 1} 1 ${hh - 8}V8Q1 1 8 1Z`);
    diaphragm.setAttribute("d", `M${w / 2} 0Q${x} ${hh / 2} ${w / 2} ${hh}`);
  });
  const side = (/** @type {number} */ x, /** @type {string} */ letter) => svg("text", { x, y: hh - 10, class: "letters", "font-size": 13 }, letter);
  return { nodes: [low, high, svg("rect", { width: w, height: hh, rx: 8, class: "hollow" }), diaphragm, side(0.16 * w, "H"), side(0.84 * w, "L")], box: [0, 0, w, hh] };
}
