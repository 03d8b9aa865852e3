/** The linear model about a state: matrices with their names, poles, one channel, and how far it can be trusted. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {PlantRun} from "../../core/plant/run.js" */

import { formatNumber, formatWithUnit, sentence, toInput } from "../../core/format.js";
import { matrixLine } from "../../core/lists.js";
import { round125 } from "../../core/plant/pace.js";
import { usualRange } from "../../core/plant/bench.js";
import { formatShort, rootsText } from "../../core/roots.js";
import { h } from "../../components/dom.js";
import { captioned, headRow, valueTable } from "../../components/facts.js";
import { choice, fieldRow } from "../../components/form-parts.js";
import "../../components/gain-slider.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";
import { createFigure } from "../../plots/figure.js";
import { linearStepPlot } from "../../plots/plant/linear_step.js";

/** A larger matrix is no reading matter. */
const MOST = 10;

/** @param {any} ss @returns {string} the address of the workbench with this model as its plant */
export function workbenchLink({ A, B, C, D }) {
  const query = new URLSearchParams({ plant: "ss", A: matrixLine(A), B: matrixLine(B), C: matrixLine(C), D: matrixLine(D) });
  return `/workbench?${query}`;
}

/**
 * @param {HTMLElement} host
 * @param {PlantBench} bench
 * @param {PlantRun} run
 * @param {Api} api
 */
export function mount(host, bench, run, api) {
  const again = () => analysis.again();
  const where = choice("About", [{ value: "steady-state", label: "the steady state nearest to the run" }, { value: "point", label: "where the run is now" }], again);
  const input = choice("Input", bench.inputs.map(({ name }) => ({ value: name, label: name })), () => {
    shape();
    again();
  });
  const output = choice("Output", bench.outputs.map(({ name }) => ({ value: name, label: name })), again);
  const place = h("div", { class: "plant-step-size" });
  let size = 0;

  function shape() {
    const quantity = bench.inputs.find(({ name }) => name === input.value);
    if (!quantity) return;
    const { min, max } = usualRange(quantity);
    const reach = (max - min) / 4;
    size = round125(reach / 10);
    const slider = document.createElement("gain-slider");
    for (const [key, text] of Object.entries({ label: `Step of ${input.value}`, unit: bench.unit(input.value), min: -reach, max: reach, linear: "" })) slider.setAttribute(key, String(text));
    slider.value = size;
    slider.addEventListener("value-input", (event) => {
      size = /** @type {CustomEvent<{value: number}>} */ (event).detail.value;
      if (analysis.answer) analysis.ask();
    });
    place.replaceChildren(slider);
  }

  const analysis = mountPlantAnalysis(host, bench, {
    id: "plant-linear",
    title: "Linear model",
    help: "The plant about one state, by exact derivatives: dx/dt = A x + B u, y = C x + D u in deviations. The step of the linear model is drawn beside that of the plant: the larger the step, the further they part.",
    action: "Linearise",
    figure: createFigure,
    form: [fieldRow(where.root, input.root, output.root), place],
    send: (request) => api.workOut(bench.model.id, "linearize", request),
    request: () => ({ near: run.history.t.length > 0 ? run.stateNow() : bench.setting.start, at: where.value, input: input.value, output: output.value, steps: size === 0 ? [] : [size] }),
    draw({ responses: [response] }, theme, held) {
      return linearStepPlot({ t: response?.t ?? [], linear: response?.linear ?? [], nonlinear: response?.nonlinear ?? [], output: output.value, unit: bench.unit(output.value), timeUnit: bench.timeUnit }, theme, held);
    },
    words: (answer) => [told(answer), channelTable(answer), ...matrices(answer)],
    table: ({ responses: [response] }) => (response ? { header: [`t [${bench.timeUnit}]`, "linear model", "plant"], rows: response.t.map((/** @type {number} */ t, /** @type {number} */ i) => [t, response.linear[i] ?? null, response.nonlinear[i] ?? null]) } : null),
    describe: (answer) => `Linear model with poles ${rootsText(answer.poles)}; ${answer.verdict}.`,
    legend: () => [
      { signal: "y", label: "plant", name: "the nonlinear plant" },
      { signal: "u", label: "linear model", name: "its linear model", dash: "dash" },
    ],
  });
  shape();

  /** @param {any} answer */
  function told({ x, verdict, kind, remark, responses: [response] }) {
    const names = Object.entries(x).slice(0, MOST);
    const parts = [`About ${names.map(([name, value]) => `${name} = ${formatWithUnit(/** @type {number} */ (value), bench.unit(name), 5)}`).join(", ")}: ${verdict}, ${kind}.`, sentence(remark)];
    if (response) parts.push(`For this step the two differ by at most ${formatWithUnit(response.largest_deviation, bench.unit(output.value))}, at t = ${formatWithUnit(response.at, bench.timeUnit)}.`);
    if (response?.truncated_reason) parts.push(`The plant's run ends at t = ${formatNumber(response.truncated_at)}: ${sentence(response.truncated_reason)}`);
    return h("p", {}, parts.filter(Boolean).join(" "));
  }

  /** @param {any} answer */
  function channelTable({ channel, poles, time_constants: times }) {
    const factors = (/** @type {any[]} */ roots) => (roots.length === 0 ? "none" : rootsText(/** @type {any} */ (roots)));
    const table = valueTable(`From ${channel.input} to ${channel.output}`, ["", "value"], [
      ["static gain", channel.gain === null ? `— ${channel.gain_reason ?? ""}` : `${formatNumber(channel.gain, 5)} ${channel.gain_unit ?? ""}`],
      ["zeros", factors(channel.zeros)],
      ["poles", factors(channel.poles)],
      ["leading coefficient", formatNumber(channel.k, 5)],
      ["all poles", factors(poles)],
      ["time constants", times.map((/** @type {number} */ tau) => formatWithUnit(tau, bench.timeUnit)).join(", ")],
    ]);
    return h("div", {}, table, channel.ss ? h("p", {}, h("a", { class: "button", href: workbenchLink(channel.ss) }, "Open in the workbench")) : null);
  }

  /** @param {any} answer */
  function matrices({ A, B, C, D, states, input_signals: u, output_signals: y }) {
    if (states.length > MOST) return [];
    /** @param {string} caption @param {number[][]} matrix @param {{name: string}[]} rows @param {{name: string}[]} columns */
    const table = (caption, matrix, rows, columns) =>
      captioned(caption, h("table", { class: "values" }, headRow(["", ...columns.map(({ name }) => name)]), h("tbody", {}, ...matrix.map((row, i) => h("tr", {}, h("th", { scope: "row" }, rows[i]?.name ?? ""), ...row.map((value) => h("td", { title: toInput(value) }, formatShort(value))))))));
    return [h("details", {}, h("summary", {}, "Matrices A, B, C, D"), h("div", { class: "matrix-tables" }, table("A", A, states, states), table("B", B, states, u), table("C", C, y, states), table("D", D, y, u)))];
  }
  return analysis;
}
