/** The poles that are wanted, to be dragged in the s-plane or typed; a pair moves as one. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {PlacementAnswer, PlacementState} from "../../core/design/pole-placement.js" */

import { formatNumber } from "../../core/format.js";
import { dampingOf, moveGroup, polesOf } from "../../core/design/pole-groups.js";
import { formatShort } from "../../core/roots.js";
import { tidy } from "../../core/scale.js";
import { mountDesignPanel } from "../../components/design-panel.js";
import { h } from "../../components/dom.js";
import "../../components/number-field.js";
import { createPlaneHandle } from "../../components/plane-handle.js";
import { createFigure } from "../../plots/figure.js";
import { polePlane } from "../../plots/design/pole_plane.js";

const HELP =
  "Drag a square to where a pole of the closed loop shall be, or move it with the arrow keys (Shift for large steps). Left is faster, on a steep line of small ζ it rings, the dotted upright lines tell the settling time. A real pole pulled off the axis makes a pair with its neighbour. Crosses and circles are poles and zeros of the plant.";
/** Nearer to the real axis than this share of the height a pair falls onto it. */
const ON_AXIS = 0.025;
/** Key presses across the plane. */
const STEPS = 200;

/** @param {HTMLElement} host @param {DesignBench<PlacementState, PlacementAnswer>} bench */
export function mount(host, bench) {
  /** @type {import("../../plots/figure.js").FigureHandle | null} */
  let figure = null;
  /** @type {HTMLElement} */
  let plane = host;
  let span = { x: 1, y: 1 };
  /** @type {Map<number, ReturnType<typeof createPlaneHandle>>} */
  const handles = new Map();

  const move = (/** @type {number} */ id, /** @type {number} */ re, /** @type {number} */ im, /** @type {boolean} */ moving) => bench.set({ groups: moveGroup(bench.state.groups, id, { re, im: Math.abs(im) < ON_AXIS * span.y ? 0 : im }) }, { moving });

  /** @param {number} id */
  function handleFor(id) {
    const known = handles.get(id);
    if (known) return known;
    const handle = createPlaneHandle({
      toPixels: (value) => figure?.pixelsOf(value) ?? null,
      toValues(pixels) {
        const found = figure?.valuesAt(pixels);
        return found ? { x: tidy(found.x), y: Math.abs(tidy(found.y)) } : null;
      },
      step(value, across, up) {
        const height = value.y + (up * span.y) / STEPS;
        // Off the axis a key must reach beyond what counts as on it.
        const off = value.y === 0 && up > 0 ? Math.max(height, 1.2 * ON_AXIS * span.y) : height;
        return { x: tidy(value.x + (across * span.x) / STEPS), y: tidy(Math.max(0, off)) };
      },
      describe: ({ x, y }) => {
        const { zeta } = dampingOf({ id, re: x, im: y });
        return y > 0 ? `Wanted pair ${formatShort(x)} ± ${formatShort(y)}j, damping ${formatNumber(zeta, 2)}. Arrow keys move it.` : `Wanted pole ${formatShort(x)}. Arrow keys move it.`;
      },
      onMove: ({ x, y }, moving) => move(id, x, y, moving),
    });
    handles.set(id, handle);
    plane.parentElement?.append(handle.root);
    return handle;
  }

  function showHandles() {
    const { groups } = bench.state;
    for (const [id, handle] of handles) {
      if (groups.some((group) => group.id === id)) continue;
      handle.show(null);
      handle.dispose();
      handle.root.remove();
      handles.delete(id);
    }
    for (const { id, re, im } of groups) handleFor(id).show({ x: re, y: im });
  }

  const list = h("div", { class: "pole-list", role: "group", "aria-label": "Wanted poles as numbers" });
  let listed = "";
  /** @type {Map<string, import("../../components/number-field.js").NumberField>} */
  const fields = new Map();

  function showList() {
    const { groups } = bench.state;
    const shape = groups.map(({ id, im }) => `${id}${im > 0}`).join();
    if (shape !== listed) {
      listed = shape;
      fields.clear();
      list.replaceChildren(
        ...groups.map(({ id, im }, k) => {
          const one = (/** @type {"re" | "im"} */ part, /** @type {string} */ label) => {
            const field = h("number-field", { label, ...(part === "im" ? { min: 0 } : {}) });
            fields.set(`${id}${part}`, field);
            field.addEventListener("value-change", () => {
              const now = bench.state.groups.find((group) => group.id === id);
              if (now && field.value !== null) bench.set({ groups: moveGroup(bench.state.groups, id, { re: now.re, im: now.im, [part]: field.value }) });
            });
            return field;
          };
          return h("div", { class: "pole-entry" }, one("re", im > 0 ? `Pair ${k + 1}, real part` : `Pole ${k + 1}`), im > 0 ? one("im", "± imaginary part") : null);
        }),
      );
    }
    for (const { id, re, im } of groups) {
      for (const [part, value] of /** @type {const} */ ([["re", re], ["im", im]])) {
        const field = fields.get(`${id}${part}`);
        if (field) field.value = value;
      }
    }
  }

  mountDesignPanel(host, bench, {
    id: "poles",
    title: "Wanted poles",
    help: HELP,
    live: true,
    subject: () => `${bench.state.plant}${bench.state.groups.length}${bench.answer?.design.plant_poles.length}`,
    figure(element) {
      plane = element;
      figure = createFigure(element);
      figure.onZoom(() => showHandles());
      element.addEventListener("figure-drawn", showHandles);
      return figure;
    },
    draw(theme, held) {
      const wanted = polesOf(bench.state.groups);
      if (wanted.length === 0) return null;
      const { plant_poles: poles = [], plant_zeros: zeros = [] } = bench.answer?.design ?? {};
      const drawn = polePlane({ wanted, poles, zeros, timeUnit: "s" }, theme, held);
      const { xaxis = [0, 1], yaxis = [0, 1] } = drawn.ranges;
      span = { x: xaxis[1] - xaxis[0], y: yaxis[1] - yaxis[0] };
      return drawn;
    },
    words(host_, moving) {
      if (!moving) showHandles();
      showList();
      if (!list.isConnected) host_.append(list);
    },
    legend: () => [
      { signal: "pole", glyph: "■", label: "wanted", name: "wanted poles of the closed loop: drag them" },
      { signal: "r", glyph: "×", label: "poles", name: "poles of the plant" },
      { signal: "r", glyph: "○", label: "zeros", name: "zeros of the plant, which stay in the closed loop" },
    ],
    table: () => ({ header: ["Re s", "Im s"], rows: polesOf(bench.state.groups).map(([re, im]) => [re, im]) }),
    describe: () => `Wanted poles in the s-plane: ${bench.state.groups.map(({ re, im }) => (im > 0 ? `${formatShort(re)} ± ${formatShort(im)}j` : formatShort(re))).join(", ")}.`,
  });
}
