/** Heat: elements, thermometers, exchangers, rooms. And what stirs. */

/** @import {Scene, Shape} from "./scene.js" */

import { svg } from "../dom.js";
import { formatNumber } from "../../core/format.js";

/** @param {Shape} shape @param {Scene} scene */
export function heater(shape, scene) {
  const w = scene.size(shape, "width");
  const h = scene.size(shape, "height");
  const turns = Math.max(3, Math.round(w / 14));
  const pitch = w / turns;
  let d = `M0 ${h / 2}`;
  for (let i = 0; i < turns; i += 1) d += `q${pitch / 4} ${-h} ${pitch / 2} 0t${pitch / 2} 0`;
  const glow = svg("path", { d, class: "heater-glow" });
  const rim = svg("path", { d, class: "heater-case" });
  const wire = svg("path", { d, class: "heater-wire" });
  scene.number(shape, "power", 0.5, (power) => {
    const part = Math.round(100 * Math.min(1, Math.max(0, power)));
    wire.style.stroke = `color-mix(in oklab, var(--draw-glow) ${part}%, var(--draw-metal))`;
    glow.setAttribute("opacity", String((0.45 * part) / 100));
  });
  return { nodes: [glow, rim, wire], box: [0, 0, w, h] };
}

/** @param {Shape} shape @param {Scene} scene */
export function stirrer(shape, scene) {
  const length = scene.size(shape, "length");
  const w = scene.size(shape, "width", 40);
  const blades = svg("path", { d: `M0 0L${-w / 2} -6V6L0 0L${w / 2} -6V6Z`, class: "stirrer-blade" });
  const run = scene.motion(blades, { transform: ["scaleX(1)", "scaleX(0.18)", "scaleX(1)"] }, 500);
  scene.number(shape, "speed", 0.7, run);
  return {
    nodes: [
      svg("path", { d: `M0 0V${length}`, class: "rod-line" }),
      svg("g", { transform: `translate(0 ${length})` }, blades),
      svg("rect", { x: -11, y: -15, width: 22, height: 17, rx: 3, class: "motor" }),
    ],
    box: [-w / 2, -15, w, length + 22],
  };
}

/** @param {Shape} shape @param {Scene} scene */
export function thermometer(shape, scene) {
  const h = scene.size(shape, "height");
  const bulb = 13;
  const [top, foot] = [10, h - 2 * bulb - 6];
  const glass = svg("path", { d: `M-7 ${h - 2 * bulb + 2}V7A7 7 0 0 1 7 7V${h - 2 * bulb + 2}A${bulb} ${bulb} 0 1 1 -7 ${h - 2 * bulb + 2}Z`, class: "glass" });
  const column = svg("path", { class: "thermometer-column" });
  const drop = svg("circle", { cy: h - bulb, r: bulb - 4 });
  const shine = svg("path", { d: `M-4 ${h - bulb - 3}a5 5 0 0 1 4 -3`, class: "shine" });
  scene.number(shape, "level", 0.5, (level) => {
    const part = Math.min(1, Math.max(0, level));
    column.setAttribute("d", `M0 ${h - bulb}V${foot + (top - foot) * part}`);
  });
  scene.colour(shape, "fill", "heat", (colour) => {
    column.style.stroke = colour;
    drop.style.fill = colour;
  });
  /** @type {SVGElement[]} */
  const scale = [];
  const { range, step } = shape;
  if (Array.isArray(range) && range[1] > range[0]) {
    const by = step > 0 ? Math.max(step, (range[1] - range[0]) / 20) : range[1] - range[0];
    for (let value = range[0]; value <= range[1] + 1e-9 * by; value += by) {
      const y = foot + ((top - foot) * (value - range[0])) / (range[1] - range[0]);
      scale.push(svg("path", { d: `M9 ${y}h7`, class: "tick" }), svg("text", { x: 20, y, class: "scale-number" }, formatNumber(value).replace(/\.0+$/, "")));
    }
  }
  return { nodes: [glass, column, drop, shine, ...scale], box: [-bulb, 0, 2 * bulb, h] };
}

/** @param {Shape} shape @param {Scene} scene */
export function exchanger(shape, scene) {
  const r = scene.size(shape, "r");
  const circle = svg("circle", { r, class: "body" });
  scene.colour(shape, "fill", "none", (colour) => (circle.style.fill = colour === "none" ? "var(--paper)" : colour));
  const [a, b] = [1.45 * r, 0.45 * r];
  return { nodes: [circle, svg("path", { d: `M${-a} 0H${-0.6 * r}L${-0.25 * r} ${-b}L${0.2 * r} ${b}L${0.55 * r} 0H${a}`, class: "zigzag" })], box: [-r, -r, 2 * r, 2 * r] };
}

/** @param {Shape} shape @param {Scene} scene */
export function room(shape, scene) {
  const w = scene.size(shape, "width");
  const h = scene.size(shape, "height");
  const roof = Math.min(0.34 * h, 0.3 * w);
  const eave = 0.06 * w;
  const air = svg("path", { d: `M0 ${h}V${roof}L${w / 2} 8L${w} ${roof}V${h}Z` });
  scene.colour(shape, "fill", "none", (colour) => (air.style.fill = colour === "none" ? "var(--paper)" : colour));
  const [wx, wy, ww, wh] = [0.68 * w, roof + 0.16 * (h - roof), 0.2 * w, 0.36 * (h - roof)];
  return {
    nodes: [
      air,
      svg("rect", { x: wx, y: wy, width: ww, height: wh, rx: 2, class: "window" }),
      svg("path", { d: `M${wx + ww / 2} ${wy}v${wh}M${wx} ${wy + wh / 2}h${ww}`, class: "thin" }),
      svg("path", { d: `M0 ${roof}V${h}H${w}V${roof}`, class: "vessel" }),
      svg("path", { d: `M${-eave} ${roof + 0.6 * eave}L${w / 2} 4L${w + eave} ${roof + 0.6 * eave}`, class: "roof" }),
    ],
    box: [0, 0, w, h],
  };
}
