/** The balance of one state: what raises it against what lowers it, the other states at rest. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */

import { usualWindow } from "../../core/plant/bench.js";
import { sentence } from "../../core/format.js";
import { h } from "../../components/dom.js";
import { choice, fieldRow, number } from "../../components/form-parts.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";
import { balancePlot } from "../../plots/plant/balance.js";
import { createFigure } from "../../plots/figure.js";

const SIGNALS = ["u", "y", "d", "y_m"];

/** @param {HTMLElement} host @param {PlantBench} bench @param {Api} api */
export function mount(host, bench, api) {
  const again = () => analysis.again();
  const { states } = bench.model;
  // A temperature is what most balances are about.
  const usual = states.find(({ unit }) => unit === "K" || unit === "°C") ?? states[0];
  const state = choice("Over", states.map(({ name, meaning }) => ({ value: name, label: meaning ? `${name}, ${meaning}` : name })), () => {
    shape();
    again();
  });
  state.value = usual?.name ?? "";
  const low = number("From", { value: null, optional: true }, again);
  const high = number("To", { value: null, optional: true }, again);
  shape();

  function shape() {
    const window = usualWindow(bench.answer, state.value);
    low.value = window.low;
    high.value = window.high;
  }

  const analysis = mountPlantAnalysis(host, bench, {
    id: "plant-balance",
    title: "Balance",
    help: "The other states are at rest for each value of this one. Where what is generated crosses what is removed, the plant rests; it is stable where removal rises more steeply. Without such curves the rate of change itself is drawn: it rests where that is zero.",
    action: "Draw the balance",
    figure: createFigure,
    form: [fieldRow(state.root, low, high)],
    send: (request) => api.workOut(bench.model.id, "balance", request),
    request: () => ({ state: state.value, ...(low.value === null ? {} : { low: low.value }), ...(high.value === null ? {} : { high: high.value }) }),
    draw(answer, theme, held) {
      const curves = curvesOf(answer);
      return balancePlot({ ...curves, steady: steadyOf(answer, curves), state: answer.state.name, stateUnit: answer.state.unit === "-" ? "" : answer.state.unit, low: answer.state.low, high: answer.state.high }, theme, held);
    },
    words: ({ remark }) => (remark ? [h("p", { class: "field-hint" }, sentence(remark))] : []),
    table(answer) {
      const { values, curves } = curvesOf(answer);
      return { header: [answer.state.name, ...curves.map(({ name }) => name)], rows: values.map((value, i) => [value].concat(curves.map((curve) => curve.values[i] ?? null))).filter(([value]) => value !== null) };
    },
    describe: (answer) => `${curvesOf(answer).curves.map(({ name }) => name).join(" and ")} over ${answer.state.name}; they meet at ${answer.steady_states.length} steady states.`,
    legend: (answer) => curvesOf(answer).curves.map(({ name }, i) => ({ signal: SIGNALS[i % SIGNALS.length] ?? "y", label: name, name: answer.curves.find((/** @type {any} */ each) => each.name === name)?.meaning ?? "rate of change", dash: i === 1 ? "dash" : "solid" })),
  });

  /** Branches one after the other, with a gap between. @param {any} answer @returns {{values: (number | null)[], curves: {name: string, values: (number | null)[]}[], unit: string}} */
  function curvesOf({ branches, curves, state: over, rate_unit: rate }) {
    const chain = (/** @type {(branch: any) => number[]} */ of) => branches.flatMap((/** @type {any} */ branch) => [...of(branch), null]);
    const values = chain((branch) => branch.values);
    if (curves.length === 0) return { values, curves: [{ name: `d${over.name}/dt`, values: chain((branch) => branch.rate) }], unit: rate };
    return { values, curves: curves.map((/** @type {any} */ { name }) => ({ name, values: chain((branch) => branch.curves[name]) })), unit: curves[0].unit };
  }

  /** @param {any} answer @param {ReturnType<typeof curvesOf>} drawn */
  function steadyOf({ steady_states: steady, curves, state: over }, { curves: [first] }) {
    return steady.map((/** @type {any} */ { x, variables, verdict }) => ({ x: x[over.name], y: curves.length === 0 ? 0 : (variables[first?.name ?? ""] ?? 0), stable: verdict === "stable" }));
  }
  return analysis;
}
