/** Low-order models of the plant over its true step response, and what a first- or second-order plant is like. */

/** @import {ApproximateAnswer, LowOrderModel} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {AnalysesView, State, System, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP, CHARACTER_FIELDS, MEANING } from "../../core/explain.js";
import { formatFixed, sentence } from "../../core/format.js";
import { formatShort } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { captioned, headRow, part } from "../../components/facts.js";
import { showMath } from "../../components/mathml.js";
import "../../components/segmented-control.js";
import { toast } from "../../components/status-toast.js";
import { termHead, valueCell } from "../../components/value-cell.js";
import { createFigure } from "../../plots/figure.js";
import { lowOrderPlot } from "../../plots/low_order.js";
import { SIGNALS } from "../../plots/signals.js";

/** @type {Record<string, string>} */
const CLASSES = {
  stable: "It goes to its final value without turning back.",
  overdamped: "Two real poles: no overshoot, slower than at ζ = 1.",
  "critically damped": "Two equal real poles: the fastest response without overshoot.",
  underdamped: "A complex pair: it overshoots, oscillates and settles.",
  undamped: "A pair on the imaginary axis: it oscillates for ever.",
  integrating: "A pole at the origin: a constant input makes it grow for ever.",
  unstable: "A pole in the right half plane: it runs away.",
};

/** @param {State} state */
function requestOf({ plant }) {
  return { plant, points: 400, arrays: "f4" };
}

/** @param {LowOrderModel} model */
function nameOf({ method, name }) {
  return SIGNALS[method]?.label ?? name;
}

/** @param {LowOrderModel} model @returns {System | null} */
function asPlant({ type, K, tau, zeta, theta }) {
  if (K === null || tau === null || theta === null) return null;
  if (type === "FOPDT") return { type: "fopdt", K, tau, theta };
  return zeta === null ? null : { type: "sopdt", K, tau, zeta, theta };
}

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} api
 * @param {{plantGiven?: boolean}} [options]  on the bench of a lab the plant is not to be changed
 * @returns {() => void}
 */
