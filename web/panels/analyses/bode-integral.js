/** Bode's integral: the two areas under ln |S|, their sum in three pieces, and the theorem. */

/** @import {BodeIntegralAnswer} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {State, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatNumber, sentence } from "../../core/format.js";
import { loopOf } from "../../core/workbench/loop.js";
import { formatShort } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { part, valueTable } from "../../components/facts.js";
import { bodeIntegralPlot } from "../../plots/bode_integral.js";
import { createFigure } from "../../plots/figure.js";

const DIGITS = 6;
/** A difference below this is rounding. */
const ROUNDING = 1e-9;

/** @param {State} state */
function requestOf(state) {
  return { loop: loopOf(state), arrays: "f4" };
}

/** What the theorem says for this loop, term by term. @param {BodeIntegralAnswer} answer */
function theoremText({ unstable_poles, theta, limit_sL, theorem }) {
  const poles = unstable_poles.reduce((sum, [re]) => sum + re, 0);
  const terms = [
    poles > 0 ? `π · ${formatShort(poles)} for the unstable poles of L` : "",
    theta > 0 || !limit_sL ? "" : `${poles > 0 ? "less" : "minus"} (π/2) · ${formatShort(limit_sL)}, for s L → ${formatShort(limit_sL)} at high frequencies`,
  ].filter(Boolean);
  const why = theta > 0 ? "dead time, so that high frequencies add nothing" : "L falls off faster than 1/s";
  return `The theorem says ${formatNumber(theorem, DIGITS)}: ${terms.length > 0 ? terms.join(", ") : `no unstable pole, and ${why}`}.`;
}

/** @param {BodeIntegralAnswer} answer */
function lesson({ area_below, area_above, theorem }) {
  if (area_below === null || area_above === null) return "";
  const paid = (theorem ?? 0) > ROUNDING ? "More is paid than gained: that is the price of the unstable poles." : (theorem ?? 0) < -ROUNDING ? "Less is paid than gained, because L falls off only as 1/s; a little dead time or one more lag takes that away." : "What is gained below zero is paid back above, whatever the controller.";
  return `${paid} Raise the gain and watch both areas grow.`;
}

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<BodeIntegralAnswer>} */
  let analysis;

  function render() {
    const answer = /** @type {BodeIntegralAnswer} */ (analysis.answer);
    const { value, pieces, difference, area_below, area_above, reasons } = answer;
    if (value === null || pieces === null || difference === null) {
      words.replaceChildren(h("p", { class: "finding" }, h("strong", {}, "No integral. "), sentence(reasons["value"])));
      return;
    }
    const range = (/** @type {number} */ from, /** @type {number | null} */ to) => `${formatNumber(from)} … ${to === null ? "∞" : formatNumber(to)}`;
    const off = Math.abs(difference) < ROUNDING ? "They agree to rounding." : `They differ by ${formatNumber(Math.abs(difference), 2)}.`;
    words.replaceChildren(
      h("p", { class: "finding" }, h("strong", {}, `∫ ln |S| dω = ${formatNumber(Math.abs(value) < ROUNDING ? 0 : value, DIGITS)} rad/${unit}. `), `${theoremText(answer)} ${off}`),
      h("p", { class: "finding" }, lesson(answer)),
      part(
        "Areas",
        valueTable(`Up to ω = ${formatNumber(pieces[1]?.omega_to)}, where the tail begins`, ["", `Area [rad/${unit}]`], [
          ["Gained, below zero", formatNumber(area_below, DIGITS)],
          ["Paid, above zero", formatNumber(area_above, DIGITS)],
        ]),
      ),
      part(
        "The sum in three pieces",
        valueTable("A sum over 0.1 … 100 alone would miss the first and the last", [`ω [rad/${unit}]`, "Integral", "How"], [
          ...pieces.map(({ omega_from, omega_to, value: piece, how }) => [range(omega_from, omega_to), formatNumber(piece, DIGITS), sentence(how)]),
          ["Sum", formatNumber(Math.abs(value) < ROUNDING ? 0 : value, DIGITS), ""],
        ]),
      ),
    );
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "bode_integral",
      title: "Bode integral",
      help: ANALYSIS_HELP["bode_integral"] ?? "",
      form: [],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify(store.get().plant),
      render,
      draw: (theme, held) => (analysis?.answer ? bodeIntegralPlot({ answer: analysis.answer, timeUnit: unit }, theme, held) : null),
      legend: () => [
        { signal: "S", label: "ln |S|", name: "logarithm of the sensitivity", dash: "solid" },
        { signal: "stable", label: "gained", name: "area below zero: feedback helps", glyph: "▼" },
        { signal: "unstable", label: "paid", name: "area above zero: feedback hurts", glyph: "▲" },
      ],
      table: () => (analysis?.answer ? tableOf(analysis.answer, unit) : null),
      describe: () => `ln |S| over an even frequency axis. ${words.firstElementChild?.textContent ?? ""}`,
    },
    (onChange) => [(analysis = createAnalysis(store, { request: requestOf, send: (request) => api.analyse("bode-integral", request) }, onChange))],
  );
  return panel.dispose;
}

/** @param {BodeIntegralAnswer} answer @param {string} unit @returns {Table} */
function tableOf({ omega, ln_S }, unit) {
  return { header: [`omega [rad/${unit}]`, "ln |S|"], rows: Array.from(omega, (w, i) => [w, ln_S[i] ?? null]) };
}
