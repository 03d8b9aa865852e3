/** Bode plot of the open loop, with plant and controller to lay over it. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */
/** @import {BodePanel, Table} from "../core/types.js" */
/** @import {BodeCurve} from "../plots/bode.js" */

import { PLOT_HELP } from "../core/explain.js";
import { formatFixed, formatNumber } from "../core/format.js";
import { mountPlotPanel } from "../components/plot-panel.js";
import { bodePlot } from "../plots/bode.js";
import { createFigure } from "../plots/figure.js";
import { SIGNALS } from "../plots/signals.js";

/** @type {BodeCurve[]} */
const CURVES = ["L", "P", "C"];

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  /** @type {Set<BodeCurve>} */
  const on = new Set(["L"]);

  const panel = mountPlotPanel(host, store, {
    id: "bode",
    title: "Bode",
    help: /** @type {string} */ (PLOT_HELP["bode"]),
    wants: ["bode", "margins"],
    figure: createFigure,
    draw(theme, held) {
      const { bode, margins } = answers.panels;
      if (!bode) return null;
      return bodePlot(
        {
          bode,
          margins: margins ?? null,
          curves: CURVES.filter((curve) => on.has(curve)).toReversed(),
          ghosts: store.snapshots.flatMap(({ panels }) => panels.bode ?? []),
          timeUnit: answers.time_unit,
        },
        theme,
        held,
      );
    },
    legend: () =>
      CURVES.map((curve) => {
        const { label, name, dash } = /** @type {import("../plots/signals.js").Signal} */ (SIGNALS[curve]);
        return { signal: curve, label, name, dash, on: on.has(curve), toggle: () => toggle(curve) };
      }),
    table: () => (answers.panels.bode ? bodeTable(answers.panels.bode, answers.time_unit) : null),
    describe() {
      const margins = answers.panels.margins;
      return `Bode plot of the open loop: gain margin ${formatNumber(margins?.GM)}, phase margin ${formatFixed(margins?.PM_deg, 1)} degrees.`;
    },
  });

  /** @param {BodeCurve} curve */
  function toggle(curve) {
    if (on.has(curve) && on.size > 1) on.delete(curve);
    else on.add(curve);
    panel.redraw();
  }
  return panel.dispose;
}

/** @param {BodePanel} bode @param {string} unit @returns {Table} */
function bodeTable({ omega, L, P, C }, unit) {
  return {
    header: [`ω [rad/${unit}]`, "|L| [dB]", "arg L [°]", "|P| [dB]", "arg P [°]", "|C| [dB]", "arg C [°]"],
    rows: Array.from(omega, (w, i) => [w, ...[L, P, C].flatMap(({ mag_dB, phase_deg }) => [mag_dB[i] ?? null, phase_deg[i] ?? null])]),
  };
}
