/** The Routh array with its special cases, the stable gains, and the stable settings of a PI controller. */

/** @import {GainRange, PiCut, RouthAnswer, RouthRow} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {State, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { sentence, UNDEFINED } from "../../core/format.js";
import { loopOf } from "../../core/workbench/loop.js";
import { formatShort } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { captioned, part, valueTable, verdictRow } from "../../components/facts.js";
import { createListField } from "../../components/list-field.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { cutsAround, piRegionPlot } from "../../plots/pi_region.js";

/** A zero first entry in the third row: the case that needs a word. */
const FIRST_POLYNOMIAL = [1, 1, 2, 2, 3, 5];

/** @param {State} state */
function arrayRequest(state) {
  const { polynomial } = state.view.analyses;
  return polynomial ? { polynomial } : { loop: loopOf(state) };
}

/** The region does not depend on the gain, nor on the integral time within a decade: it is asked for only when they leave it. @param {State} state */
function regionRequest(state) {
  const { type, tau_I, action } = state.controller;
  if (type !== "PI" || state.view.analyses.polynomial) return null;
  return { loop: { plant: state.plant, controller: { type: "pid", Kc: 1, tau_I: 1, action } }, tau_I: cutsAround(tau_I) };
}

/** The ranges by the size of the gain: direct action has them mirrored. @param {PiCut[]} cuts @param {boolean} mirrored @returns {PiCut[]} */
function bySize(cuts, mirrored) {
  if (!mirrored) return cuts;
  const flip = (/** @type {number | null} */ K) => (K === null ? null : -K);
  return cuts.map(({ tau_I, gain_ranges, reason }) => {
    const below = gain_ranges.filter(({ low }) => low === null || low < 0);
    return { tau_I, reason, gain_ranges: below.map((range) => Object.assign({}, range, { low: Math.max(0, flip(range.high) ?? 0), high: flip(range.low) })) };
  });
}

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  const source = h("segmented-control", { label: "Polynomial of", class: "small" });
  source.options = [
    { value: "loop", label: "This loop", title: "The characteristic polynomial of plant and controller" },
    { value: "typed", label: "Polynomial", title: "Any polynomial in s" },
  ];
  source.addEventListener("value-change", () => store.setAnalyses({ polynomial: source.value === "typed" ? FIRST_POLYNOMIAL : null }));
  const typed = createListField({
    label: "Coefficients, highest power first",
    check: (list) => (list[0] === 0 ? "The first coefficient must not be 0." : list.length > 51 ? "At most 51 coefficients." : ""),
    onValues: (polynomial) => store.setAnalyses({ polynomial }),
  });

  const words = h("div", { class: "analysis-parts" });
  const hint = h("p", { class: "finding" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<RouthAnswer>} */
  let array;
  /** @type {import("../../core/workbench/analysis.js").Analysis<RouthAnswer>} */
  let region;

  function showForm() {
    const { polynomial } = store.get().view.analyses;
    source.value = polynomial ? "typed" : "loop";
    typed.root.hidden = polynomial === null;
    if (polynomial) typed.show(polynomial);
  }

  function render() {
    const answer = /** @type {RouthAnswer} */ (array.answer);
    const counts = valueTable(
      "Roots of the polynomial",
      ["Right half plane", "Imaginary axis", "Left half plane"],
      [[answer.rhp_roots, answer.imaginary_axis_roots, answer.lhp_roots].map((count) => (count === null ? UNDEFINED : String(count)))],
    );
    words.replaceChildren(
      part(
        "Routh array",
        h("p", { class: "finding" }, answer.polynomial_text ? h("span", { class: "polynomial" }, answer.polynomial_text.replaceAll("-", "−").replaceAll(/\^(\d+)/g, (_, power) => raised(power))) : sentence(answer.reasons["array"])),
        answer.array ? arrayTable(answer.array) : null,
        ...(answer.array ?? []).filter(({ note }) => note).map((row) => h("p", { class: "finding" }, h("strong", {}, `Row ${powerOf(row)}: `), sentence(row.note))),
      ),
      part("Verdict", h("div", { class: "table-scroll" }, h("table", { class: "values verdicts" }, h("tbody", {}, verdictRow("Stable", answer.stable, answer.because)))), counts),
      answer.gain_ranges || answer.gain ? part("Stable gains", ...gains(answer)) : "",
      hint,
    );
    const { controller, view } = store.get();
    hint.hidden = view.analyses.polynomial !== null || controller.type === "PI";
    hint.textContent = "Choose PI in the Controller card to see the stable region over gain and integral time.";
  }

  /** @param {RouthAnswer} answer */
  function gains({ gain, gain_ranges, reasons }) {
    const name = gain?.name ?? "K";
    const now = gain ? h("p", { class: "finding" }, `Now ${name} = ${formatShort(gain.value)}: ${gain.in_range ? "inside a stable range." : "outside every stable range."}`) : null;
    if (!gain_ranges?.length) return [h("p", { class: "finding" }, sentence(reasons["gain_ranges"] ?? "no gain stabilises the loop")), now];
    return [h("ul", { class: "gain-ranges" }, ...gain_ranges.map((range) => h("li", {}, h("strong", {}, rangeText(range, name)), h("span", {}, ` ${ends(range)}`)))), now];
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "routh",
      title: "Routh",
      help: ANALYSIS_HELP["routh"] ?? "",
      controls: [source],
      form: [typed.root],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify([store.get().plant, cutsAround(store.get().controller.tau_I)[0]]),
      live: true,
      awaited: () => regionRequest(store.get()) !== null && !region?.error,
      render,
      draw(theme, held) {
        const { controller } = store.get();
        const cuts = region?.answer?.pi_region?.cuts;
        if (!cuts || controller.type !== "PI" || store.get().view.analyses.polynomial) return null;
        return piRegionPlot({ cuts: bySize(cuts, controller.action === "direct"), Kc: controller.Kc, tau_I: controller.tau_I, timeUnit: unit }, theme, held);
      },
      legend: () => [
        { signal: "stable", label: "stable", name: "settings that make the loop stable", glyph: "■" },
        { signal: "pole", label: "now", name: "present setting", glyph: "■" },
      ],
      table: () => (array?.answer ? tableOf(array.answer, region?.answer ?? null) : null),
      describe: () => `Stable settings over gain and integral time. ${sentence(array?.answer?.because)}`,
    },
    (onChange) => {
      array = createAnalysis(store, { request: arrayRequest, send: (request) => api.analyse("routh", request) }, onChange);
      region = createAnalysis(store, { request: regionRequest, send: (request) => api.analyse("routh", request) }, onChange);
      return [array, region];
    },
  );
  const stop = store.subscribe((_, { view }) => {
    if (view) showForm();
  });
  showForm();
  return () => {
    stop();
    panel.dispose();
  };
}

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** @param {string} digits */
function raised(digits) {
  return [...digits].map((digit) => RAISED[Number(digit)]).join("");
}

