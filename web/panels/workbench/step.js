/** Step responses to the setpoint or to a load. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {StepPanel, Table} from "../../core/types.js" */

import { MEANING, PLOT_HELP } from "../../core/explain.js";
import { formatFixed, formatWithUnit } from "../../core/format.js";
import { h } from "../../components/dom.js";
import { mountPlotPanel } from "../../components/plot-panel.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";
import { stepResponse } from "../../plots/step_response.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const choice = h("segmented-control", { label: "Step in", class: "small" });
  choice.options = [
    { value: "setpoint", label: "Setpoint", title: "Unit step of the setpoint r" },
    { value: "load", label: "Load", title: "Unit step of the load d at the plant's input" },
  ];
  choice.addEventListener("value-change", () => {
    store.setView({ signal: choice.value === "load" ? "load" : "setpoint" });
  });

  const signal = () => store.get().view.signal;
  let shown = signal();
  const panel = mountPlotPanel(host, store, {
    id: "step",
    title: "Step",
    help: /** @type {string} */ (PLOT_HELP["step"]),
    wants: ["step", "metrics", "verdict"],
    figure: createFigure,
    controls: [choice],
    draw(theme, held) {
      const { step, metrics, verdict } = answers.panels;
      choice.value = signal();
      if (!step) return null;
      // The other signal has another size: its axes are its own.
      const ranges = shown === signal() ? held.ranges : {};
      shown = signal();
      return stepResponse(
        {
          step,
          metrics: metrics?.[signal()] ?? null,
          stable: verdict?.closed_loop_stable ?? true,
          signal: signal(),
          ghosts: store.snapshots.flatMap(({ panels }) => panels.step ?? []),
          timeUnit: answers.time_unit,
        },
        theme,
        { ...held, ranges },
      );
    },
    legend: () =>
      ["r", "y", ...(answers.panels.step?.setpoint.y_m ? ["y_m"] : []), "u"].map((name) => {
        const { label, name: words, dash } = /** @type {import("../../plots/signals.js").Signal} */ (SIGNALS[name]);
        return { signal: name, label, name: words, dash };
      }),
    note: () => {
      const now = answers.panels.step?.[signal()];
      return now?.truncated_at != null ? `Cut off at ${formatWithUnit(now.truncated_at, answers.time_unit)}: ${now.truncated_reason ?? "it leaves all bounds"}.` : "";
    },
    table: () => (answers.panels.step ? stepTable(answers.panels.step, answers.time_unit) : null),
    describe() {
      const metrics = answers.panels.metrics?.[signal()];
      const kind = signal() === "setpoint" ? "a setpoint step" : "a load step";
      if (!metrics || !answers.panels.verdict?.closed_loop_stable) return `Response to ${kind}: ${answers.panels.verdict?.verdict ?? ""}.`;
      const parts = [`final value ${formatWithUnit(metrics.final_value, "")}`];
      if (metrics.overshoot_pct !== null) parts.push(`overshoot ${formatFixed(metrics.overshoot_pct, 1)} %`);
      if (metrics.t_settle !== null) parts.push(`${MEANING["t_settle"]?.name.toLowerCase()} ${formatWithUnit(metrics.t_settle, answers.time_unit)}`);
      return `Response to ${kind}: ${parts.join(", ")}.`;
    },
  });
  return panel.dispose;
}

/** @param {StepPanel} step @param {string} unit @returns {Table} */
function stepTable({ t, setpoint, load }, unit) {
  const measured = setpoint.y_m && load.y_m ? [setpoint.y_m, load.y_m] : [];
  const names = ["y, setpoint step", "u, setpoint step", "y, load step", "u, load step", ...(measured.length > 0 ? ["y_m, setpoint step", "y_m, load step"] : [])];
  return {
    header: [`t [${unit}]`, ...names],
    rows: Array.from(t, (time, i) => [time, ...[setpoint.y, setpoint.u, load.y, load.u, ...measured].map((values) => values[i] ?? null)]),
  };
}
