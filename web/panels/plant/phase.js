/** Two states against one another: where the plant goes from anywhere. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {Values} from "../../core/plant/types.js" */

import { usualWindow } from "../../core/plant/bench.js";
import { h } from "../../components/dom.js";
import { choice, fieldRow, number } from "../../components/form-parts.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";
import { createFigure } from "../../plots/figure.js";
import { phasePlanePlot } from "../../plots/plant/phase_plane.js";

const MOST_STARTS = 20;

/** @param {HTMLElement} host @param {PlantBench} bench @param {Api} api */
export function mount(host, bench, api) {
  const { states } = bench.model;
  const names = states.map(({ name }) => ({ value: name, label: name }));
  /** @type {Values[]} */
  let starts = [];
  const other = () => {
    starts = [];
    shape();
    analysis.again();
  };
  const across = choice("Across", names, other);
  const up = choice("Up", names, other);
  up.value = states[1]?.name ?? "";
  /** @type {Record<string, import("../../components/number-field.js").NumberField>} */
  let from = {};
  /** @type {Record<string, {low: import("../../components/number-field.js").NumberField, high: import("../../components/number-field.js").NumberField}>} */
  let windows = {};
  const place = h("div", { class: "field-row" });
  const bounds = h("div", { class: "field-row" });
  const add = h("button", { type: "button", class: "button", onclick: () => begin(Object.fromEntries(Object.entries(from).map(([name, field]) => [name, field.value ?? 0]))) }, "Add a trajectory");
  const clear = h("button", { type: "button", class: "button", onclick: () => { starts = []; analysis.ask(); } }, "Clear");

  function shape() {
    from = Object.fromEntries([across.value, up.value].map((name) => [name, number(`From ${name}`, { value: Number((bench.answer.values[name] ?? 0).toPrecision(4)), unit: bench.unit(name) }, () => {})]));
    windows = Object.fromEntries(
      [across.value, up.value].map((name) => {
        const { low, high } = usualWindow(bench.answer, name);
        const unit = bench.unit(name);
        return [name, { low: number(`${name} at least`, { value: low, unit }, () => analysis.again()), high: number(`${name} at most`, { value: high, unit }, () => analysis.again()) }];
      }),
    );
    bounds.replaceChildren(...Object.values(windows).flatMap(({ low, high }) => [low, high]));
    place.replaceChildren(...Object.values(from), add, clear);
  }

  /** @param {Values} start */
  function begin(start) {
    starts = [...starts, start].slice(-MOST_STARTS);
    analysis.ask();
  }

  const analysis = mountPlantAnalysis(host, bench, {
    id: "plant-phase",
    title: "Phase plane",
    help: "Arrows show where the plant goes from each pair of states. On the dashed line the state across stands still, on the dotted line the state up does; where they cross is a steady state, filled where it is stable. Click in the plot, or type a start, to follow the plant from there.",
    action: "Draw the phase plane",
    figure: createFigure,
    form: [fieldRow(across.root, up.root), bounds, place],
    send: (request) => api.workOut(bench.model.id, "phase-plane", request),
    request: () => (across.value === up.value ? null : { horizontal: across.value, vertical: up.value, starts, ranges: Object.fromEntries(Object.entries(windows).map(([name, { low, high }]) => [name, [low.value, high.value]])) }),
    draw: (answer, theme) => phasePlanePlot(answer, theme),
    table: ({ trajectories, horizontal, vertical }) => ({
      header: ["trajectory", `t [${bench.timeUnit}]`, horizontal.name, vertical.name],
      rows: trajectories.flatMap((/** @type {any} */ each, /** @type {number} */ k) => each.t.map((/** @type {number} */ t, /** @type {number} */ i) => [k + 1, t, each.horizontal[i], each.vertical[i]])),
    }),
    describe: ({ horizontal, vertical, steady_states: steady, trajectories }) => `Phase plane of ${vertical.name} over ${horizontal.name} with ${steady.length} steady states and ${trajectories.length} trajectories.`,
    legend: ({ nullclines }) => [
      { signal: "y", label: "trajectory", name: "where the plant goes" },
      { signal: "y_m", label: `d${nullclines[0]?.state}/dt = 0`, name: "nullcline", dash: "dash" },
      { signal: "d", label: `d${nullclines[1]?.state}/dt = 0`, name: "nullcline", dash: "dot" },
    ],
  });
  shape();

  // A press without a drag is a start; a drag is Plotly's zoom.
  const plot = /** @type {any} */ (analysis.root.querySelector(".plot"));
  /** @type {{x: number, y: number} | null} */
  let pressed = null;
  plot.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => (pressed = { x: event.clientX, y: event.clientY }), { capture: true });
  addEventListener("pointerup", (event) => {
    const from_ = pressed;
    pressed = null;
    const layout = plot._fullLayout;
    if (!from_ || !layout || Math.hypot(event.clientX - from_.x, event.clientY - from_.y) > 4) return;
    const box = plot.getBoundingClientRect();
    const x = layout.xaxis.p2d(event.clientX - box.left - layout.margin.l);
    const y = layout.yaxis.p2d(event.clientY - box.top - layout.margin.t);
    const inside = (/** @type {number} */ value, /** @type {[number, number]} */ [a, b]) => value >= a && value <= b;
    if (inside(x, layout.xaxis.range) && inside(y, layout.yaxis.range)) begin({ [across.value]: x, [up.value]: y });
  });
  return analysis;
}
