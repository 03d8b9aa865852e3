/** Nichols plot of the open loop, over the grid of the closed loop. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { CUT_LOOP, PLOT_HELP } from "../../core/explain.js";
import { formatFixed, formatNumber } from "../../core/format.js";
import { mountPlotPanel } from "../../components/plot-panel.js";
import { createFigure } from "../../plots/figure.js";
import { nicholsPlot } from "../../plots/nichols.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const panel = mountPlotPanel(host, store, {
    id: "nichols",
    title: "Nichols",
    help: /** @type {string} */ (PLOT_HELP["nichols"]),
    wants: ["bode", "margins"],
    figure: createFigure,
    draw(theme, held) {
      const { bode, margins } = answers.panels;
      if (!bode) return null;
      const ghosts = store.snapshots.flatMap(({ panels }) => panels.bode ?? []);
      return nicholsPlot({ bode, margins: margins ?? null, ghosts, timeUnit: answers.time_unit }, theme, held);
    },
    legend: () => [
      { signal: "L", label: "L", name: "open loop, ω along the curve; a dot at every power of ten" },
      { signal: "T", label: "|T| = Mt", name: "the contour of the closed loop's peak, which L just touches", dash: "dash" },
    ],
    note: () => (answers.panels.bode?.L === null ? CUT_LOOP : ""),
    table() {
      const bode = answers.panels.bode;
      if (!bode?.L) return null;
      const { phase_deg, mag_dB } = bode.L;
      return {
        header: [`ω [rad/${answers.time_unit}]`, "arg L [°]", "|L| [dB]"],
        rows: Array.from(bode.omega, (w, i) => [w, phase_deg[i] ?? null, mag_dB[i] ?? null]),
      };
    },
    describe() {
      const margins = answers.panels.margins;
      return `Nichols plot of the open loop: gain margin ${formatNumber(margins?.GM)}, phase margin ${formatFixed(margins?.PM_deg, 1)} degrees, peak of T ${formatNumber(margins?.Mt)}.`;
    },
  });
  return panel.dispose;
}
