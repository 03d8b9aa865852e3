/**
 * The block diagram r -> Σ -> controller -> plant -> y, with the load d entering, and actuator and sensor where the
 * loop has them: it shows the live values and is the way to the cards below it.
 */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { formatNumber } from "../../core/format.js";
import { hasDerivative, hasIntegral, parallelGains } from "../../core/workbench/loop.js";
import { openCard } from "../../components/card.js";
import { h, set, setText, svg } from "../../components/dom.js";

/** Card that each block opens; a page without that card leaves the block a picture. */
const CARDS = { controller: "card-controller", plant: "card-plant", actuator: "card-instruments", sensor: "card-instruments", r: "card-test", d: "card-test" };

/** What an actuator needs between controller and load. */
const ROOM = 84;

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const id = "arrow-head";
  const lines = {
    controller: [0, 1, 2, 3].map((i) => svg("text", { x: 122, y: 50 + 17 * i, class: i === 0 ? "block-title" : "block-value" })),
    plant: [0, 1, 2, 3].map((i) => svg("text", { x: 276, y: 50 + 17 * i, class: i === 0 ? "block-title" : "block-value" })),
    actuator: [0, 1].map((i) => svg("text", { x: 222, y: 50 + 17 * i, class: i === 0 ? "block-title" : "block-value" })),
    sensor: [0].map(() => svg("text", { y: 147, class: "block-value" })),
  };
  const wire = (/** @type {string} */ d, /** @type {string} */ signal, head = true) => svg("path", { d, class: `wire wire-${signal}`, "marker-end": head ? `url(#${id})` : null });
  const sum = (/** @type {number} */ x, /** @type {number} */ y) => svg("circle", { cx: x, cy: y, r: 9, class: "sum" });
  const text = (/** @type {number} */ x, /** @type {number} */ y, /** @type {string} */ words, kind = "wire-label") => svg("text", { x, y, class: kind }, words);

  /**
   * @param {keyof typeof CARDS} name
   * @param {{x: number, y: number, width: number, height: number}} box
   * @param {Element[]} inside
   */
  const block = (name, box, inside) => {
    const group = svg(
      "g",
      {
        class: `block block-${name}`,
        role: "button",
        tabindex: 0,
        onclick: () => openCard(CARDS[name]),
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key !== "Enter" && event.key !== " ") return;
          event.preventDefault();
          openCard(CARDS[name]);
        },
      },
      svg("rect", { ...box, rx: name === "r" || name === "d" ? 12 : 5 }),
      ...inside,
    );
    return group;
  };

  const blocks = {
    r: block("r", { x: 2, y: 58, width: 26, height: 26 }, [text(15, 76, "r", "terminal")]),
    controller: block("controller", { x: 76, y: 28, width: 92, height: 86 }, lines.controller),
    d: block("d", { x: 183, y: 4, width: 26, height: 26 }, [text(196, 22, "d", "terminal")]),
    plant: block("plant", { x: 224, y: 28, width: 104, height: 86 }, lines.plant),
    actuator: block("actuator", { x: 188, y: 45, width: 68, height: 52 }, lines.actuator),
    sensor: block("sensor", { x: 0, y: 128, width: 140, height: 28 }, lines.sensor),
  };
  const back = wire("", "y");
  const measured = svg("text", { x: 70, y: 134, class: "wire-label" }, "yₘ");
  const intoActuator = wire("M168 71H187", "u");
  const intoLoad = wire("", "u");
  // All that moves aside for an actuator.
  const right = svg(
    "g",
    {},
    wire("M196 30V61", "d"),
    wire("M205 71H223", "u"),
    wire("M328 71H374", "y"),
    svg("circle", { cx: 350, cy: 71, r: 3, class: "node" }),
    sum(196, 71),
    text(362, 62, "y"),
    blocks.d,
    blocks.plant,
  );

  const picture = svg(
    "svg",
    { viewBox: "0 0 380 156", class: "loop-diagram", role: "group", "aria-label": "Block diagram of the loop. Each block opens its card." },
    svg("defs", {}, svg("marker", { id, viewBox: "0 0 10 10", refX: 9, refY: 5, markerWidth: 7, markerHeight: 7, orient: "auto-start-reverse" }, svg("path", { d: "M0 1 10 5 0 9z", class: "arrow-head" }))),
    wire("M28 71H38", "r"),
    wire("M57 71H75", "e"),
    intoActuator,
    intoLoad,
    back,
    sum(47, 71),
    text(36, 60, "+", "sign"),
    text(36, 96, "−", "sign"),
    text(66, 62, "e"),
    text(178, 62, "u"),
    measured,
    blocks.r,
    blocks.controller,
    blocks.actuator,
    right,
    blocks.sensor,
  );
  const root = h("div", { class: "diagram" }, picture);
  host.append(root);

  function show() {
    const { controller, plant } = store.get();
    const rows = [...controllerRows(controller)];
    fill(lines.controller, rows, 71);
    const about = answers.plant;
    const words = plant.type === "expr" ? plant.text : plant.type === "fopdt" ? "lag, delay" : plant.type === "ss" ? "matrices" : "second order";
    const order = about?.order === undefined ? "" : `order ${about.order}`;
    const delay = about?.theta ? `θ ${formatNumber(about.theta)}` : "";
    const title = "plant P";
    fill(lines.plant, [title, shorten(words), order, delay].filter(Boolean), 71);
    layOut();
    set(blocks.controller, { "aria-label": `Controller: ${rows.join(", ")}` });
    set(blocks.plant, { "aria-label": `Plant: ${[words, order, delay].filter(Boolean).join(", ")}` });
    set(blocks.r, { "aria-label": "Setpoint r: choose the test" });
    set(blocks.d, { "aria-label": "Load d: choose the test" });
  }

  /** Room for actuator and sensor, where the loop has them. */
  function layOut() {
    const { actuator, sensor } = store.get();
    const room = actuator.trim() === "" ? 0 : ROOM;
    const middle = (350 + room + 47) / 2;
    const [A, H] = [answers.actuator, answers.sensor].map((about) => (about?.theta ? `θ ${formatNumber(about.theta)}` : ""));
    set(picture, { viewBox: `0 0 ${380 + room} 160` });
    set(right, { transform: `translate(${room} 0)` });
    set(intoLoad, { d: `M${room > 0 ? 256 : 168} 71H${186 + room}` });
    toggle(intoActuator, room > 0);
    set(back, { d: `M${350 + room} 71V142H47V81` });
    toggle(blocks.actuator, room > 0);
    toggle(blocks.sensor, sensor.trim() !== "");
    toggle(measured, sensor.trim() !== "");
    fill(lines.actuator, ["A", A ?? ""].filter(Boolean), 71);
    setText(/** @type {SVGElement} */ (lines.sensor[0]), ["sensor H", H].filter(Boolean).join(", "));
    set(/** @type {SVGElement} */ (lines.sensor[0]), { x: middle });
    const box = blocks.sensor.querySelector("rect");
    if (box) set(box, { x: middle - 70 });
    set(blocks.actuator, { "aria-label": `Actuator: ${[actuator, A].filter(Boolean).join(", ")}` });
    set(blocks.sensor, { "aria-label": `Sensor: ${[sensor, H].filter(Boolean).join(", ")}` });
  }

  const stopStore = store.subscribe(show);
  const stopAnswers = answers.subscribe(show);
  show();
  return () => {
    stopStore();
    stopAnswers();
    root.remove();
  };
}

