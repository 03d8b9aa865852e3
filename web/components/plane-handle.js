/**
 * A button that lies on a plot and is dragged over its plane, by pointer or arrow keys (Shift: large steps). It knows
 * the plane only by the two maps it is given.
 */

import { h, set } from "./dom.js";

/** As with a slider: keys come in bursts, and the value rests when none has come for this long. */
const KEY_REST_MS = 400;

/** @typedef {{x: number, y: number}} Place */

/**
 * @typedef {object} PlaneHandleOptions
 * @property {(value: Place) => Place | null} toPixels  null while there is no plane
 * @property {(pixels: Place) => Place | null} toValues  held inside of the plane
 * @property {(value: Place, across: number, up: number) => Place} step  one key press
 * @property {(value: Place) => string} describe
 * @property {(value: Place, moving: boolean) => void} onMove
 */

/** @param {PlaneHandleOptions} options */
export function createPlaneHandle({ toPixels, toValues, step, describe, onMove }) {
  const root = h("button", { type: "button", class: "handle", hidden: true });
  /** @type {Place} */
  let value = { x: 1, y: 1 };
  let moving = false;
  let rest = 0;
  /** From the pointer to the middle of the handle, so that it does not jump when it is taken. */
  let grip = { x: 0, y: 0 };
  let shown = false;

  function place() {
    const at = shown ? toPixels(value) : null;
    root.hidden = at === null;
    if (!at) return;
    root.style.setProperty("--x", `${at.x}px`);
    root.style.setProperty("--y", `${at.y}px`);
    set(root, { "aria-label": describe(value) });
  }

  /** @param {Place} next */
  function move(next) {
    value = next;
    moving = true;
    place();
    onMove(value, true);
  }

  function settle() {
    clearTimeout(rest);
    if (!moving) return;
    moving = false;
    onMove(value, false);
  }

  root.addEventListener("pointerdown", (event) => {
    const at = toPixels(value);
    if (event.button !== 0 || !at) return;
    root.setPointerCapture(event.pointerId);
    grip = { x: event.clientX - at.x, y: event.clientY - at.y };
  });
  root.addEventListener("pointermove", (event) => {
    if (!root.hasPointerCapture(event.pointerId)) return;
    const next = toValues({ x: event.clientX - grip.x, y: event.clientY - grip.y });
    if (next) move(next);
  });
  root.addEventListener("lostpointercapture", settle);
  root.addEventListener("blur", settle);
  root.addEventListener("keydown", (event) => {
    const big = event.shiftKey ? 10 : 1;
    /** @type {Record<string, [number, number]>} */
    const steps = { ArrowRight: [big, 0], ArrowLeft: [-big, 0], ArrowUp: [0, big], ArrowDown: [0, -big] };
    const by = steps[event.key];
    if (!by) return;
    event.preventDefault();
    clearTimeout(rest);
    move(step(value, ...by));
  });
  root.addEventListener("keyup", () => {
    clearTimeout(rest);
    if (moving) rest = window.setTimeout(settle, KEY_REST_MS);
  });

  return {
    root,
    place,
    /** @param {Place | null} next  null where there is nothing to move */
    show(next) {
      shown = next !== null;
      if (next && !moving) value = next;
      place();
    },
    dispose: () => clearTimeout(rest),
  };
}
