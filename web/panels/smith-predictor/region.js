/** The plants that the loops stand: a plane of mismatch with exact limits, and the present plant to be dragged in it. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {Plane, SmithAnswer, SmithState} from "../../core/design/smith.js" */

import { sentence } from "../../core/format.js";
import { LOOPS, MISMATCH, PLANES } from "../../core/design/smith.js";
import { clamp } from "../../core/scale.js";
import { mountDesignPanel } from "../../components/design-panel.js";
import { h } from "../../components/dom.js";
import { createPlaneHandle } from "../../components/plane-handle.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";
import { AXIS_NAMES, smithRegionPlot } from "../../plots/design/smith_region.js";

const HELP =
  "Each point is a plant that differs from the model by so many per cent; the cross is the model itself. Within the shaded region the loop with the predictor is stable; the lines are the exact limits of all three loops. Drag the square: it is the plant.";

/** @param {HTMLElement} host @param {DesignBench<SmithState, SmithAnswer>} bench */
export function mount(host, bench) {
  /** @type {import("../../plots/figure.js").FigureHandle | null} */
  let figure = null;
  const choice = h("segmented-control", { label: "Plane", class: "small" });
  choice.options = [
    { value: "theta_K", label: "θ, K", title: "Dead time and gain" },
    { value: "theta_tau", label: "θ, τ", title: "Dead time and time constants" },
    { value: "K_tau", label: "K, τ", title: "Gain and time constants" },
  ];
  choice.addEventListener("value-change", () => bench.set({ plane: /** @type {Plane} */ (choice.value) }));
  const axes = () => PLANES[bench.state.plane];

  /** @param {number} x @param {number} y */
  function held(x, y) {
    const { along, across } = axes();
    const whole = (/** @type {number} */ value, /** @type {{min: number, max: number}} */ { min, max }) => clamp(Math.round(value), min, max);
    return { x: whole(x, MISMATCH[along]), y: whole(y, MISMATCH[across]) };
  }

  const handle = createPlaneHandle({
    toPixels: (value) => figure?.pixelsOf(value) ?? null,
    toValues(pixels) {
      const found = figure?.valuesAt(pixels);
      return found ? held(found.x, found.y) : null;
    },
    step: (value, right, up) => held(value.x + right, value.y + up),
    describe: ({ x, y }) => `The plant: ${AXIS_NAMES[axes().along]} ${x} per cent, ${AXIS_NAMES[axes().across]} ${y} per cent against the model. Arrow keys move it.`,
    onMove({ x, y }, moving) {
      const { along, across } = axes();
      bench.set({ mismatch: { ...bench.state.mismatch, [along]: x, [across]: y } }, { moving });
    },
  });

  function showHandle() {
    const { mismatch } = bench.state;
    const { along, across } = axes();
    handle.show(bench.answer?.region ? { x: mismatch[along], y: mismatch[across] } : null);
  }

  mountDesignPanel(host, bench, {
    id: "smith-region",
    title: "Stable plants",
    help: HELP,
    controls: [choice],
    live: true,
    figure(element) {
      element.parentElement?.append(handle.root);
      figure = createFigure(element);
      figure.onZoom(showHandle);
      element.addEventListener("figure-drawn", showHandle);
      return figure;
    },
    draw(theme, { moving }) {
      choice.value = bench.state.plane;
      // The plane holds while the plant moves in it; the handle alone moves.
      showHandle();
      const region = bench.answer?.region;
      return region && !moving ? smithRegionPlot(region, theme) : null;
    },
    note: () => (bench.answer?.region?.loops ?? []).flatMap(({ name, reason }) => (reason ? [`${LOOPS[name].label}: ${sentence(reason)}`] : [])).join(" "),
    legend: () => [
      { signal: "pole", glyph: "■", label: "plant", name: "the present plant: drag it" },
      ...(bench.answer?.region?.loops ?? []).filter(({ intervals }) => intervals).map(({ name }) => ({ signal: LOOPS[name].signal, label: LOOPS[name].label, name: `limit of stability of ${LOOPS[name].name}`, dash: name === "smith" ? "solid" : (SIGNALS[LOOPS[name].signal]?.dash ?? "dash") })),
    ],
    table() {
      const region = bench.answer?.region;
      if (!region) return null;
      const header = [`${region.across} factor`, "loop", `stable from ${region.along} factor`, "to"];
      return { header, rows: region.loops.flatMap(({ name, intervals }) => (intervals ?? []).flatMap((row, j) => row.map(([a, b]) => [region.rows[j] ?? null, LOOPS[name].label, a, b]))) };
    },
    describe: () => `Plane of mismatch in ${AXIS_NAMES[axes().along]} and ${AXIS_NAMES[axes().across]} with the limits of stability of the three loops.`,
  });
}
