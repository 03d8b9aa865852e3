/** What flows, and what it flows through: pipes, falling liquid, valves, pumps, orifice plates, regulators. */

/** @import {Scene, Shape} from "./scene.js" */

import { svg } from "../dom.js";
import { onColour } from "./colours.js";
import { arrowHead, boundsOf, roundedPath, towards } from "./geometry.js";

const DASH = 18;
/** Units of the view that the dashes of a full flow run in a second. */
const SPEED = 70;

/** @param {Shape} shape @param {Scene} scene */
export function pipe(shape, scene) {
  const points = scene.points(shape);
  const size = scene.size(shape, "size", 10);
  const headed = shape["arrow"] !== false;
  // the head of a wide pipe is wider than the pipe, and no more
  const headSize = Math.max(0.85 * size, Math.min(size, 12));
  const d = roundedPath(points, 1.4 * size);
  const wall = svg("path", { d, class: "pipe-wall", "stroke-width": size });
  const inside = svg("path", { d, class: "pipe-inside", "stroke-width": size - 3.5 });
  const dashes = svg("path", { d, class: "pipe-flow", "stroke-dasharray": `${0.4 * DASH} ${0.6 * DASH}` });
  const last = points[points.length - 1];
  const before = points[points.length - 2];
  const head = headed ? svg("path", { d: arrowHead(before, towards(last, before, -1.5 * headSize), 1.7 * headSize), class: "arrow-head" }) : null;
  const run = scene.motion(dashes, { strokeDashoffset: [String(DASH), "0"] }, (1000 * DASH) / SPEED);
  scene.number(shape, "flow", 0.5, (flow) => {
    const strength = Math.min(1, Math.abs(flow));
    dashes.setAttribute("stroke-width", String(strength < 1e-3 ? 0 : size * (0.14 + 0.3 * strength)));
    run(strength < 1e-3 ? 0 : Math.sign(flow) * (0.2 + 0.8 * strength));
    if (head) head.setAttribute("opacity", strength < 1e-3 ? "0.3" : "1");
  });
  scene.colour(shape, "fill", "water", (colour) => {
    inside.style.stroke = colour;
    dashes.style.stroke = onColour(colour);
  });
  const [x, y, w, h] = boundsOf(points);
  return { nodes: [wall, inside, dashes, ...(head ? [head] : [])], box: [x - size / 2, y - size / 2, w + size, h + size] };
}

/** @param {Shape} shape @param {Scene} scene */
export function stream(shape, scene) {
  const size = scene.size(shape, "size", 8);
  const water = svg("path", { class: "stream" });
  const dashes = svg("path", { class: "stream-flow", "stroke-dasharray": `${0.4 * DASH} ${0.6 * DASH}` });
  const run = scene.motion(dashes, { strokeDashoffset: [String(DASH), "0"] }, (1000 * DASH) / (2 * SPEED));
  let length = 0;
  let strength = 0;
  const draw = () => {
    // a falling stream grows thinner
    const [a, b] = [(size / 2) * strength, (size / 2) * strength * 0.75];
    water.setAttribute("d", length > 0 && strength > 0 ? `M${-a} 0Q${-b} ${0.3 * length} ${-b} ${length}H${b}Q${b} ${0.3 * length} ${a} 0Z` : "");
    dashes.setAttribute("d", length > 0 && strength > 0 ? `M0 2V${length}` : "");
    dashes.setAttribute("stroke-width", String(0.5 * b));
  };
  scene.number(shape, "length", 0, (value) => {
    length = value;
    draw();
  });
  scene.number(shape, "flow", 1, (flow) => {
    const part = Math.min(1, Math.max(0, flow));
    strength = part < 1e-3 ? 0 : 0.35 + 0.65 * part;
    run(strength);
    draw();
  });
  scene.colour(shape, "fill", "water", (colour) => {
    water.style.fill = colour;
    dashes.style.stroke = onColour(colour);
  });
  return { nodes: [water, dashes], box: [-size / 2, 0, size, 20] };
}