export function mount(host, store, api, { plantGiven = false } = {}) {
  const unit = store.answers.time_unit;
  const shown = () => store.get().view.analyses.model_type;
  const type = h("segmented-control", { label: "Models of", class: "small" });
  type.options = [
    { value: "FOPDT", label: "First order", title: "K e^(−θs)/(τs + 1), also called FOPTD" },
    { value: "SOPDT", label: "Second order", title: "K e^(−θs)/(τ²s² + 2ζτs + 1)" },
  ];
  type.addEventListener("value-change", () => store.setAnalyses({ model_type: /** @type {AnalysesView["model_type"]} */ (type.value) }));
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<ApproximateAnswer>} */
  let analysis;

  /** @param {LowOrderModel} model */
  function use(model) {
    const plant = asPlant(model);
    if (!plant) return;
    store.set({ plant, horizon: null });
    toast().say(`The plant is now its model by ${model.name}.`, { action: { label: "Undo", run: () => store.undo() } });
  }

  /** @param {LowOrderModel} model */
  function row(model) {
    const values = shown() === "FOPDT" ? [model.K, model.tau, model.theta] : [model.K, model.tau, model.zeta, model.theta];
    const formula = h("span", {});
    showMath(formula, model.mathml);
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, h("span", { title: model.source }, nameOf(model))),
      h("td", {}, formula),
      ...values.map((value) => h("td", {}, formatShort(value))),
      h("td", {}, `${formatFixed(model.max_deviation_pct, 1)}\u202f%`),
      plantGiven ? null : h("td", {}, h("button", { type: "button", class: "button use", "aria-label": `Use the ${model.type} model by ${model.name} as the plant`, onclick: () => use(model) }, "Use")),
    );
  }

  function render() {
    const answer = /** @type {ApproximateAnswer} */ (analysis.answer);
    type.value = shown();
    const header = ["Method", "Model", "K", `τ [${unit}]`, ...(shown() === "FOPDT" ? [] : ["ζ"]), `θ [${unit}]`, "Largest deviation", ...(plantGiven ? [] : [""])];
    const caption = `${shown() === "FOPDT" ? "First" : "Second"}-order models with dead time; deviation from the true step response, in per cent of K`;
    const models = answer.models.filter((model) => model.type === shown());
    const table = captioned(
      caption,
      h("table", { class: "values models" }, headRow(header), h("tbody", {}, ...models.filter(({ valid }) => valid).map(row))),
    );
    const refused = models.filter(({ valid }) => !valid).map((model) => h("p", { class: "finding" }, h("strong", {}, `No ${nameOf(model)}: `), sentence(model.reason)));
    words.replaceChildren(part("Models", ...(answer.reason ? [h("p", { class: "finding" }, sentence(answer.reason))] : [table, ...refused])), character(answer, unit, plantGiven));
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "low_order",
      title: "Low order",
      help: ANALYSIS_HELP["low_order"] ?? "",
      controls: [type],
      form: [],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify(store.get().plant),
      render,
      draw: (theme, held) => (analysis?.answer ? lowOrderPlot({ answer: analysis.answer, type: shown(), timeUnit: unit }, theme, held) : null),
      legend() {
        const models = (analysis?.answer?.models ?? []).filter((model) => model.type === shown() && model.y).map(({ method }) => method);
        return ["y", ...models].map((name) => {
          const { label, name: words_, dash } = /** @type {import("../../plots/signals.js").Signal} */ (SIGNALS[name]);
          return name === "y" ? { signal: name, label: "plant", name: "true step response", dash } : { signal: name, label, name: words_, dash };
        });
      },
      table: () => (analysis?.answer ? tableOf(analysis.answer, shown(), unit) : null),
      describe: () => `Step response of the plant and of its ${shown()} models.`,
    },
    (onChange) => [(analysis = createAnalysis(store, { request: requestOf, send: (request) => api.analyse("approximate", request) }, onChange))],
  );
  type.value = shown();
  const stop = store.subscribe((_, { view }) => {
    if (view) panel.redraw();
  });
  return () => {
    stop();
    panel.dispose();
  };
}

/** @param {ApproximateAnswer} answer @param {string} unit @param {boolean} plantGiven */
function character({ character: found, plant: { order } }, unit, plantGiven) {
  if (!found) {
    const zero = order === 1 || order === 2;
    const why = zero ? "The plant is zero: it has none of them." : `This plant has order ${order}.${plantGiven ? "" : " Use one of the models as the plant to read them."}`;
    return part("Character", h("p", { class: "finding" }, `Time constant, damping, overshoot and period are those of a system of first or second order. ${why}`));
  }
  const rows = CHARACTER_FIELDS.filter((field) => order === 2 || ["K", "tau", "t_63", "initial_slope"].includes(field)).map((field) => {
    const cell = valueCell();
    const { decimals, unit: of = "" } = MEANING[field] ?? {};
    const value = found[field] ?? null;
    cell.show(decimals === undefined || value === null ? formatShort(value) : formatFixed(value, decimals), found.reasons[field] ?? null);
    return h("tr", {}, termHead(field), cell.root, h("td", { class: "unit" }, of.replace("time", unit)));
  });
  return part(
    "Character",
    h("p", { class: "finding" }, h("strong", {}, `${order === 1 ? "First" : "Second"} order, ${found.classification}. `), CLASSES[found.classification] ?? ""),
    h("table", { class: "numbers" }, h("tbody", {}, ...rows)),
  );
}

/** @param {ApproximateAnswer} answer @param {string} type @param {string} unit @returns {Table | null} */
function tableOf({ t, y, models }, type, unit) {
  if (!t || !y) return null;
  const drawn = models.filter((model) => model.type === type && model.y);
  return { header: [`t [${unit}]`, "plant", ...drawn.map(({ method }) => method)], rows: Array.from(t, (time, i) => [time, y[i] ?? null, ...drawn.map((model) => model.y?.[i] ?? null)]) };
}