/** @param {import("../../core/types.js").ControllerState} controller */
function controllerRows(controller) {
  const sign = controller.action === "direct" ? "−" : "";
  const { type, form, Kc, tau_I, tau_D } = controller;
  if (form === "parallel") {
    const { Kp, Ki, Kd } = parallelGains(controller);
    return [type, `Kp ${sign}${formatNumber(Kp)}`, ...(hasIntegral(type) ? [`Ki ${formatNumber(Ki)}`] : []), ...(hasDerivative(type) ? [`Kd ${formatNumber(Kd)}`] : [])];
  }
  return [type, `Kc ${sign}${formatNumber(Kc)}`, ...(hasIntegral(type) ? [`τI ${formatNumber(tau_I)}`] : []), ...(hasDerivative(type) ? [`τD ${formatNumber(tau_D)}`] : [])];
}

/** Writes rows centred about a line. @param {SVGElement[]} nodes @param {string[]} rows @param {number} middle */
function fill(nodes, rows, middle) {
  const pitch = 18;
  nodes.forEach((node, i) => {
    setText(node, rows[i] ?? "");
    set(node, { y: middle + 5 + pitch * (i - (rows.length - 1) / 2) });
  });
}

/** @param {SVGElement} element @param {boolean} there */
function toggle(element, there) {
  set(element, { display: there ? null : "none" });
}

/** @param {string} text */
function shorten(text) {
  return text.length > 13 ? `${text.slice(0, 12)}…` : text;
}