/** @param {RouthRow} row */
function powerOf({ power }) {
  return power === 1 ? "s" : `s${raised(String(power))}`;
}

/** @param {RouthRow[]} rows */
function arrayTable(rows) {
  const width = Math.max(...rows.map(({ entries }) => entries.length));
  const minus = (/** @type {string} */ text) => text.replace("-", "−");
  let before = 0;
  const body = rows.map((row) => {
    const sign = Math.sign(row.entries[0] ?? 0);
    const changes = before !== 0 && sign !== 0 && sign !== before;
    before = sign || before;
    const cells = Array.from({ length: width }, (_, i) => h("td", { class: i === 0 ? "first-column" : "" }, minus(row.texts[i] ?? "")));
    const kind = { given: "", computed: "", multiplied: "times 1 − s²", auxiliary: "auxiliary" }[row.kind];
    return h("tr", { class: `routh-${row.kind}` }, h("th", { scope: "row" }, powerOf(row)), ...cells, h("td", { class: "routh-mark" }, [changes ? "sign change" : "", kind].filter(Boolean).join(", ")));
  });
  return captioned("The signs of the first column count", h("table", { class: "values routh-array" }, h("tbody", {}, ...body)));
}

/** @param {GainRange} range @param {string} name */
function rangeText({ low, high }, name) {
  if (low === null && high === null) return `every ${name}`;
  if (low === null) return `${name} < ${formatShort(high, 5)}`;
  return high === null ? `${name} > ${formatShort(low, 5)}` : `${formatShort(low, 5)} < ${name} < ${formatShort(high, 5)}`;
}

/** Why it ends where it ends. @param {GainRange} range */
function ends({ low, high, low_reason, high_reason }) {
  return [`from ${low === null ? "−∞" : formatShort(low, 5)}: ${low_reason}`, `to ${high === null ? "∞" : formatShort(high, 5)}: ${high_reason}`].map(sentence).join(" ");
}

/** @param {RouthAnswer} answer @param {RouthAnswer | null} region @returns {Table} */
function tableOf({ array }, region) {
  const cuts = region?.pi_region?.cuts;
  if (cuts) return { header: ["tau_I", "lowest Kc", "highest Kc"], rows: cuts.flatMap(({ tau_I, gain_ranges }) => gain_ranges.map(({ low, high }) => [tau_I, low, high])) };
  const columns = Array.from({ length: Math.max(0, ...(array ?? []).map(({ entries }) => entries.length)) }, (_, i) => i);
  return { header: ["row", ...columns.map((i) => `column ${i + 1}`)], rows: (array ?? []).map(({ label, entries }) => [label].concat(/** @type {any} */ (columns.map((i) => entries[i] ?? null)))) };
}
