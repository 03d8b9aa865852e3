/** Step 2, what the experiment says: the ultimate point beside the one from frequency analysis, the trials of the search. */

/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {Step} from "../../components/step-section.js" */

import { formatFixed, formatNumber, formatWithUnit, sentence, UNDEFINED } from "../../core/format.js";
import { judge } from "../../core/experiments/swings.js";
import { h } from "../../components/dom.js";
import { valueTable } from "../../components/facts.js";

/** @param {number | null | undefined} value @param {number | null | undefined} exact */
function off(value, exact) {
  return value == null || !exact ? UNDEFINED : `${formatFixed(100 * (value / exact - 1), 2)} %`;
}

/** @param {Step} step @param {ExperimentBench} bench */
export function mount(step, bench) {
  const root = h("div", { class: "experiment-findings" });
  step.stage.append(root);

  /** @param {{Ku: number | null, Pu: number | null}} found @param {string} by */
  function ultimateTable({ Ku, Pu }, by) {
    const { about } = bench;
    const exact = about?.ultimate;
    const unit = about?.timeUnit ?? "s";
    return valueTable("Ultimate point; exact is that of frequency analysis", ["", by, "exact", "off by"], [
      ["Ku", formatNumber(Ku, 4), formatNumber(exact?.Ku, 4), off(Ku, exact?.Ku)],
      ["Pu", formatWithUnit(Pu, unit, 4), formatWithUnit(exact?.Pu, unit, 4), off(Pu, exact?.Pu)],
    ]);
  }

  /** @param {any} answer */
  function trials({ trials: all }) {
    const rows = all.map((/** @type {any} */ { Kc, growth, Pu }, /** @type {number} */ k) => [String(k + 1), formatNumber(Kc, 5), growth === null ? "dies out" : growth > 1e-4 ? "grows" : growth < -1e-4 ? "decays" : "sustained", growth === null ? UNDEFINED : `${formatNumber(100 * Math.exp(growth), 4)} %`, formatNumber(Pu, 4)]);
    return h("details", { class: "step-fold" }, h("summary", {}, `The ${all.length} trials of the search`), valueTable("Each swing is given as a part of the one a period before", ["", "Kc", "swings", "ratio", "period"], rows));
  }

  /** @returns {(Node | string | null)[]} */
  function words() {
    const { result, about, found } = bench;
    const kind = result?.kind ?? bench.setting.experiment.kind;
    const why = about && !about.ultimate && about.reason && kind === "hand" ? h("p", { class: "finding" }, sentence(about.reason)) : null;
    if (result && !bench.watched) return [];
    if (!result) return [kind === "hand" && found.ultimate ? ultimateTable(found.ultimate, found.ultimate.by) : null, why];
    const { answer } = result;
    const cut = answer.truncated_reason ?? answer.run?.truncated_reason;
    const notes = [...(answer.notes ?? []), ...(cut ? [`the run ends early: ${cut}`] : [])].map((note) => h("p", { class: "finding warn" }, sentence(note)));
    if (kind === "step") return notes;
    if (kind === "search") return [ultimateTable(answer, "the search"), ...notes, trials(answer)];
    if (kind === "relay") {
      const bias = answer.exact ? h("p", { class: "finding" }, "The describing function takes y for a sine, which it is not quite: that, not the experiment, is the error of Ku.") : null;
      return [answer.reason ? h("p", { class: "finding warn" }, sentence(answer.reason)) : ultimateTable(answer, "the relay"), answer.swing === null ? null : h("p", { class: "finding" }, `Swing a = ${formatWithUnit(answer.swing, about?.outputUnit ?? "", 4)}, so Ku = 4d/(π√(a² − ε²)) = ${formatNumber(answer.Ku, 4)}.`), bias, ...notes];
    }
    const seen = judge(answer.run.turning_points);
    const take = () => seen.Pu && bench.setUltimate({ Ku: answer.run.Kc, Pu: seen.Pu, by: "your hand", relay: null });
    return [
      h("p", { class: "hand-verdict", role: "status", "data-verdict": seen.verdict.replace(" ", "-") }, h("strong", { class: "hand-word" }, seen.verdict === "too few" ? "too few swings to judge" : seen.verdict), seen.Pu === null ? null : h("span", {}, `period ${formatWithUnit(seen.Pu, about?.timeUnit ?? "")}, each swing ${formatNumber(100 * (seen.ratio ?? 0))} % of the one a period before`), h("span", { class: "hand-next" }, seen.verdict === "growing" ? "Lower Kc and run again." : seen.verdict === "sustained" ? "This is the ultimate gain, as far as the eye can tell." : "Raise Kc and run again.")),
      h("button", { type: "button", class: "button primary", disabled: seen.verdict !== "sustained", onclick: take }, "This is Ku"),
      ...notes,
      found.ultimate ? ultimateTable(found.ultimate, found.ultimate.by) : null,
      why,
    ];
  }

  const show = () => root.replaceChildren(...words().filter((each) => each !== null));
  bench.on(["result", "watched", "found", "about", "experiment"], show);
  show();
}
