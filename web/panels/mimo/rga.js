/** Relative gains: the matrix in colours and words, the pairing to prefer and why, and both over frequency. */

/** @import {Api} from "../../core/api.js" */
/** @import {MimoStore} from "../../core/mimo/mimo.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { formatNumber, greek, sentence } from "../../core/format.js";
import { pairedRequest } from "../../core/mimo/mimo.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { valueTable, yesNo } from "../../components/facts.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { curvesPlot, magnitude } from "../../plots/mimo/frequency.js";

/** Pairings that are listed; five loops have 120. */
const LISTED = 6;
const PAIRS = ["case_1", "case_2", "case_3", "case_4", "case_5"];

/** What a relative gain means, in a word and a class. @param {number} value @returns {[string, string]} */
function meaning(value) {
  if (value < -1e-9) return ["bad", "sign turns"];
  if (value < 0.5) return ["weak", value < 1e-9 ? "no effect" : "weak"];
  if (value < 0.67) return ["fair", "shared"];
  if (value <= 1.5) return ["good", "good"];
  return value <= 5 ? ["fair", "held back"] : ["bad", "very sensitive"];
}

/** @param {HTMLElement} host @param {MimoStore} store @param {Api} api @param {{onAnswer: (answer: any) => void}} options */
export function mount(host, store, api, { onAnswer }) {
  let view = "rga";
  const chosen = h("segmented-control", { label: "Over frequency" });
  chosen.options = [
    { value: "rga", label: "relative gains" },
    { value: "sigma", label: "singular values" },
    { value: "gamma", label: "condition number" },
    { value: "number", label: "RGA number" },
  ];
  chosen.value = view;
  const matrix = h("div", { class: "mimo-rga" });
  const advice = h("div", { class: "mimo-advice" });
  const list = h("div", {});
  /** @type {import("../../core/workbench/analysis.js").Analysis<any> | null} */
  let analysis = null;

  function drawMatrix() {
    const { rga, inputs, outputs, reasons } = analysis?.answer ?? {};
    if (!rga) {
      matrix.replaceChildren(h("p", { class: "finding warn" }, sentence(reasons?.rga)));
      return;
    }
    const { pairing } = store.get();
    const cell = (/** @type {number} */ value, /** @type {boolean} */ paired) => {
      const [kind, word] = meaning(value);
      return h("td", { class: `mimo-cell ${kind}${paired ? " paired" : ""}` }, h("b", {}, formatNumber(value)), h("small", {}, word), paired ? h("span", { class: "visually-hidden" }, ", paired now") : null);
    };
    const head = h("tr", {}, h("td"), ...inputs.map((/** @type {any} */ { name, meaning: what }) => h("th", { scope: "col", title: what }, name)));
    const rows = rga.map((/** @type {number[]} */ row, /** @type {number} */ i) => h("tr", {}, h("th", { scope: "row", title: outputs[i].meaning }, outputs[i].name), ...row.map((value, j) => cell(value, pairing[i] === j))));
    matrix.replaceChildren(h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Relative gains at rest" }, h("table", { class: "mimo-matrix" }, h("caption", {}, "λ at rest; paired: outlined"), h("thead", {}, head), h("tbody", {}, ...rows))));
  }

  function render() {
    const answer = analysis?.answer;
    if (!answer) return;
    drawMatrix();
    const { pairing, because, niederlinski, reasons } = answer;
    const now = store.get().pairing.map((j) => j + 1);
    const same = pairing && pairing.join() === now.join();
    advice.replaceChildren(
      h("p", { class: "finding" }, h("strong", {}, pairing ? (same ? "Well paired: " : "Better paired: ") : "No pairing is safe: "), `${greek(because)}.`),
      h("p", { class: "facts-line" }, h("span", {}, "Niederlinski index ", h("b", {}, formatNumber(niederlinski))), h("span", {}, "condition number ", h("b", {}, formatNumber(answer.condition_number)))),
      ...(niederlinski === null && reasons.niederlinski && pairing ? [h("p", { class: "field-hint" }, sentence(reasons.niederlinski))] : []),
      ...(pairing && !same ? [h("button", { type: "button", class: "button primary", onclick: () => store.set({ pairing: pairing.map((/** @type {number} */ j) => j - 1) }) }, "Pair as recommended")] : []),
    );
    const rows = answer.pairings.slice(0, LISTED).map((/** @type {any} */ each) => [
      each.pairing.map((/** @type {number} */ j, /** @type {number} */ i) => `y${i + 1}–u${j}`).join(", "),
      yesNo(each.acceptable, { yes: "fine", no: "avoid" }),
      formatNumber(each.niederlinski),
      formatNumber(each.rga_number),
      each.faults.length > 0 ? `${greek(each.faults[0])}.` : "",
    ]);
    const more = answer.pairings.length - rows.length;
    list.replaceChildren(
      h("details", { class: "more" }, h("summary", {}, `All pairings (${answer.pairings.length})`), valueTable(`The best first${more > 0 ? `; ${more} more are left out` : ""}. NI assumes: ${answer.assumptions}.`, ["pairs", "", "NI", "RGA number", "against it"], rows)),
    );
  }

  /** @returns {{curves: import("../../plots/mimo/frequency.js").Curve[], yTitle: string, logY: boolean}} */
  function curves() {
    const { frequency } = analysis?.answer ?? {};
    if (view === "sigma") return { curves: frequency.singular_values.map((/** @type {any} */ values, /** @type {number} */ i) => ({ name: `σ${i + 1}`, signal: PAIRS[i] ?? "P", values })), yTitle: "singular value", logY: true };
    if (view === "gamma") {
      const least = frequency.minimized_condition_number;
      return { curves: [...(frequency.condition_number ? [{ name: "condition number", signal: "case_1", values: frequency.condition_number }] : []), ...(least ? [{ name: "least over all units", signal: "case_2", values: least }] : [])], yTitle: "σ largest / smallest", logY: true };
    }
    if (view === "number") return { curves: frequency.rga_number ? [{ name: "RGA number of the pairing", signal: "case_1", values: frequency.rga_number }] : [], yTitle: "Σ |Λ − pairs|", logY: false };
    const { pairing } = store.get();
    const paired = (frequency.rga ?? []).map((/** @type {any[]} */ row, /** @type {number} */ i) => ({ name: `|λ${i + 1}${(pairing[i] ?? i) + 1}|`, signal: PAIRS[i] ?? "P", values: magnitude(row[pairing[i] ?? i]) }));
    // Two loops have the same relative gain on both pairs.
    return { curves: paired.length === 2 ? paired.slice(0, 1) : paired, yTitle: "|λ| of the pairs", logY: false };
  }

  const { redraw } = mountAnalysisPanel(
    host,
    /** @type {any} */ (store),
    {
      id: "mimo-rga",
      title: "Relative gains",
      help: "λ compares what an input does to an output with the other loops open and with them closed: 1 is no interaction, negative means that the sign of the gain turns when the others close. Pair on positive values near 1. Large values mean a process that is hard to control in some direction.",
      form: [chosen],
      words: [matrix, advice, list],
      figure: createFigure,
      subject: () => `${view} ${JSON.stringify(pairedRequest(store.get()))}`,
      render,
      draw(theme, held) {
        const answer = analysis?.answer;
        if (!answer) return null;
        const { curves: shown, yTitle, logY } = curves();
        if (shown.length === 0) return null;
        const unit = `rad/${answer.time_unit}`;
        return curvesPlot({ x: answer.frequency.omega, curves: shown, xTitle: `ω [${unit}]`, yTitle, log: true, logY, unit, ...(view === "rga" ? { show: [0, 1] } : {}) }, theme, held);
      },
      table() {
        const answer = analysis?.answer;
        if (!answer) return null;
        const { curves: shown } = curves();
        return { header: [`omega [rad/${answer.time_unit}]`, ...shown.map(({ name }) => name)], rows: Array.from(answer.frequency.omega, (/** @type {number} */ omega, k) => [omega, ...shown.map(({ values }) => values[k] ?? null)]) };
      },
      describe() {
        const { curves: shown } = curves();
        return `Over frequency: ${shown.map(({ name, values }) => `${name} from ${formatNumber(values[0])} to ${formatNumber(values[values.length - 1])}`).join(", ")}.`;
      },
      legend: () => curves().curves.map(({ name, signal }, i) => ({ signal, label: name, name, dash: i === 0 ? "dash" : "dot" })),
    },
    (onChange) => {
      analysis = createAnalysis(
        /** @type {any} */ (store),
        { request: () => pairedRequest(store.get()), send: (/** @type {object} */ request) => api.analyse("mimo/rga", request) },
        () => {
          if (analysis?.answer && !analysis.error) onAnswer(analysis.answer);
          onChange();
        },
      );
      return [analysis];
    },
  );
  chosen.addEventListener("value-change", () => {
    view = chosen.value;
    redraw();
  });
}
