/** Responses of the three loops on the plant as it is. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {SmithAnswer, SmithState} from "../../core/design/smith.js" */

import { sentence } from "../../core/format.js";
import { LOOPS } from "../../core/design/smith.js";
import { mountDesignPanel } from "../../components/design-panel.js";
import { h } from "../../components/dom.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";
import { smithResponsePlot } from "../../plots/design/smith_response.js";

const HELP = "The same step for three loops that are equally robust where the model is right: PI with the predictor, the best PI and the best PID. Above y, below u. Change the plant and see which one bears it.";

/** @param {HTMLElement} host @param {DesignBench<SmithState, SmithAnswer>} bench */
export function mount(host, bench) {
  const choice = h("segmented-control", { label: "Step in", class: "small" });
  choice.options = [
    { value: "setpoint", label: "Setpoint", title: "Unit step of the setpoint r" },
    { value: "load", label: "Load", title: "Unit step of the load d at the plant's input" },
  ];
  choice.addEventListener("value-change", () => bench.set({ signal: choice.value === "load" ? "load" : "setpoint" }, { ask: false }));
  const shown = () => bench.answer?.rows.filter(({ responses }) => responses) ?? [];

  mountDesignPanel(host, bench, {
    id: "smith-response",
    title: "Response",
    help: HELP,
    controls: [choice],
    figure: createFigure,
    subject: () => `${bench.state.model}${bench.state.signal}`,
    draw(theme, held) {
      choice.value = bench.state.signal;
      return bench.answer && smithResponsePlot({ rows: bench.answer.rows, horizon: bench.answer.horizon, step: bench.state.signal, timeUnit: "s" }, theme, held);
    },
    note: () =>
      shown()
        .filter(({ closed_loop_stable }) => !closed_loop_stable)
        .map(({ name }) => sentence(`${LOOPS[name].label} is not stable on this plant`))
        .join(" "),
    legend: () => [...shown().map(({ name }) => ({ signal: LOOPS[name].signal, label: LOOPS[name].label, name: LOOPS[name].name, dash: SIGNALS[LOOPS[name].signal]?.dash })), { signal: "r", label: "r", name: "setpoint", dash: "dash" }],
    table() {
      const rows = shown();
      const [longest] = rows.map(({ responses }) => responses?.[bench.state.signal].t ?? []).toSorted((a, b) => b.length - a.length);
      return longest ? { header: ["t [s]", ...rows.flatMap(({ name }) => [`y, ${LOOPS[name].label}`, `u, ${LOOPS[name].label}`])], rows: Array.from(longest, (t, i) => [t, ...rows.flatMap(({ responses }) => [responses?.[bench.state.signal].y[i] ?? null, responses?.[bench.state.signal].u[i] ?? null])]) } : null;
    },
    describe: () => `Responses to a ${bench.state.signal} step: ${shown().map(({ name, closed_loop_stable }) => `${LOOPS[name].label} ${closed_loop_stable ? "stable" : "not stable"}`).join(", ")}.`,
  });
}
