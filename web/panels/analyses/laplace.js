/** Partial fractions, y(t), the two limit theorems, and linear differential equations by transform. */

/** @import {LaplaceAnswer} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {AnalysesView, LinearOde, State, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatNumber, sentence, UNDEFINED } from "../../core/format.js";
import { TRANSFORMS } from "../../core/inputs.js";
import { formatComplex, formatShort, rootsText } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { formulaBlock, part, valueTable } from "../../components/facts.js";
import { createInputForm } from "../../components/input-form.js";
import { createListField } from "../../components/list-field.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { laplacePlot } from "../../plots/laplace.js";

/** y″ + 3y′ + 2y = u from y(0) = 1. @type {LinearOde} */
const FIRST_ODE = { a: [1, 3, 2], b: [1], initial: [1, 0] };

/** @param {State} state */
function requestOf({ plant, view }) {
  const { input, ode } = view.analyses.laplace;
  return { ...(ode ? { ode } : { system: plant }), input, points: 400, arrays: "f4" };
}

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  const view = () => store.get().view.analyses.laplace;
  /** @param {Partial<AnalysesView["laplace"]>} patch */
  const change = (patch) => store.setAnalyses({ laplace: { ...view(), ...patch } });

  const source = h("segmented-control", { label: "Transform of", class: "small" });
  source.options = [
    { value: "plant", label: "Plant", title: "Y(s) = P(s) U(s), from rest" },
    { value: "ode", label: "Equation", title: "A linear differential equation with initial values" },
  ];
  source.addEventListener("value-change", () => change({ ode: source.value === "ode" ? FIRST_ODE : null }));
  const inputForm = createInputForm({ known: TRANSFORMS, none: "None: G(s) itself", timeUnit: unit, onInput: (input) => change({ input }) });

  /** @param {Partial<LinearOde>} patch */
  const changeOde = (patch) => change({ ode: { ...(view().ode ?? FIRST_ODE), ...patch } });
  const leading = (/** @type {number[]} */ list) => (list[0] === 0 ? "The first coefficient must not be 0." : "");
  const a = createListField({ label: "Coefficients of y, highest derivative first", check: leading, onValues: (list) => changeOde({ a: list }) });
  const b = createListField({ label: "Coefficients of u", onValues: (list) => changeOde({ b: list }) });
  const initial = createListField({ label: "y(0), y′(0) …", optional: true, placeholder: "0", onValues: (list) => changeOde({ initial: list }) });
  const equation = h("p", { class: "equation" });
  const odeForm = h("div", { class: "form-fields ode-form" }, a.root, b.root, initial.root, equation);

  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<LaplaceAnswer>} */
  let analysis;

  function showForm() {
    const { input, ode } = view();
    source.value = ode ? "ode" : "plant";
    inputForm.show(input);
    odeForm.hidden = ode === null;
    if (!ode) return;
    a.show(ode.a);
    b.show(ode.b);
    initial.show(ode.initial);
    equation.textContent = `${side(ode.a, "y")} = ${side(ode.b, "u")}`;
  }

  /** @param {string} name @param {"initial_value" | "final_value"} which @param {LaplaceAnswer} answer */
  function theorem(name, which, answer) {
    const value = answer[which];
    const claimed = answer.formula[which];
    const because = value === null ? sentence(answer.reasons[which]) : which === "final_value" ? "Every pole of s Y(s) lies in the left half plane: the theorem holds." : "No impulse in y: the theorem holds.";
    const warn = value === null && claimed !== null ? ` The limit of s Y(s) would say ${formatShort(claimed)}: its condition fails, so it says nothing.` : "";
    return [name, value === null ? UNDEFINED : formatShort(value, 5), because + warn];
  }

  function render() {
    const answer = /** @type {LaplaceAnswer} */ (analysis.answer);
    const { accuracy } = answer;
    const rows = answer.partial_fractions.map(({ pole, power, coefficient }) => [formatComplex(pole), String(power), formatComplex(coefficient)]);
    const accurate = [
      accuracy.simulation_difference === null ? sentence(accuracy.simulation_reason) : `Formula and simulation differ by at most ${formatNumber(accuracy.simulation_difference, 2)} of the largest value.`,
      accuracy.cancelled.length > 0 ? `Hidden by zeros: the pole ${rootsText(accuracy.cancelled)}.` : "",
      accuracy.moved > 0 ? `Poles nearer than ${formatNumber(accuracy.moved, 2)} of their size were taken as one.` : "",
    ];
    words.replaceChildren(
      part(
        "Transform",
        formulaBlock("Y(s)", answer.transform),
        formulaBlock("Partial fractions", answer.expansion),
        valueTable(`Terms coefficient/(s − pole)^power${answer.theta > 0 ? `, all of them e^(−${formatShort(answer.theta)} s)` : ""}`, ["Pole", "Power", "Coefficient"], answer.direct !== 0 ? [...rows, ["impulse", "0", formatShort(answer.direct)]] : rows),
      ),
      part(
        "Inverse",
        formulaBlock("y(t)", answer),
        ...(answer.forced ? [formulaBlock("Forced, from rest", answer.forced), formulaBlock("Free, without input", answer.free)] : []),
        h("p", { class: "finding" }, accurate.filter(Boolean).join(" ")),
      ),
      part("Limits", valueTable("Initial- and final-value theorem", ["", "Value", "Condition"], [theorem("y(0+)", "initial_value", answer), theorem("y(∞)", "final_value", answer)])),
    );
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "laplace",
      title: "Laplace",
      help: ANALYSIS_HELP["laplace"] ?? "",
      controls: [source],
      form: [inputForm.root, odeForm],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify([store.get().plant, view()]),
      render,
      draw: (theme, held) => (analysis?.answer ? laplacePlot({ answer: analysis.answer, timeUnit: unit }, theme, held) : null),
      legend: () => [
        { signal: "y", label: "y(t)", name: "inverse transform" },
        { signal: "simulated", label: "simulated", name: "simulation of the same transform", glyph: "○" },
      ],
      note() {
        const { truncated_at = null, truncated_reason = null } = analysis?.answer?.response ?? {};
        return truncated_at === null ? "" : `Cut off at t = ${formatShort(truncated_at)}: ${truncated_reason}.`;
      },
      table: () => (analysis?.answer ? tableOf(analysis.answer, unit) : null),
      describe: () => `y(t) = ${analysis?.answer?.text ?? ""}`,
    },
    (onChange) => [(analysis = createAnalysis(store, { request: requestOf, send: (request) => api.analyse("laplace", request) }, onChange))],
  );
  const stop = store.subscribe((_, { view: changed }) => {
    if (changed) showForm();
  });
  showForm();
  return () => {
    stop();
    panel.dispose();
  };
}

/** One side of the equation: "y″ + 3 y′ + 2 y". @param {number[]} coefficients @param {string} name */
function side(coefficients, name) {
  const marks = ["", "′", "″", "‴"];
  const terms = coefficients.flatMap((c, i) => {
    if (c === 0) return [];
    const derivative = coefficients.length - 1 - i;
    const size = Math.abs(c) === 1 ? "" : `${formatShort(Math.abs(c))} `;
    return [`${c < 0 ? "− " : "+ "}${size}${name}${marks[derivative] ?? `⁽${derivative}⁾`}`];
  });
  return terms.join(" ").replace(/^\+ /, "") || "0";
}

/** @param {LaplaceAnswer} answer @param {string} unit @returns {Table} */
function tableOf({ response: { t, y, simulated_t, simulated_y } }, unit) {
  return { header: [`t [${unit}]`, "y", `t simulated [${unit}]`, "y simulated"], rows: Array.from(t, (time, i) => [time, y[i] ?? null, simulated_t[i] ?? null, simulated_y[i] ?? null]) };
}
