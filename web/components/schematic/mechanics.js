/** What moves and pushes: carts, rods, cars, the ground they stand on, arrows, and a body that keeps warm. */

/** @import {Scene, Shape} from "./scene.js" */

import { svg } from "../dom.js";

/** A wheel with spokes, standing on y = 0. @param {number} x @param {number} r */
function wheelAt(x, r) {
  const spokes = [0, 60, 120].map((turn) => svg("path", { d: `M${-0.62 * r} 0H${0.62 * r}`, transform: `rotate(${turn})`, class: "spoke" }));
  const turning = svg("g", {}, ...spokes);
  const node = svg("g", { transform: `translate(${x} ${-r})` }, svg("circle", { r, class: "tyre" }), svg("circle", { r: 0.62 * r, class: "rim" }), turning);
  return { node, turning };
}

/** @param {Shape} shape @param {Scene} scene */
export function cart(shape, scene) {
  const w = scene.size(shape, "width");
  const h = scene.size(shape, "height");
  const r = Math.min(0.26 * h, 0.14 * w);
  const wheels = [-0.28 * w, 0.28 * w].map((x) => wheelAt(x, r));
  scene.number(shape, "x", 0, (x) => {
    for (const { turning } of wheels) turning.setAttribute("transform", `rotate(${(((x / r) * 180) / Math.PI) % 360})`);
  });
  return {
    nodes: [svg("rect", { x: -w / 2, y: -h, width: w, height: h - r, rx: 5, class: "cart-body" }), ...wheels.map(({ node }) => node)],
    box: [-w / 2, -h, w, h],
  };
}

/** @param {Shape} shape @param {Scene} scene */
export function rod(shape, scene) {
  const length = scene.size(shape, "length");
  const bob = shape["bob"] ?? 0;
  const bar = svg("path", { d: `M0 0V${-length}`, class: "rod" });
  const ball = bob > 0 ? svg("circle", { cy: -length, r: bob, class: "outlined" }) : null;
  scene.colour(shape, "fill", "accent", (colour) => {
    bar.style.stroke = colour;
    if (ball) ball.style.fill = colour;
  });
  return { nodes: [bar, ...(ball ? [ball] : []), svg("circle", { r: 5, class: "pivot" })], box: [-bob, -length - bob, 2 * bob, length + bob] };
}

/** @param {Shape} shape @param {Scene} scene */
export function car(shape, scene) {
  const scale = scene.size(shape, "size", 120) / 120;
  const wheels = [-35, 36].map((x) => wheelAt(x, 11));
  for (const { turning } of wheels) {
    const run = scene.motion(turning, { transform: ["rotate(0deg)", "rotate(360deg)"] }, 1000);
    scene.number(shape, "speed", 1, run);
  }
  const node = svg(
    "g",
    { transform: `scale(${scale})`, style: `--scale: ${scale}` },
    svg("path", { d: "M-55 -12Q-60 -12 -60 -17L-59 -27Q-58 -32 -51 -33L-42 -34C-32 -47 -26 -51 -14 -51H4C14 -51 20 -45 31 -35C46 -33 57 -31 59 -23L60 -16Q60 -12 56 -12Z", class: "car-body" }),
    svg("path", { d: "M-33 -35C-26 -43 -22 -46 -13 -46H-5V-35ZM1 -46H4C11 -46 15 -42 22 -35H1Z", class: "window" }),
    svg("path", { d: "M-2 -33V-17M8 -29h6M53 -25h5", class: "thin" }),
    ...wheels.map(({ node: wheel }) => wheel),
  );
  return { nodes: [node], box: [-60 * scale, -51 * scale, 120 * scale, 51 * scale] };
}

/** @param {Shape} shape @param {Scene} scene */
export function ground(shape, scene) {
  const length = scene.size(shape, "length");
  let hatch = "";
  for (let x = 6; x < length; x += 9) hatch += `M${x} 0l-7 8`;
  const nodes = [svg("path", { d: hatch, class: "hatch" }), svg("path", { d: `M0 0H${length}`, class: "vessel" })];
  if (shape["speed"] !== undefined) {
    const lane = svg("path", { d: `M0 18H${length}`, class: "lane", "stroke-dasharray": "26 20" });
    scene.number(shape, "speed", 0, scene.motion(lane, { strokeDashoffset: ["0", "46"] }, 400));
    nodes.push(lane);
  }
  return { nodes, box: [0, 0, length, 8] };
}

/** @param {Shape} shape @param {Scene} scene */
export function arrow(shape, scene) {
  const size = scene.size(shape, "size", 8);
  const path = svg("path", { class: "arrow-solid" });
  scene.number(shape, "length", 0, (length) => {
    const way = Math.sign(length);
    const whole = Math.abs(length);
    if (whole < 2) {
      path.setAttribute("d", "");
      return;
    }
    // a short arrow is a small one: it vanishes at 0 without a jump
    const shrink = Math.min(1, whole / (3 * size));
    const [head, half, shaft] = [1.7 * size * shrink, 0.85 * size * shrink, 0.25 * size * shrink];
    const neck = way * (whole - head);
    path.setAttribute("d", `M0 ${-shaft}H${neck}V${-half}L${length} 0L${neck} ${half}V${shaft}H0Z`);
  });
  scene.colour(shape, "fill", "force", (colour) => (path.style.fill = colour));
  return { nodes: [path], box: [0, -size, 0, 2 * size] };
}

/** Head, trunk and limbs of a body 200 high whose feet stand at 0: [path, thickness]. @type {[string, number][]} */
const BODY = [
  ["M0 -182V-178", 34],
  ["M0 -160V-146", 15],
  ["M-14 -136V-96M14 -136V-96M0 -136V-92", 28],
  ["M-27 -136C-36 -122 -37 -108 -42 -86", 15],
  ["M27 -136C36 -122 37 -108 42 -86", 15],
  ["M-14 -92L-18 -10", 20],
  ["M14 -92L18 -10", 20],
];

/** @param {Shape} shape @param {Scene} scene */
export function person(shape, scene) {
  const scale = scene.size(shape, "height") / 200;
  const outer = svg("g", { class: "person-outline" }, ...BODY.map(([d, width]) => svg("path", { d, "stroke-width": width + 4 / scale })));
  const shell = svg("g", { class: "person-shell" }, ...BODY.map(([d, width]) => svg("path", { d, "stroke-width": width })));
  const core = svg("g", {}, svg("ellipse", { cy: -183, rx: 10, ry: 11 }), svg("path", { d: "M-17 -138Q0 -145 17 -138Q20 -112 15 -90Q0 -82 -15 -90Q-20 -112 -17 -138Z" }));
  scene.colour(shape, "skin", "none", (colour) => (shell.style.stroke = colour === "none" ? "var(--paper)" : colour));
  scene.colour(shape, "fill", "none", (colour) => (core.style.fill = colour));
  return { nodes: [svg("g", { transform: `scale(${scale})`, style: `--scale: ${scale}` }, outer, shell, core)], box: [-50 * scale, -200 * scale, 100 * scale, 200 * scale] };
}
