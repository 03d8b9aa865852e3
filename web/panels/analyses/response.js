/** The answer of plant, open loop or closed loop to any input, and what it is the sum of. */

/** @import {ResponseAnswer} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {ResponseView, State, Table} from "../../core/types.js" */

import { MOST_SLICES } from "../../core/workbench/analyses.js";
import { createAnalysis } from "../../core/workbench/analysis.js";
import { RESPONSE_EXAMPLES } from "../../core/examples.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { INPUTS, isStaircase } from "../../core/inputs.js";
import { loopOf } from "../../core/workbench/loop.js";
import { formatShort } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h, setText } from "../../components/dom.js";
import { formulaBlock } from "../../components/facts.js";
import { icon } from "../../components/icons.js";
import { createInputForm } from "../../components/input-form.js";
import { createListField } from "../../components/list-field.js";
import { attachMenu } from "../../components/menu.js";
import "../../components/number-field.js";
import "../../components/segmented-control.js";
import { createSelectField } from "../../components/select-field.js";
import { toast } from "../../components/status-toast.js";
import { createFigure } from "../../plots/figure.js";
import { responsePlot, termsOf } from "../../plots/response.js";
import { SIGNALS } from "../../plots/signals.js";

const POINTS = 601;
/** What each part of the loop is called in a formula. */
const SUBJECT = { plant: "P(s)", open_loop: "L(s) = P(s) C(s)", closed_loop: "T(s) = L(s)/(1 + L(s))" };

/** @param {State} state */
function requestOf(state) {
  const { of, input, initial, sum, slices } = state.view.analyses.response;
  const subject = of === "plant" ? { system: state.plant } : { loop: loopOf(state), of };
  return { ...subject, input, initial, want: sum && !whyNoSum(state.view.analyses.response) ? [sum] : [], slices, points: POINTS, arrays: "f4" };
}

/** @param {ResponseView} view @returns {string | null} why there is no such sum, and what to do */
function whyNoSum({ input, sum }) {
  if (sum === "superposition" && !isStaircase(input)) return "Only a staircase is a sum of steps: choose a step, a pulse or held samples to see the terms.";
  if (sum === "convolution" && input.type === "impulse") return "The answer to an impulse is the impulse response itself: choose another input to see the sum.";
  return null;
}

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} api
 * @param {{plantGiven?: boolean}} [options]  on the bench of a lab the plant is not to be changed
 * @returns {() => void}
 */
