/** What the loop with the placed poles does after a step: y with its setpoint, and the effort u. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {PlacementAnswer, PlacementState} from "../../core/design/pole-placement.js" */
/** @import {Numbers, StepPanel} from "../../core/types.js" */

import { formatFixed, formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { mountDesignPanel } from "../../components/design-panel.js";
import { h } from "../../components/dom.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";
import { stepResponse } from "../../plots/step_response.js";

const HELP = "Above the output y after a unit step of the setpoint or of the load, below what the controller does for it. Fast poles are paid for in u.";

/** @param {Numbers} values @param {number} factor @returns {Numbers} */
const times = (values, factor) => (factor === 1 ? values : Array.from(values, (value) => factor * value));

/** @param {HTMLElement} host @param {DesignBench<PlacementState, PlacementAnswer>} bench */
export function mount(host, bench) {
  const choice = h("segmented-control", { label: "Step in", class: "small" });
  choice.options = [
    { value: "setpoint", label: "Setpoint", title: "Unit step of the setpoint r" },
    { value: "load", label: "Load", title: "Unit step of the load d at the plant's input" },
  ];
  choice.addEventListener("value-change", () => bench.set({ signal: choice.value === "load" ? "load" : "setpoint" }, { ask: false }));

  /** 1/T(0) where it is wanted and there is one. */
  const factor = () => (bench.state.scaled ? (bench.answer?.design.reference_gain ?? 1) : 1);

  /** @returns {StepPanel | null} */
  function step() {
    const found = bench.answer?.loop.panels.step;
    if (!found) return null;
    const { setpoint } = found;
    return { ...found, setpoint: { ...setpoint, y: times(setpoint.y, factor()), u: times(setpoint.u, factor()) } };
  }

  mountDesignPanel(host, bench, {
    id: "placed-response",
    title: "Response",
    help: HELP,
    controls: [choice],
    figure: createFigure,
    subject: () => `${bench.state.plant}${bench.state.signal}${bench.state.scaled}${bench.answer?.horizon}`,
    draw(theme, held) {
      const { signal } = bench.state;
      choice.value = signal;
      const panel = step();
      if (!panel || !bench.answer) return null;
      const { verdict, metrics } = bench.answer.loop.panels;
      return stepResponse({ step: panel, metrics: factor() === 1 ? (metrics?.[signal] ?? null) : null, stable: verdict?.closed_loop_stable ?? true, signal, ghosts: [], timeUnit: "s" }, theme, held);
    },
    note() {
      const { metrics, step: found, verdict } = bench.answer?.loop.panels ?? {};
      if (verdict && !verdict.closed_loop_stable) return `The loop is ${verdict.verdict}: put every pole into the left half-plane.`;
      const judged = metrics?.[bench.state.signal];
      const largest = found ? Math.max(...Array.from(step()?.[bench.state.signal].u ?? [0], Math.abs)) : null;
      const parts = [];
      if (judged?.overshoot_pct != null && factor() === 1 && bench.state.signal === "setpoint") parts.push(`overshoot ${formatFixed(judged.overshoot_pct, 1)} %`);
      if (judged?.t_settle != null) parts.push(`settles in ${formatWithUnit(judged.t_settle, "s")}`);
      if (largest !== null) parts.push(`u goes up to ${formatNumber(largest)}`);
      const text = parts.join(", ");
      return text.startsWith("u ") ? `The input ${text}.` : sentence(text);
    },
    legend: () => ["r", "y", "u"].map((name) => ({ signal: name, label: SIGNALS[name]?.label ?? name, name: SIGNALS[name]?.name ?? name, dash: SIGNALS[name]?.dash })),
    table() {
      const panel = step();
      return panel && { header: ["t [s]", "y", "u"], rows: Array.from(panel.t, (t, i) => [t, panel[bench.state.signal].y[i] ?? null, panel[bench.state.signal].u[i] ?? null]) };
    },
    describe: () => `Response of the loop to a ${bench.state.signal} step: ${bench.answer?.loop.panels.verdict?.verdict ?? ""}.`,
  });
}
