/** The plant as state equations: modes, controllability, observability, Gramians, and what is left when hidden modes go. */

/** @import {ChannelAnswer, RankAnswer, StateSpaceAnswer} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {State, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatNumber, sentence } from "../../core/format.js";
import { groupBy } from "../../core/groups.js";
import { formatComplex, formatShort, rootsText } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { openCard } from "../../components/card.js";
import { h, setText } from "../../components/dom.js";
import { formulaBlock, matrixBlock, part, valueTable, yesNo } from "../../components/facts.js";
import "../../components/number-field.js";

const ROUNDING = 1e-14;

/** @param {State} state */
function requestOf({ plant, view }) {
  return { system: plant, cancel_tolerance: view.analyses.cancel_tolerance };
}

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} api
 * @param {{plantGiven?: boolean}} [options]  on the bench of a lab the plant is not to be changed
 * @returns {() => void}
 */
export function mount(host, store, api, { plantGiven = false } = {}) {
  const { answers } = store;
  const tolerance = h("number-field", { label: "Zeros cancel poles up to a distance of", min: 0, max: 0.1 });
  tolerance.addEventListener("value-change", (event) => store.setAnalyses({ cancel_tolerance: /** @type {CustomEvent<{value: number}>} */ (event).detail.value }));
  const edit = h("button", { type: "button", class: "button" });
  edit.addEventListener("click", () => {
    const found = analysis.answer;
    if (store.get().plant.type !== "ss" && found) {
      const { A, B, C, D } = found;
      store.set({ plant: { type: "ss", A, B, C, D, theta: answers.plant?.theta ?? 0 } });
    }
    openCard("card-plant");
  });
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<StateSpaceAnswer>} */
  let analysis;

  function showForm() {
    tolerance.value = store.get().view.analyses.cancel_tolerance;
    setText(edit, store.get().plant.type === "ss" ? "Edit the matrices" : "Type matrices as the plant");
  }

  function render() {
    const found = /** @type {StateSpaceAnswer} */ (analysis.answer);
    const theta = answers.plant?.theta ?? 0;
    const [channel] = found.transfer_functions;
    words.replaceChildren(
      part(
        "State equations",
        h("p", { class: "finding" }, `${store.get().plant.type === "ss" ? "As typed." : "The plant as a cascade of first- and second-order sections."}${theta > 0 ? ` The dead time of ${formatShort(theta)} ${answers.time_unit} stands before u and is no state.` : ""}`),
        h("div", { class: "matrices" }, ...(/** @type {const} */ (["A", "B", "C", "D"])).map((name) => matrixBlock(name, found[name]))),
        h("p", { class: "finding" }, h("strong", {}, "Eigenvalues: "), `${rootsText(found.poles)}. `, h("strong", {}, `${found.stability.verdict}: `), sentence(found.stability.because)),
      ),
      rank("Controllability", "[B, AB, A²B, …]", found.controllability, found.stabilizable, "stabilizable"),
      rank("Observability", "[C; CA; CA²; …]", found.observability, found.detectable, "detectable"),
      modes(found),
      gramians(found),
      minimal(found, channel),
    );
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "state_space",
      title: "State space",
      help: ANALYSIS_HELP["state_space"] ?? "",
      form: [h("div", { class: "form-fields" }, plantGiven ? null : edit, tolerance)],
      words: [words],
      render,
      table: () => (analysis?.answer ? tableOf(analysis.answer) : null),
    },
    (onChange) => [(analysis = createAnalysis(store, { request: requestOf, send: (request) => api.analyse("state-space", request) }, onChange))],
  );
  const stop = store.subscribe((_, { moving }) => {
    if (!moving) showForm();
  });
  showForm();
  return () => {
    stop();
    panel.dispose();
  };
}

/** @param {string} title @param {string} name @param {RankAnswer} found @param {boolean} weak @param {string} weakName */
function rank(title, name, found, weak, weakName) {
  const least = found.tolerance * (found.singular_values[0] ?? 0);
  return part(
    title,
    matrixBlock(name, found.matrix),
    h("p", { class: "finding" }, h("strong", {}, `Rank ${found.rank} of ${found.singular_values.length}. `), found.full ? `No mode hides, so it is ${weakName} too.` : weak ? `A mode hides, but a stable one: ${weakName}.` : `An unstable mode hides: not ${weakName}.`),
    h("p", { class: "finding" }, `Singular values, scaled: ${found.singular_values.map((value) => formatNumber(value, 3)).join(", ") || "none"}; those below ${formatNumber(least, 2)} count as zero. ${sentence(found.reason)}`),
  );
}

