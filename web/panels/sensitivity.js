/** The gang of four: S, PS, CS, T. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */
/** @import {GangMember} from "../plots/sensitivity.js" */

import { PLOT_HELP } from "../core/explain.js";
import { formatNumber } from "../core/format.js";
import { mountPlotPanel } from "../components/plot-panel.js";
import { createFigure } from "../plots/figure.js";
import { sensitivityPlot } from "../plots/sensitivity.js";
import { SIGNALS } from "../plots/signals.js";

/** @type {GangMember[]} */
const GANG = ["S", "PS", "CS", "T"];

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  /** @type {Set<GangMember>} */
  const on = new Set(GANG);

  const panel = mountPlotPanel(host, store, {
    id: "sensitivity",
    title: "Sensitivity",
    help: /** @type {string} */ (PLOT_HELP["sensitivity"]),
    wants: ["sensitivity", "margins"],
    figure: createFigure,
    draw(theme, held) {
      const { sensitivity } = answers.panels;
      if (!sensitivity) return null;
      return sensitivityPlot({ sensitivity, curves: GANG.filter((name) => on.has(name)), timeUnit: answers.time_unit }, theme, held);
    },
    legend: () =>
      GANG.map((member) => {
        const { label, name, dash } = /** @type {import("../plots/signals.js").Signal} */ (SIGNALS[member]);
        return { signal: member, label, name, dash, on: on.has(member), toggle: () => toggle(member) };
      }),
    table() {
      const { sensitivity } = answers.panels;
      if (!sensitivity) return null;
      return {
        header: [`ω [rad/${answers.time_unit}]`, ...GANG.map((name) => `|${name}| [dB]`)],
        rows: Array.from(sensitivity.omega, (w, i) => [w, ...GANG.map((name) => sensitivity[`${name}_dB`][i] ?? null)]),
      };
    },
    describe: () => `Sensitivity functions; peak of S ${formatNumber(answers.panels.margins?.Ms)}, peak of T ${formatNumber(answers.panels.margins?.Mt)}.`,
  });

  /** @param {GangMember} member */
  function toggle(member) {
    if (on.has(member) && on.size > 1) on.delete(member);
    else on.add(member);
    panel.redraw();
  }
  return panel.dispose;
}
