/** One loop with the others open and closed, side by side: its response, the process it sees, what is left of its margins. */

/** @import {Api} from "../../core/api.js" */
/** @import {MimoStore} from "../../core/mimo/mimo.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { formatNumber, sentence } from "../../core/format.js";
import { loopsRequest } from "../../core/mimo/mimo.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { valueTable, yesNo } from "../../components/facts.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { curvesPlot } from "../../plots/mimo/frequency.js";

/** What runs away leaves the picture there. @type {[number, number]} */
const OF_A_UNIT_STEP = [-3, 4];

/** @param {HTMLElement} host @param {MimoStore} store @param {Api} api */
export function mount(host, store, api) {
  let view = "response";
  const loops = h("segmented-control", { label: "Loop" });
  const views = h("segmented-control", { label: "Shown" });
  views.options = [
    { value: "response", label: "response" },
    { value: "magnitude", label: "|g|" },
    { value: "phase", label: "phase" },
  ];
  views.value = view;
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<any> | null} */
  let analysis = null;
  let count = 0;

  function choices() {
    const n = store.get().loops.length;
    if (count !== n) {
      count = n;
      loops.options = Array.from({ length: n }, (_, i) => ({ value: String(i), label: `loop ${i + 1}` }));
    }
    loops.value = String(store.get().seen);
  }
  loops.addEventListener("value-change", () => store.set({ seen: Number(loops.value) }));

  function render() {
    const { own_gain: own, effective_gain: seen, relative_gain: relative, own_margins: before, effective_margins: after, others, reasons } = analysis?.answer ?? {};
    const loop = store.get().seen + 1;
    const row = (/** @type {string} */ name, /** @type {any} */ a, /** @type {any} */ b, unit = "") => [unit ? `${name} [${unit}]` : name, formatNumber(a), formatNumber(b)];
    // Of a loop that is not stable the angle is no margin.
    const lost = before?.closed_loop_stable && after?.closed_loop_stable && before.PM_deg !== null && after.PM_deg !== null ? Math.round(after.PM_deg - before.PM_deg) : null;
    const margin = lost === null ? "" : lost === 0 ? ", and leaves its phase margin as it is" : `, and ${lost < 0 ? "takes" : "adds"} ${Math.abs(lost)}° ${lost < 0 ? "from" : "to"} its phase margin`;
    // With a decoupler the loop's own process is no longer its entry.
    const why = relative === null || store.get().decoupler !== "none" ? "" : `: divided by λ = ${formatNumber(relative)}`;
    const same = seen !== null && own !== null && Math.abs(seen - own) < 1e-6 * Math.abs(own);
    const change = same ? `leaves the gain that loop ${loop} sees at ${formatNumber(own)}` : `changes the gain that loop ${loop} sees from ${formatNumber(own)} to ${formatNumber(seen)}${why}`;
    const unsafe = others && !others.stable;
    const told = unsafe ? `The other loops alone are ${others.verdict}: with them closed, loop ${loop} is what is left to hold the process.` : seen !== null && own ? `Closing the others ${change}${margin}.` : sentence(reasons?.effective_gain);
    words.replaceChildren(
      h("p", { class: "finding" }, told),
      valueTable(
        `Loop ${loop}, with the others open and closed`,
        ["", "open", "closed"],
        [
          ["stable", yesNo(before ? before.closed_loop_stable : null), yesNo(after ? after.closed_loop_stable : null)],
          row("gain at rest", own, seen),
          row("gain margin", before?.GM_dB, after?.GM_dB, "dB"),
          row("phase margin", before?.PM_deg, after?.PM_deg, "°"),
          row("Ms", before?.Ms, after?.Ms),
        ],
      ),
    );
  }

  function curves() {
    const answer = analysis?.answer;
    if (view === "response") {
      const nothing = { t: [], y: [] };
      const [a, b] = [answer.own_response ?? nothing, answer.effective_response ?? nothing];
      const x = a.t.length >= b.t.length ? a.t : b.t;
      return { x, curves: [{ name: "others open", signal: "case_1", values: a.y }, { name: "others closed", signal: "y", values: b.y }], yTitle: `y${store.get().seen + 1}`, xTitle: `t [${answer.time_unit}]`, log: false, unit: answer.time_unit, show: /** @type {[number, number]} */ ([0, 1.2]), most: OF_A_UNIT_STEP };
    }
    const name = view === "magnitude" ? "mag_dB" : "phase_deg";
    return { x: answer.omega, curves: [{ name: "others open", signal: "case_1", values: answer.own[name] }, { name: "others closed", signal: "y", values: answer.effective[name] }], yTitle: view === "magnitude" ? "|g| [dB]" : "arg g [°]", xTitle: `ω [rad/${answer.time_unit}]`, log: true, unit: `rad/${answer.time_unit}` };
  }

  const { redraw } = mountAnalysisPanel(
    host,
    /** @type {any} */ (store),
    {
      id: "mimo-interaction",
      title: "Close the others, watch one",
      help: "A unit step of one loop's setpoint with the other loops in manual and in automatic, whatever their switches say. With the others closed this controller moves another process: its own entry less what comes back through the others.",
      form: [loops, views],
      words: [words],
      figure: createFigure,
      subject: () => `${view} ${store.get().seen} ${JSON.stringify(store.get().entries)} ${store.get().plant}`,
      render,
      draw(theme, held) {
        if (!analysis?.answer) return null;
        return curvesPlot(curves(), theme, held);
      },
      table() {
        if (!analysis?.answer) return null;
        const shown = curves();
        return { header: [shown.xTitle, ...shown.curves.map(({ name }) => name)], rows: Array.from(shown.x, (/** @type {number} */ x, k) => [x, ...shown.curves.map(({ values }) => values[k] ?? null)]) };
      },
      describe: () => (analysis?.answer ? `Loop ${store.get().seen + 1}: ${curves().curves.map(({ name, values }) => `${name}, ends at ${formatNumber(values[values.length - 1])}`).join("; ")}.` : ""),
      legend: () => [
        { signal: "case_1", label: "others open", name: "the other loops in manual", dash: "dash" },
        { signal: "y", label: "others closed", name: "the other loops in automatic" },
      ],
    },
    (onChange) => {
      analysis = createAnalysis(
        /** @type {any} */ (store),
        {
          request: () => {
            const state = store.get();
            return { ...loopsRequest({ ...state, loops: state.loops.map((loop) => ({ ...loop, mode: "auto" })) }), loop: state.seen + 1 };
          },
          send: (/** @type {object} */ request) => api.analyse("mimo/interaction", request),
        },
        onChange,
      );
      return [analysis];
    },
  );
  views.addEventListener("value-change", () => {
    view = views.value;
    redraw();
  });
  store.subscribe((_, { moving }) => {
    if (!moving) choices();
  });
  choices();
}