/** @param {StateSpaceAnswer} found */
function modes({ modes: list, minimal: whole }) {
  // A repeated eigenvalue has one test and takes one row.
  const alike = groupBy(list, ({ pole, ...tested }) => JSON.stringify([formatComplex(pole), tested]));
  const rows = [...alike.values()].flatMap((group) =>
    group.slice(0, 1).map((mode) => [
      `${formatComplex(mode.pole)}${group.length > 1 ? ` (${group.length}×)` : ""}`,
      yesNo(mode.stable),
      yesNo(mode.controllable),
      formatNumber(mode.sigma_controllable, 2),
      yesNo(mode.observable),
      formatNumber(mode.sigma_observable, 2),
    ]),
  );
  const hidden = list.filter(({ controllable, observable }) => !(controllable && observable));
  const said = whole || hidden.length === 0 ? "Every mode is seen by input and output: the realisation is minimal." : `Hidden from the transfer function: ${rootsText(hidden.map(({ pole }) => pole))}.`;
  return part("Modes", valueTable("Each mode by the Popov–Belevitch–Hautus test, with the singular value that decides", ["Pole", "Stable", "Controllable", "σ [A − pI, B]", "Observable", "σ [A − pI; C]"], rows), h("p", { class: hidden.length > 0 ? "finding warn" : "finding" }, said));
}

/** A Gramian is solved for: what is left beside its largest entry is rounding. @param {number[][]} matrix */
function withoutRounding(matrix) {
  const least = ROUNDING * Math.max(...matrix.flat().map(Math.abs));
  return matrix.map((row) => row.map((value) => (Math.abs(value) < least ? 0 : value)));
}

/** @param {StateSpaceAnswer} found */
function gramians({ gramians: { controllability, observability, hankel_singular_values, reason } }) {
  if (!controllability || !observability) return part("Gramians", h("p", { class: "finding" }, sentence(reason ?? "there are none")));
  return part(
    "Gramians",
    h("div", { class: "matrices" }, matrixBlock("Controllability", withoutRounding(controllability)), matrixBlock("Observability", withoutRounding(observability))),
    h("p", { class: "finding" }, `Hankel singular values: ${(hankel_singular_values ?? []).map((value) => formatNumber(value, 3)).join(", ") || "none"}. A small one is a state that input and output hardly share.`),
  );
}

/** What is left when hidden modes go: of the transfer function, and of the state equations. @param {StateSpaceAnswer} found @param {ChannelAnswer | undefined} channel */
function minimal({ poles, minimal_realization: smallest }, channel) {
  const { removed, tolerance, smallest_kept, largest_removed } = smallest;
  const decided = [`Singular values up to ${formatNumber(tolerance, 2)} count as zero`, smallest_kept === null ? "" : `the smallest kept is ${formatNumber(smallest_kept, 2)}`, largest_removed === null ? "" : `the largest left out ${formatNumber(largest_removed, 2)}`];
  const gone = removed.map(({ pole, hidden_from, stable }) => h("li", { class: stable ? "" : "warn" }, `The ${stable ? "" : "unstable "}mode ${formatComplex(pole)}: ${hidden_from === "input" ? "no input moves it" : "no output shows it"}.`));
  return part(
    "Minimal realisation",
    ...(channel ? cancellations(channel, poles.length) : []),
    h("p", { class: "finding" }, removed.length === 0 ? "The state equations leave nothing out. " : "The state equations leave out: ", `${decided.filter(Boolean).join("; ")}.`),
    gone.length > 0 ? h("ul", { class: "cancellations" }, ...gone) : null,
    removed.length > 0 ? h("div", { class: "matrices" }, ...(/** @type {const} */ (["A", "B", "C", "D"])).map((name) => matrixBlock(name, smallest[name]))) : null,
  );
}

/** @param {ChannelAnswer} channel @param {number} order */
function cancellations({ system, minimal: smallest, minimal_order, cancelled, closest_kept, reason }, order) {
  const gone = cancelled.map(({ pole, zero, distance, stable }) => h("li", { class: stable ? "" : "warn" }, `The zero ${formatComplex(zero)} cancels the ${stable ? "stable" : "unstable"} pole ${formatComplex(pole)} (distance ${formatNumber(distance, 2)}).`));
  const kept = closest_kept === null ? "" : ` The closest zero and pole that were kept are ${formatNumber(closest_kept, 2)} apart.`;
  return [
    system ? formulaBlock("With every mode", system) : null,
    smallest ? formulaBlock("Minimal", smallest) : null,
    reason ? h("p", { class: "finding" }, sentence(reason)) : null,
    smallest ? h("p", { class: "finding" }, minimal_order === order ? `Nothing cancels: order ${order}.${kept}` : `Order ${minimal_order} instead of ${order}.${kept}`) : null,
    gone.length > 0 ? h("ul", { class: "cancellations" }, ...gone) : null,
  ];
}

/** @param {StateSpaceAnswer} found @returns {Table} */
function tableOf({ modes: list }) {
  return {
    header: ["Re", "Im", "stable", "controllable", "sigma controllable", "observable", "sigma observable"],
    rows: list.map((mode) => [...mode.pole, String(mode.stable), String(mode.controllable), mode.sigma_controllable, String(mode.observable), mode.sigma_observable]),
  };
}
