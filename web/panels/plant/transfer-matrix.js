/** Steps of a transfer matrix: every output after a step of one of the inputs, all the others held. */

/** @import {Api} from "../../core/api.js" */
/** @import {MatrixDocument} from "../../core/plant/types.js" */

import { formatWithUnit } from "../../core/format.js";
import { h } from "../../components/dom.js";
import { fieldRow, number } from "../../components/form-parts.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";
import { createFigure } from "../../plots/figure.js";
import { matrixStepsPlot } from "../../plots/plant/matrix_steps.js";

const POINTS = 401;
/** Time constants after which nothing moves any more, to a quarter of a percent. */
const SETTLED = 6;

/** @param {MatrixDocument["entries"]} entries @returns {number} a time in which all of them settle */
export function settlingTime(entries) {
  return Number((SETTLED * Math.max(...entries.flat().map(({ lags, theta }) => Math.max(0, ...lags) + theta))).toPrecision(2));
}

/** @param {HTMLElement} host @param {MatrixDocument} matrix @param {Api} api */
export function mount(host, matrix, api) {
  const { id, inputs, outputs, entries, time_unit: timeUnit } = matrix;
  const horizon = settlingTime(entries);
  const segments = document.createElement("segmented-control");
  segments.setAttribute("label", "Input that steps");
  segments.options = inputs.map(({ name, meaning }) => ({ value: name, label: name, title: `${name}, ${meaning}` }));
  segments.value = inputs[0]?.name ?? "";
  const place = h("div", {});
  let size = sizeField(1);
  place.append(size);

  function ask() {
    analysis.ask();
  }

  /** @param {number} value in the unit of the chosen input */
  function sizeField(value) {
    return number("Step size", { value, unit: inputs.find(({ name }) => name === segments.value)?.unit ?? "" }, ask);
  }
  segments.addEventListener("value-change", () => {
    size = sizeField(size.value ?? 1);
    place.replaceChildren(size);
    ask();
  });

  /** @param {any} answer */
  const rows = ({ outputs: found }) => outputs.map(({ name, unit }) => ({ name, unit: unit === "-" ? "" : unit, values: /** @type {number[]} */ (found[name]) }));
  /** What has stepped is told by the answer: the form may be ahead of it. @param {any} answer */
  const stepped = ({ inputs: found }) => inputs.map(({ name, unit }) => ({ name, unit, size: /** @type {number} */ (found[name][0]) })).find((each) => each.size !== 0);

  /** @param {any} answer */
  function told(answer) {
    const step = stepped(answer);
    const ends = rows(answer).map(({ name, unit, values }) => `${name} = ${formatWithUnit(values.at(-1) ?? 0, unit, 4)}`);
    return `After ${step ? `a step of ${formatWithUnit(step.size, step.unit)} in ${step.name}` : "no step at all"}: ${ends.join(", ")} at t = ${formatWithUnit(horizon, timeUnit)}.`;
  }

  const analysis = mountPlantAnalysis(
    host,
    { request: () => ({}), subscribe: () => () => {} },
    {
      id: "transfer-matrix",
      title: "Step responses",
      help: "Every output after a step of one input at t = 0, the other inputs held. All are deviations from where the plant ran. An input that moves more than its own output is what makes two loops fight each other.",
      action: null,
      figure: createFigure,
      follows: false,
      form: [fieldRow(h("div", { class: "step-input" }, h("span", { class: "field-label" }, "Input that steps"), segments), place)],
      send: (request) => api.workOut(id, "simulate", request),
      request: () => (size.value === null ? null : { horizon, points: POINTS, inputs: { [segments.value]: { add: [{ type: "step", amplitude: size.value }] } } }),
      draw: (answer, theme) => matrixStepsPlot({ t: answer.t, outputs: rows(answer), timeUnit }, theme),
      table: (answer) => ({ header: [`t [${timeUnit}]`, ...outputs.map(({ name, unit }) => `${name} [${unit}]`)], rows: answer.t.map((/** @type {number} */ t, /** @type {number} */ i) => [t, ...rows(answer).map(({ values }) => values[i] ?? null)]) }),
      describe: told,
      words: (answer) => [h("p", {}, told(answer))],
    },
  );
  ask();
}