export function mount(host, store, api, { plantGiven = false } = {}) {
  const view = () => store.get().view.analyses.response;
  /** @param {Partial<ResponseView>} patch */
  const change = (patch) => store.setAnalyses({ response: { ...view(), ...patch } });
  const unit = store.answers.time_unit;

  const of = h("segmented-control", { label: "Response of", class: "small" });
  of.options = [
    { value: "plant", label: "Plant", title: "From u to y, without feedback" },
    { value: "open_loop", label: "Open loop", title: "L = P C" },
    { value: "closed_loop", label: "Closed loop", title: "T = L/(1 + L), from the setpoint to y" },
  ];
  of.addEventListener("value-change", () => change({ of: /** @type {ResponseView["of"]} */ (of.value) }));

  const inputForm = createInputForm({ known: INPUTS, timeUnit: unit, onInput: (input) => input && change({ input }) });
  const from = createSelectField({
    label: "Starts",
    groups: [{ label: null, choices: [{ value: "rest", label: "At rest" }, { value: "y", label: "From y, y′, y″ …" }, { value: "x", label: "From the state x" }] }],
    onChoice(kind) {
      const order = Math.max(1, analysis?.answer?.system.order ?? 1);
      const first = [1, ...Array(order - 1).fill(0)];
      change({ initial: kind === "y" ? { y: first } : kind === "x" ? { x: first } : null });
    },
  });
  const values = createListField({ label: "Just before t = 0", onValues: (list) => change({ initial: view().initial?.x ? { x: list } : { y: list } }) });
  const sum = h("segmented-control", { label: "Show y as", class: "small" });
  sum.options = [
    { value: "", label: "y alone" },
    { value: "superposition", label: "Sum of steps", title: "Superposition: each step of the input answered on its own" },
    { value: "convolution", label: "Convolution", title: "Each slice of the input answered as an impulse" },
  ];
  sum.addEventListener("value-change", () => change({ sum: /** @type {ResponseView["sum"]} */ (sum.value || null) }));
  const slices = h("number-field", { label: "Slices", min: 1, max: MOST_SLICES });
  slices.addEventListener("value-change", (event) => change({ slices: Math.round(/** @type {CustomEvent<{value: number}>} */ (event).detail.value) }));
  const examples = h("button", { type: "button", class: "button" }, "Examples", icon("chevron"));
  const examplesPlace = h("span", { class: "menu-holder" }, examples);
  attachMenu(
    examples,
    RESPONSE_EXAMPLES.map(({ name, teaches, plant, response }) => ({
      label: name,
      detail: teaches,
      run() {
        store.set({ plant, horizon: null });
        change({ of: "plant", initial: null, sum: null, ...response });
        toast().say(`${name}: plant and input are set.`, { action: { label: "Undo plant", run: () => store.undo() } });
      },
    })),
  );

  const formula = h("div");
  const ends = h("p", { class: "finding" });
  const cut = h("p", { class: "finding warn" });
  const impulses = h("p", { class: "finding" });
  const adds = h("p", { class: "finding" });

  /** @type {import("../../core/workbench/analysis.js").Analysis<ResponseAnswer>} */
  let analysis;

  function showForm() {
    const { of: subject, input, initial, sum: shown, slices: count } = view();
    of.value = subject;
    inputForm.show(input);
    from.show(initial?.x ? "x" : initial?.y ? "y" : "rest");
    values.root.hidden = initial === null;
    values.show(initial?.x ?? initial?.y ?? []);
    sum.value = shown ?? "";
    slices.hidden = shown !== "convolution";
    slices.value = count;
  }

  function render() {
    const answer = /** @type {ResponseAnswer} */ (analysis.answer);
    formula.replaceChildren(formulaBlock(SUBJECT[view().of], answer.system));
    const { final_value, reasons, truncated_at, truncated_reason, superposition, convolution } = answer;
    setText(ends, final_value === null ? `No final value. ${sentence(reasons["final_value"])}` : `y comes to rest at ${formatShort(final_value, 5)}.`);
    setText(cut, truncated_at === null ? "" : `Cut off at t = ${formatWithUnit(truncated_at, unit)}: ${truncated_reason}.`);
    setText(impulses, answer.impulses.map(({ t, area }) => `An impulse of area ${formatShort(area)} passes straight to y at t = ${formatShort(t)}; no sample can show it.`).join(" "));
    const { terms } = termsOf(answer);
    const gap = superposition?.error ?? convolution?.error ?? 0;
    const what = superposition
      ? `${terms.length === 1 ? "One term adds" : `${terms.length} terms add`} up to y: their sum and the answer to the whole input differ by ${gap === 0 ? "nothing" : formatNumber(gap, 2)}${gap === 0 ? "" : " of the largest term"}.`
      : convolution
        ? `${convolution.weights.length} slices of u, each answered as an impulse: their sum is off by at most ${formatNumber(gap, 2)}; more slices bring it nearer. From rest: an initial state adds its own answer.`
        : (whyNoSum(view()) ?? "");
    setText(adds, what);
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "response",
      title: "Response",
      help: ANALYSIS_HELP["response"] ?? "",
      controls: [of],
      form: [inputForm.root, h("div", { class: "form-fields" }, from.root, values.root), h("div", { class: "form-fields" }, sum, slices, plantGiven ? null : examplesPlace)],
      words: [formula, ends, cut, impulses, adds],
      figure: createFigure,
      subject: () => JSON.stringify([store.get().plant, view()]),
      render,
      draw: (theme, held) => (analysis?.answer ? responsePlot({ answer: analysis.answer, staircase: isStaircase(view().input), timeUnit: unit }, theme, held) : null),
      legend() {
        const { superposition = null, convolution = null } = analysis?.answer ?? {};
        const names = superposition || convolution ? ["u", "y", "term", "sum"] : ["u", "y"];
        return names.map((name) => {
          const { label, name: words, dash } = /** @type {import("../../plots/signals.js").Signal} */ (SIGNALS[name]);
          return { signal: name, label, name: name === "u" ? "input" : name === "y" ? "answer" : words, dash };
        });
      },
      table: () => (analysis?.answer ? tableOf(analysis.answer, unit) : null),
      describe: () => `Response to ${INPUTS[view().input.type]?.label.toLowerCase()}: ${ends.textContent} ${cut.textContent}`,
    },
    (onChange) => [(analysis = createAnalysis(store, { request: requestOf, send: (request) => api.analyse("response", request) }, onChange))],
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

/** @param {ResponseAnswer} answer @param {string} unit @returns {Table} */
function tableOf(answer, unit) {
  const { terms, total } = termsOf(answer);
  return {
    header: [`t [${unit}]`, "u", "y", ...terms.map((_, k) => `term ${k + 1}`), ...(total ? ["sum"] : [])],
    rows: Array.from(answer.y, (y, i) => [answer.t[i] ?? null, answer.u[i] ?? null, y, ...terms.map((term) => term[i] ?? null), ...(total ? [total[i] ?? null] : [])]),
  };
}