/** @param {Shape} shape @param {Scene} scene */
export function valve(shape, scene) {
  const s = scene.size(shape, "size", 32);
  const actuator = shape["actuator"] ?? "diaphragm";
  const [a, b] = [s / 2, 0.34 * s];
  const body = svg("path", { d: `M${-a} ${-b}L0 0L${-a} ${b}ZM${a} ${-b}L0 0L${a} ${b}Z`, class: "body" });
  const fill = svg("path", { d: `M${-a} ${-b}L0 0L${-a} ${b}ZM${a} ${-b}L0 0L${a} ${b}Z`, class: "valve-open" });
  // what runs in the line ends at the valve
  const nodes = [svg("rect", { x: -a, y: -b, width: s, height: 2 * b, class: "vessel-inside" }), body, fill];
  const top = -1.02 * s;
  const travel = 0.26 * s;
  const stem = svg("path", { class: "rod-line" });
  const mark = svg("path", { class: "stem-mark" });
  if (actuator !== "none") nodes.push(stem);
  if (actuator === "diaphragm") {
    nodes.push(svg("path", { d: `M${-0.42 * s} ${top}A${0.42 * s} ${0.36 * s} 0 0 1 ${0.42 * s} ${top}Z`, class: "body" }));
    // the travel of the stem is read against two ticks: shut and open
    nodes.push(svg("path", { d: `M${0.16 * s} ${-0.42 * s}h${0.14 * s}M${0.16 * s} ${-0.42 * s - travel}h${0.14 * s}`, class: "tick" }), mark);
  }
  const wheel = actuator === "hand" ? svg("path", { d: `M${-0.36 * s} 0H${0.36 * s}`, class: "vessel" }) : null;
  if (wheel) nodes.push(wheel);
  scene.number(shape, "opening", 0.5, (value) => {
    const opening = Math.min(1, Math.max(0, value));
    const lift = opening * travel;
    fill.setAttribute("opacity", String(Math.round(100 * opening) / 100));
    stem.setAttribute("d", `M0 0V${actuator === "hand" ? -0.55 * s - lift : top}`);
    mark.setAttribute("d", `M${-0.14 * s} ${-0.42 * s - lift}H${0.14 * s}`);
    wheel?.setAttribute("transform", `translate(0 ${-0.55 * s - lift})`);
  });
  return { nodes, box: [-a, actuator === "none" ? -b : 1.38 * -s, s, actuator === "none" ? 2 * b : 1.38 * s + b] };
}

/** @param {Shape} shape @param {Scene} scene */
export function pump(shape, scene) {
  const r = scene.size(shape, "r");
  const side = shape["outlet"] === "left" ? -1 : 1;
  const blades = [0, 72, 144, 216, 288].map((turn) => svg("path", { d: `M0 ${-0.24 * r}Q${0.42 * r * side} ${-0.3 * r} ${0.36 * r * side} ${-0.68 * r}`, transform: `rotate(${turn})`, class: "blade" }));
  const wheel = svg("g", {}, ...blades);
  const run = scene.motion(wheel, { transform: ["rotate(0deg)", `rotate(${side * 360}deg)`] }, 1000);
  scene.number(shape, "speed", 1, run);
  return {
    nodes: [
      svg("path", { d: `M0 ${-r}H${side * 1.35 * r}V${-0.52 * r}H${side * 0.85 * r}`, class: "body" }),
      svg("path", { d: `M${-0.55 * r} ${0.8 * r}L${-0.85 * r} ${1.2 * r}H${0.85 * r}L${0.55 * r} ${0.8 * r}`, class: "body" }),
      svg("circle", { r, class: "body" }),
      wheel,
      svg("circle", { r: 0.2 * r, class: "eye" }),
    ],
    box: [-r, -r, 2 * r, 2.2 * r],
  };
}

/** @param {Shape} shape @param {Scene} scene */
export function orifice(shape, scene) {
  const s = scene.size(shape, "size", 28);
  const half = s / 2;
  return {
    nodes: [
      svg("path", { d: `M-8 -5V${-half - 8}M8 -5V${-half - 8}`, class: "rod-line" }),
      svg("path", { d: `M-5.500 ${-half}h4v${s}h-4zM1.500 ${-half}h4v${s}h-4z`, class: "body" }),
      svg("path", { d: `M0 ${-half - 4}V-2M0 2V${half + 4}`, class: "orifice-plate" }),
    ],
    box: [-10, -half - 8, 20, s + 12],
  };
}

/** @param {Shape} shape @param {Scene} scene */
export function regulator(shape, scene) {
  const s = scene.size(shape, "size", 64) / 64;
  const spring = svg("path", { class: "coil" });
  const diaphragm = svg("path", { class: "vessel" });
  const plug = svg("path", { class: "plug" });
  scene.number(shape, "opening", 0.5, (value) => {
    const lift = 9 * Math.min(1, Math.max(0, value));
    const bow = -30 + lift;
    const turns = Array.from({ length: 7 }, (_, i) => `L${i % 2 ? 7 : -7} ${-56 + ((bow + 52) * (i + 0.5)) / 7}`).join("");
    spring.setAttribute("d", `M0 -56${turns}L0 ${bow - 3}`);
    diaphragm.setAttribute("d", `M-26 -30Q-14 ${bow} 0 ${bow}Q14 ${bow} 26 -30`);
    plug.setAttribute("d", `M0 ${bow}V${4 + lift}M-8 ${4 + lift}H8L4 ${12 + lift}H-4Z`);
  });
  const node = svg(
    "g",
    { transform: `scale(${s})`, style: `--scale: ${s}` },
    svg("path", { d: "M-13 -60H13V-36H26Q30 -36 30 -32V-22Q30 -18 26 -18H20V-9H32V9H20V22H-20V9H-32V-9H-20V-18H-26Q-30 -18 -30 -22V-32Q-30 -36 -26 -36H-13Z", class: "body" }),
    // the seat: a wall from the inlet's roof to the outlet's floor, with the hole that the plug shuts
    svg("path", { d: "M-20 -9H-12V3H-6M6 3H14V9H20", class: "vessel" }),
    spring,
    diaphragm,
    plug,
  );
  return { nodes: [node], box: [-32 * s, -60 * s, 64 * s, 82 * s] };
}
