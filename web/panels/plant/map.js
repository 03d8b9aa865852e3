/** The steady states followed over one input or parameter, around every turn. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */

import { formatNumber, formatWithUnit } from "../../core/format.js";
import { usualRange } from "../../core/plant/bench.js";
import { h } from "../../components/dom.js";
import { choice, fieldRow, number } from "../../components/form-parts.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";
import { createFigure } from "../../plots/figure.js";
import { steadyMapPlot } from "../../plots/plant/steady_map.js";

/** @param {HTMLElement} host @param {PlantBench} bench @param {Api} api */
export function mount(host, bench, api) {
  const signals = [...new Map([...bench.outputs, ...bench.model.states].map((each) => [each.name, each])).values()];
  const knobs = [...bench.inputs, ...bench.parameters];
  const again = () => analysis.again();
  const over = choice("Over", knobs.map(({ name, meaning }) => ({ value: name, label: meaning ? `${name}, ${meaning}` : name })), () => {
    shape();
    again();
  });
  const of = choice("Show", signals.map(({ name }) => ({ value: name, label: name })), () => analysis.redraw({ refit: true }));
  /** @type {Record<string, import("../../components/number-field.js").NumberField>} */
  let ends = {};
  const place = h("div", { class: "field-row" });

  function shape() {
    const knob = knobs.find(({ name }) => name === over.value);
    if (!knob) return;
    const { min, max } = usualRange(knob);
    const unit = bench.unit(knob.name);
    ends = { low: number("From", { value: min, unit }, again), high: number("To", { value: max, unit }, again) };
    place.replaceChildren(...Object.values(ends));
  }

  /** @param {{outputs: Record<string, number>, x?: Record<string, number>, states?: Record<string, number>}} point */
  const at = (point) => point.outputs[of.value] ?? (point.x ?? point.states)?.[of.value] ?? NaN;
  const analysis = mountPlantAnalysis(host, bench, {
    id: "plant-map",
    title: "Steady-state map",
    help: "Steady states over one input or parameter, followed by arc length so that the curve goes around a turn. Solid: stable, dashed: unstable. At a diamond two steady states meet and vanish: the plant jumps. At a star a pair of eigenvalues crosses the axis: the plant begins to swing.",
    action: "Draw the map",
    figure: createFigure,
    form: [fieldRow(over.root, of.root), place],
    send: (request) => api.workOut(bench.model.id, "continuation", request),
    request: () => (ends["low"]?.value == null || ends["high"]?.value == null ? null : { over: over.value, low: ends["low"].value, high: ends["high"].value }),
    draw: (answer, theme, held) =>
      steadyMapPlot(
        {
          branches: answer.branches.map((/** @type {any} */ branch) => ({ values: branch.values, y: branch.outputs[of.value] ?? branch.states[of.value], pieces: branch.pieces })),
          turning: answer.turning_points.map((/** @type {any} */ point) => ({ value: point.value, y: at(point) })),
          hopf: answer.hopf_points.map((/** @type {any} */ point) => ({ value: point.value, y: at(point) })),
          now: answer.steady_states.map((/** @type {any} */ point) => ({ value: answer.over.value, y: at(point) })),
          low: answer.over.low,
          high: answer.over.high,
          over: over.value,
          overUnit: bench.unit(over.value),
          of: of.value,
          ofUnit: bench.unit(of.value),
        },
        theme,
        held,
      ),
    words(answer) {
      const unit = bench.unit(over.value);
      const lines = [
        ...answer.turning_points.map((/** @type {any} */ point) => `Turning point at ${over.value} = ${formatWithUnit(point.value, unit, 5)}, ${of.value} = ${formatWithUnit(at(point), bench.unit(of.value), 5)}.`),
        ...answer.hopf_points.map((/** @type {any} */ point) => `Hopf point at ${over.value} = ${formatWithUnit(point.value, unit, 5)}, ${of.value} = ${formatWithUnit(at(point), bench.unit(of.value), 5)}: it swings with a period of ${formatWithUnit(point.period, bench.timeUnit)}.`),
      ];
      return [lines.length > 0 ? h("ul", { class: "plain-list" }, ...lines.map((line) => h("li", {}, line))) : h("p", {}, "No turning point and no Hopf point in this range.")];
    },
    table: (answer) => ({
      header: ["branch", over.value, ...signals.map(({ name }) => name), "stable"],
      rows: answer.branches.flatMap((/** @type {any} */ branch, /** @type {number} */ b) => branch.values.map((/** @type {number} */ value, /** @type {number} */ i) => [b + 1, value, ...signals.map(({ name }) => (branch.outputs[name] ?? branch.states[name])?.[i] ?? null), branch.stable[i] ? "yes" : "no"])),
    }),
    describe: (answer) => `${answer.branches.length} branches of steady states over ${over.value} from ${formatNumber(answer.over.low)} to ${formatNumber(answer.over.high)}, ${answer.turning_points.length} turning points, ${answer.hopf_points.length} Hopf points.`,
    legend: () => [
      { signal: "y", label: "stable", name: "the plant returns after a push" },
      { signal: "unstable", label: "unstable", name: "the plant leaves after a push", dash: "dash" },
    ],
  });
  shape();
  return analysis;
}
