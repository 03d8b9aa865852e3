/** The gang of six, S, PS, CS, T and the two that see the setpoint weight, over frequency or as step responses. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {Table} from "../../core/types.js" */
/** @import {GangMember} from "../../plots/sensitivity.js" */

import { PLOT_HELP } from "../../core/explain.js";
import { formatNumber, sentence } from "../../core/format.js";
import { h } from "../../components/dom.js";
import { mountPlotPanel } from "../../components/plot-panel.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { gangStepsPlot, sensitivityPlot } from "../../plots/sensitivity.js";
import { legendToggle } from "../../plots/signals.js";

/** @type {GangMember[]} */
const GANG = ["S", "PS", "CS", "T", "CFS", "TF"];
/** Without a setpoint weight the last two repeat CS and T: they are shown when they are asked for. */
const FIRST_SHOWN = GANG.slice(0, 4);

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  /** @type {Set<GangMember>} */
  const on = new Set(FIRST_SHOWN);
  const choice = h("segmented-control", { label: "Against", class: "small" });
  choice.options = [
    { value: "omega", label: "Frequency", title: "Magnitudes over frequency" },
    { value: "t", label: "Step", title: "Responses to unit steps" },
  ];
  choice.value = "omega";
  /** Gives the step responses back; null while they are not shown. @type {(() => void) | null} */
  let stepping = null;

  const panel = mountPlotPanel(host, store, {
    id: "sensitivity",
    title: "Sensitivity",
    help: /** @type {string} */ (PLOT_HELP["sensitivity"]),
    wants: ["sensitivity", "margins", "verdict"],
    figure: createFigure,
    controls: [choice],
    draw(theme, held) {
      const { sensitivity, gang_steps: steps, verdict } = answers.panels;
      const curves = GANG.filter((name) => on.has(name));
      if (stepping) return steps ? gangStepsPlot({ steps, curves, stable: verdict?.closed_loop_stable ?? true, timeUnit: answers.time_unit }, theme, held) : null;
      return sensitivity ? sensitivityPlot({ sensitivity, curves, timeUnit: answers.time_unit }, theme, held) : null;
    },
    legend: () => GANG.map((member) => legendToggle(member, on.has(member), () => toggle(member))),
    note() {
      const { sensitivity, gang_steps: steps } = answers.panels;
      if (!sensitivity) return "";
      const { beta } = store.get().controller;
      const words =
        sensitivity.feedforward === 0
          ? "β = 1, so F = 0: CFS is CS, and TF is T."
          : `β = ${formatNumber(beta)}, F = Kc(β − 1) = ${formatNumber(sensitivity.feedforward)}: r goes to y by TF = P(C + F)S and to u by CFS = (C + F)S.`;
      return stepping && steps?.truncated_reason ? `${words} ${sentence(steps.truncated_reason)}` : words;
    },
    table: () => (stepping ? stepTable() : frequencyTable()),
    describe: () => `Sensitivity functions; peak of S ${formatNumber(answers.panels.margins?.Ms)}, peak of T ${formatNumber(answers.panels.margins?.Mt)}.`,
  });

  /** @returns {Table | null} */
  function frequencyTable() {
    const { sensitivity } = answers.panels;
    if (!sensitivity) return null;
    return {
      header: [`ω [rad/${answers.time_unit}]`, ...GANG.map((name) => `|${name}| [dB]`)],
      rows: Array.from(sensitivity.omega, (w, i) => [w, ...GANG.map((name) => sensitivity[`${name}_dB`]?.[i] ?? null)]),
    };
  }

  /** @returns {Table | null} */
  function stepTable() {
    const { gang_steps: steps } = answers.panels;
    if (!steps) return null;
    return {
      header: [`t [${answers.time_unit}]`, ...GANG],
      rows: Array.from(steps.t, (t, i) => [t, ...GANG.map((name) => steps[name][i] ?? null)]),
    };
  }

  /** @param {GangMember} member */
  function toggle(member) {
    if (on.has(member) && on.size > 1) on.delete(member);
    else on.add(member);
    panel.redraw();
  }

  choice.addEventListener("value-change", () => {
    stepping?.();
    stepping = choice.value === "t" ? answers.want(["gang_steps"]) : null;
    panel.redraw({ refit: true });
  });
  return () => {
    stepping?.();
    panel.dispose();
  };
}
