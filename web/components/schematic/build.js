/** From the shapes of a drawing to nodes: repeats are written out, places and labels are put on, what is wrong is told. */

/** @import {Scene, Shape} from "./scene.js" */
/** @typedef {{nodes: SVGElement[], box: number[]}} Drawn  in the shape's own coordinates; box is x, y, width, height */

import { svg } from "../dom.js";
import { arrow, car, cart, ground, person, rod } from "./mechanics.js";
import { box, disc, dpCell, instrument, line, readout, ruler, text } from "./marks.js";
import { orifice, pipe, pump, regulator, stream, valve } from "./piping.js";
import { ShapeError } from "./scene.js";
import { exchanger, heater, room, stirrer, thermometer } from "./thermal.js";
import { tank, tray } from "./vessels.js";

const MAX_DRAWN = 2000;
const MAX_DEPTH = 6;

/** @param {Shape} shape @param {Scene} scene @returns {Drawn} */
function group(shape, scene) {
  return { nodes: buildAll(shape["shapes"], scene, `${scene.path}.shapes`), box: [0, 0, 0, 0] };
}

/** @type {Record<string, (shape: Shape, scene: Scene) => Drawn>} */
const KINDS = {
  arrow, box, car, cart, disc, dp_cell: dpCell, exchanger, ground, group, heater, instrument, line, orifice, person, pipe, pump,
  readout, regulator, rod, room, ruler, stirrer, stream, tank, text, thermometer, tray, valve,
};

export const KIND_NAMES = Object.keys(KINDS);

/** @type {WeakMap<Scene, number>} */
const drawn = new WeakMap();

/** @param {unknown} shapes @param {Scene} scene @param {string} path @returns {SVGElement[]} */
export function buildAll(shapes, scene, path) {
  scene.path = path;
  if (!Array.isArray(shapes)) {
    scene.complain("", "must be a list of shapes");
    return [];
  }
  if (path.split(".shapes").length > MAX_DEPTH) {
    scene.complain("", `groups inside groups at most ${MAX_DEPTH} deep`);
    return [];
  }
  return shapes.flatMap((shape, i) => buildRepeated(shape, scene, `${path}[${i}]`));
}

/** @param {Shape} shape @param {Scene} scene @param {string} path @returns {SVGElement[]} */
function buildRepeated(shape, scene, path) {
  scene.path = path;
  const repeat = shape?.["repeat"];
  if (!repeat) return buildOne(shape, scene, path) ?? [];
  const { count, index = "i", first = 1, step } = repeat;
  const good = Number.isInteger(count) && count >= 1 && count <= 100 && Number.isInteger(first) && /^[a-z]$/.test(index) && Array.isArray(step) && step.every(Number.isFinite);
  if (!good) {
    scene.complain("repeat", "needs a count from 1 to 100, a step of two numbers, and one letter as its index");
    return [];
  }
  const outer = scene.index;
  const nodes = [];
  for (let k = 0; k < count; k += 1) {
    scene.index = first + k;
    const one = buildOne(/** @type {Shape} */ (withIndex(shape, index, first + k)), scene, path);
    if (one) nodes.push(svg("g", { transform: `translate(${k * step[0]} ${k * step[1]})` }, ...one));
  }
  scene.index = outer;
  return nodes;
}

/** A copy with the index put into every text. @param {unknown} value @param {string} letter @param {number} index @returns {unknown} */
function withIndex(value, letter, index) {
  if (typeof value === "string") return value.replaceAll(new RegExp(`\\{${letter}([+-]1)?\\}`, "g"), (_, shift) => String(index + Number(shift ?? 0)));
  if (Array.isArray(value)) return value.map((item) => withIndex(item, letter, index));
  if (value && typeof value === "object") return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, withIndex(item, letter, index)]));
  return value;
}

/** @param {Shape} shape @param {Scene} scene @param {string} path @returns {SVGElement[] | null} */
function buildOne(shape, scene, path) {
  const kind = shape?.["kind"];
  const number = (drawn.get(scene) ?? 0) + 1;
  drawn.set(scene, number);
  if (number > MAX_DRAWN) {
    if (number === MAX_DRAWN + 1) scene.complain("", `more than ${MAX_DRAWN} shapes: the rest is left out`);
    return null;
  }
  if (!Object.hasOwn(KINDS, kind)) {
    scene.complain("kind", `no shape is called "${kind}"`);
    return null;
  }
  try {
    const { nodes, box: bounds } = KINDS[kind](shape, scene);
    scene.path = path;
    return [place(shape, scene, nodes, bounds)];
  } catch (error) {
    scene.path = path;
    if (error instanceof ShapeError) scene.complain(error.property, error.message);
    else scene.complain("", `could not be drawn (${String(error)})`);
    return null;
  }
}

/** @param {Shape} shape @param {Scene} scene @param {SVGElement[]} nodes @param {number[]} bounds */
function place(shape, scene, nodes, bounds) {
  const inner = svg("g", {}, ...nodes);
  const outer = svg("g", { class: `shape shape-${shape["kind"]}`, "data-id": shape["id"] }, inner);
  if ("x" in shape || "y" in shape) {
    const at = { x: 0, y: 0 };
    const move = () => outer.setAttribute("transform", `translate(${round(at.x)} ${round(at.y)})`);
    for (const axis of /** @type {const} */ (["x", "y"])) {
      scene.number(shape, axis, 0, (value) => {
        at[axis] = value;
        move();
      });
    }
  }
  if (shape["rotate"]) scene.number(shape, "rotate", 0, (turn) => inner.setAttribute("transform", `rotate(${round(turn)})`));
  if (shape["opacity"] !== undefined) scene.number(shape, "opacity", 1, (part) => outer.setAttribute("opacity", String(Math.min(1, Math.max(0, part)))));
  if (typeof shape["label"] === "string") outer.append(labelOf(shape["label"], shape["label_at"] ?? "bottom", bounds));
  return outer;
}

/** @param {number} n */
function round(n) {
  return Math.round(1000 * n) / 1000;
}

/** @param {string} words @param {string} side @param {number[]} bounds */
function labelOf(words, side, [x, y, w, h]) {
  const [middle, centre] = [x + w / 2, y + h / 2];
  /** @type {Record<string, [number, number, string, string]>} */
  const places = {
    top: [middle, y - 4, "middle", "-0.2em"],
    bottom: [middle, y + h + 4, "middle", "0.95em"],
    left: [x - 7, centre, "end", "0.35em"],
    right: [x + w + 7, centre, "start", "0.35em"],
    centre: [middle, centre, "middle", "0.35em"],
  };
  const [lx, ly, anchor, dy] = places[side] ?? places["bottom"];
  return svg("text", { x: lx, y: ly, dy, "text-anchor": anchor, class: "shape-label" }, words);
}
