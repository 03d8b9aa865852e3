/** Vessels: tanks with their jackets, and the trays of a column. */

/** @import {Scene, Shape} from "./scene.js" */

import { svg, uniqueId } from "../dom.js";
import { onColour } from "./colours.js";

const JACKET = 11;

/**
 * The outline of a vessel, and of what it holds.
 * @param {number} w @param {number} h @param {string} top @param {string} bottom
 */
function outline(w, h, top, bottom) {
  const head = top === "dished" ? Math.min(0.22 * w, 0.3 * h) : 0;
  const foot = bottom === "dished" ? Math.min(0.22 * w, 0.3 * h) : 0;
  const corner = bottom === "flat" ? 5 : 0;
  const base = foot ? `V${h - foot}A${w / 2} ${foot} 0 0 0 ${w} ${h - foot}` : `V${h - corner}Q0 ${h} ${corner} ${h}H${w - corner}Q${w} ${h} ${w} ${h - corner}`;
  const inside = top === "dished" ? `M0 ${head}${base}V${head}A${w / 2} ${head} 0 0 0 0 ${head}Z` : top === "closed" ? `M0 5${base}V5Q${w} 0 ${w - 5} 0H5Q0 0 0 5Z` : `M0 0${base}V0Z`;
  const wall = top === "open" ? `M-6 0H0${base}V0H${w + 6}` : inside;
  return { inside, wall, foot };
}

/** @param {Shape} shape @param {Scene} scene */
export function tank(shape, scene) {
  const w = scene.size(shape, "width");
  const h = scene.size(shape, "height");
  const { inside, wall, foot } = outline(w, h, shape["top"] ?? "open", shape["bottom"] ?? "flat");
  const clip = uniqueId("vessel");
  const liquid = svg("rect", { x: 0, width: w, "clip-path": `url(#${clip})` });
  const surface = svg("path", { class: "surface", "clip-path": `url(#${clip})` });
  const parts = [svg("clipPath", { id: clip }, svg("path", { d: inside }))];
  const o = (shape["jacket"] ?? "none") === "none" ? 0 : JACKET;
  if (o > 0) {
    const y = Math.round(0.22 * h);
    const d = foot
      ? `M0 ${y}H${-o}V${h - foot}A${w / 2 + o} ${foot + o} 0 0 0 ${w + o} ${h - foot}V${y}H${w}`
      : `M0 ${y}H${-o}V${h + o - 6}Q${-o} ${h + o} ${6 - o} ${h + o}H${w + o - 6}Q${w + o} ${h + o} ${w + o} ${h + o - 6}V${y}H${w}`;
    const jacket = svg("path", { d: `${d}Z`, class: "jacket" });
    scene.colour(shape, "jacket", "none", (colour) => (jacket.style.fill = colour));
    parts.push(jacket);
  }
  parts.push(svg("path", { d: inside, class: "vessel-inside" }), liquid, surface, svg("path", { d: wall, class: "vessel" }));
  scene.number(shape, "level", 0.6, (level) => {
    const depth = Math.min(1, Math.max(0, level)) * h;
    liquid.setAttribute("y", String(h - depth));
    liquid.setAttribute("height", String(depth));
    surface.setAttribute("d", depth > 0 ? `M0 ${h - depth}H${w}` : "");
  });
  scene.colour(shape, "fill", "water", (colour) => {
    liquid.style.fill = colour;
    surface.style.stroke = onColour(colour);
  });
  return { nodes: parts, box: [-o, 0, w + 2 * o, h + o] };
}

/** @param {Shape} shape @param {Scene} scene */
export function tray(shape, scene) {
  const w = scene.size(shape, "width");
  const h = scene.size(shape, "height");
  const side = shape["downcomer"] ?? "alternate";
  const right = side === "right" || (side === "alternate" && scene.index % 2 === 0);
  const gap = side === "none" ? 0 : Math.min(0.16 * w, 22);
  const start = right || !gap ? 0 : gap;
  const end = right ? w - gap : w;
  const weir = right ? end : start;
  const liquid = svg("rect", { x: start, width: end - start });
  scene.number(shape, "level", 0.5, (level) => {
    const depth = Math.min(1, Math.max(0, level)) * 0.8 * h;
    liquid.setAttribute("y", String(h - depth));
    liquid.setAttribute("height", String(depth));
  });
  scene.colour(shape, "fill", "water", (colour) => (liquid.style.fill = colour));
  const plate = svg("path", { d: `M${start} ${h}H${end}`, class: "plate" });
  const drop = gap ? svg("path", { d: `M${weir} ${0.45 * h}V${1.5 * h}`, class: "plate" }) : null;
  return { nodes: [liquid, plate, ...(drop ? [drop] : [])], box: [0, 0, w, h] };
}
