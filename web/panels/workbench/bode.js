/** Bode plot of the open loop, with plant and controller to lay over it. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {AsymptotesPanel, BodePanel, Table} from "../../core/types.js" */
/** @import {BodeCurve} from "../../plots/bode.js" */

import { cornerInWords, startInWords } from "../../core/workbench/corners.js";
import { CUT_LOOP, PLOT_HELP } from "../../core/explain.js";
import { formatFixed, formatNumber } from "../../core/format.js";
import { mountPlotPanel } from "../../components/plot-panel.js";
import { bodePlot } from "../../plots/bode.js";
import { levelAt, phaseLineAt } from "../../plots/bode_sketch.js";
import { createFigure } from "../../plots/figure.js";
import { legendToggle } from "../../plots/signals.js";

/** @type {BodeCurve[]} */
const CURVES = ["L", "P", "C"];

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  /** @type {Set<BodeCurve>} */
  const on = new Set(["L"]);
  /** Gives the straight lines back; null while they are off. @type {(() => void) | null} */
  let sketching = null;
  const sketch = () => (sketching && answers.panels.asymptotes) || null;

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
          sketch: sketch(),
          ghosts: store.snapshots.flatMap(({ panels }) => panels.bode ?? []),
          timeUnit: answers.time_unit,
        },
        theme,
        held,
      );
    },
    legend: () => [
      ...CURVES.map((curve) => legendToggle(curve, on.has(curve), () => toggle(curve))),
      legendToggle("sketch", sketching !== null, toggleSketch),
    ],
    note: () => (answers.panels.bode?.L === null ? CUT_LOOP : ""),
    table: () => (answers.panels.bode ? bodeTable(answers.panels.bode, sketch(), answers.time_unit) : null),
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
  function toggleSketch() {
    sketching?.();
    sketching = sketching ? null : answers.want(["asymptotes"]);
    panel.redraw();
  }
  return () => {
    sketching?.();
    panel.dispose();
  };
}

/** The corners first, where they are wanted, then the curves. @param {BodePanel} bode @param {AsymptotesPanel | null} sketch @param {string} unit @returns {Table} */
function bodeTable({ omega, L, P, C }, sketch, unit) {
  const others = [P, C];
  const header = [`ω [rad/${unit}]`, "|L| [dB]", "arg L [°]", ...(sketch ? ["corner of the asymptotes"] : []), "|P| [dB]", "arg P [°]", "|C| [dB]", "arg C [°]"];
  const rows = Array.from(omega, (w, i) => [
    w,
    L?.mag_dB[i] ?? null,
    L?.phase_deg[i] ?? null,
    ...(sketch ? [""] : []),
    ...others.flatMap((curve) => [curve?.mag_dB[i] ?? null, curve?.phase_deg[i] ?? null]),
  ]);
  if (!sketch || !L) return { header, rows };
  const blank = [null, null, null, null];
  const corners = [
    [0, null, sketch.initial_phase_deg, startInWords(sketch), ...blank],
    ...sketch.corners.map((corner) => [corner.omega, levelAt(sketch, corner.omega), phaseLineAt(sketch, corner.omega), cornerInWords(corner, unit), ...blank]),
  ];
  return { header, rows: [...corners, ...rows], lead: corners.length };
}
