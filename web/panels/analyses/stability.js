/** Notions of stability side by side, of the plant and of the closed loop, and what hides inside the loop. */

/** @import {StabilityAnswer} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {State, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatNumber, sentence } from "../../core/format.js";
import { loopOf } from "../../core/workbench/loop.js";
import { groupRoots, rootsText } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { part, valueTable, yesNo } from "../../components/facts.js";
import { createFigure } from "../../plots/figure.js";
import { polesPlot } from "../../plots/poles.js";
import { SIGNALS } from "../../plots/signals.js";

const GANG = /** @type {const} */ (["S", "PS", "CS", "T"]);

/** Matrices are looked at as they are: multiplied out, their Jordan structure would be lost. @param {State} state */
function plantRequest({ plant }) {
  if (plant.type !== "ss" || plant.A.length === 0) return { system: plant };
  const { A, B, C } = plant;
  return { A, B, C };
}

/** @param {State} state */
function loopRequest(state) {
  return { loop: loopOf(state) };
}

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<StabilityAnswer>} */
  let plant;
  /** @type {import("../../core/workbench/analysis.js").Analysis<StabilityAnswer>} */
  let loop;

  function render() {
    const open = /** @type {StabilityAnswer} */ (plant.answer);
    const closed = loop?.answer ?? null;
    words.replaceChildren(notions(open, closed), jordan(open), ...(closed?.internal ? [inside(closed.internal)] : []));
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "stability",
      title: "Stability",
      help: ANALYSIS_HELP["stability"] ?? "",
      form: [],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify(store.get().plant),
      render,
      draw: (theme, held) => (plant?.answer ? polesPlot({ plant: plant.answer.poles, loop: loop?.answer?.poles ?? [], complete: loop?.answer?.complete ?? true }, theme, held) : null),
      legend: () => [
        { signal: "r", label: "plant", name: "poles of the plant", glyph: "×" },
        { signal: "pole", label: "closed loop", name: "poles of the closed loop", glyph: "■" },
      ],
      note: () => (loop?.answer?.complete === false ? "Dead time makes infinitely many closed-loop poles; the rightmost are drawn." : ""),
      table: () => (plant?.answer ? tableOf(plant.answer, loop?.answer ?? null) : null),
      describe: () => `Poles of the plant: ${rootsText(plant?.answer?.poles ?? [])}; of the closed loop: ${rootsText(loop?.answer?.poles ?? [])}.`,
    },
    (onChange) => {
      plant = createAnalysis(store, { request: plantRequest, send: (request) => api.analyse("stability", request) }, onChange);
      loop = createAnalysis(store, { request: loopRequest, send: (request) => api.analyse("stability", request) }, onChange);
      return [plant, loop];
    },
  );
  return panel.dispose;
}

/** @param {StabilityAnswer} open @param {StabilityAnswer | null} closed */
function notions(open, closed) {
  const both = [open, closed];
  /** @param {string} name @param {(answer: StabilityAnswer) => boolean | null} holds */
  const row = (name, holds) => [name, ...both.map((answer) => (answer ? yesNo(holds(answer)) : ""))];
  return part(
    "Notions",
    valueTable("Which notion of stability holds", ["", "Plant", "Closed loop"], [
      row("Lyapunov stable", (answer) => answer.lyapunov_stable),
      row("Asymptotically stable", (answer) => answer.asymptotically_stable),
      // Neither good nor bad, so without their colours.
      ["Marginal", ...both.map((answer) => (answer ? (answer.verdict === "marginal" ? "yes" : "no") : ""))],
      row("BIBO stable", (answer) => answer.bibo?.stable ?? null),
    ]),
    h("p", { class: "finding" }, h("strong", {}, "Plant: "), sentence(open.because)),
    closed ? h("p", { class: "finding" }, h("strong", {}, "Closed loop: "), sentence(closed.because)) : null,
    open.bibo ? h("p", { class: "finding" }, h("strong", {}, "BIBO, plant: "), sentence(open.bibo.because)) : null,
    open.bibo && open.bibo.cancelled.length > 0 ? h("p", { class: "finding warn" }, `Input and output do not see the pole ${rootsText(open.bibo.cancelled)}.`) : null,
  );
}

/** @param {StabilityAnswer} open */
function jordan({ axis_modes }) {
  if (!axis_modes) return "";
  if (axis_modes.length === 0) return part("Imaginary axis", h("p", { class: "finding" }, "The plant has no eigenvalue on the imaginary axis: the signs of the real parts decide."));
  const rows = axis_modes.map((mode) => [
    rootsText([mode.eigenvalue]),
    String(mode.algebraic),
    String(mode.geometric),
    String(mode.largest_block),
    mode.geometric === mode.algebraic ? "bounded" : `grows like t${mode.largest_block > 2 ? `^${mode.largest_block - 1}` : ""}`,
  ]);
  const decided = axis_modes
    .filter(({ singular_values }) => singular_values.length > 0)
    .map(({ eigenvalue, singular_values, threshold }) => h("p", { class: "finding" }, `Singular values of A − λI at λ = ${rootsText([eigenvalue])}: ${singular_values.map((value) => formatNumber(value, 2)).join(", ")}; below ${formatNumber(threshold, 2)} they count as zero, and each zero is an eigenvector.`));
  return part("Imaginary axis", valueTable("Jordan structure of the plant's eigenvalues on the axis", ["Eigenvalue", "Multiplicity", "Eigenvectors", "Largest block", "State"], rows), ...decided);
}

/** @param {NonNullable<StabilityAnswer["internal"]>} internal */
function inside(internal) {
  const rows = GANG.map((name) => {
    const { poles, stable, complete, because } = internal[name];
    return [h("span", { title: SIGNALS[name]?.name ?? "" }, name), complete ? rootsText(poles) : `${rootsText(poles.slice(0, 6))} …`, yesNo(stable), sentence(because)];
  });
  const named = internal.cancellations.map(({ text, stable }) => h("li", { class: stable ? "" : "warn" }, sentence(text)));
  return part(
    "Inside the loop",
    valueTable("The gang of four after cancellation", ["", "Poles", "Stable", "Because"], rows),
    h("p", { class: "finding" }, h("strong", {}, internal.internally_stable ? "Internally stable. " : "Not internally stable. "), named.length > 0 ? "" : "Nothing cancels between plant and controller."),
    named.length > 0 ? h("ul", { class: "cancellations" }, ...named) : null,
  );
}

/** @param {StabilityAnswer} open @param {StabilityAnswer | null} closed @returns {Table} */
function tableOf(open, closed) {
  const rows = (/** @type {string} */ of, /** @type {StabilityAnswer["poles"]} */ poles) => groupRoots(poles).map(({ re, im, count }) => [of, re, im, count]);
  return { header: ["poles of", "Re", "±Im", "multiplicity"], rows: [...rows("plant", open.poles), ...rows("closed loop", closed?.poles ?? [])] };
}
