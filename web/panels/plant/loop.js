/** The plant under control: a PID controller measures an output and moves an input. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {PlantRun} from "../../core/plant/run.js" */

import { firstMove } from "../../core/first-move.js";
import { formatAbsent, formatNumber, formatWithUnit } from "../../core/format.js";
import { round125 } from "../../core/plant/pace.js";
import { usualRange } from "../../core/plant/bench.js";
import { h } from "../../components/dom.js";
import { valueTable } from "../../components/facts.js";
import { choice, fieldRow, number } from "../../components/form-parts.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";
import { createFigure } from "../../plots/figure.js";
import { plantLoopPlot } from "../../plots/plant/loop.js";
import { SIGNALS } from "../../plots/signals.js";

const POINTS = 601;
/** Loop gains at rest to begin with: what is unstable needs a firmer hand. */
const STABLE = 2;
const UNSTABLE = 6;
const HELP =
  "A PID controller keeps an output of the nonlinear plant at its setpoint by moving one input, from the start that is chosen above. " +
  "Raise the setpoint step, or lower a limit, until the controller saturates, and compare the ways against windup. Leave the sampling time empty for a continuous controller.";

/**
 * @param {HTMLElement} host
 * @param {PlantBench} bench
 * @param {PlantRun} run
 * @param {Api} api
 * @param {{window: number}} options  length of the time axis to begin with
 */
export function mount(host, bench, run, api, { window }) {
  const { timeUnit } = bench;
  const changed = () => analysis.again();
  const other = () => {
    shape();
    analysis.again();
  };
  const output = choice("Measured", bench.outputs.map(({ name, meaning }) => ({ value: name, label: meaning ? `${name}, ${meaning}` : name })), other);
  const input = choice("Manipulated", bench.inputs.map(({ name, meaning }) => ({ value: name, label: meaning ? `${name}, ${meaning}` : name })), other);
  const action = choice("Action", [{ value: "reverse", label: "reverse: u rises when y is low" }, { value: "direct", label: "direct: u rises when y is high" }], changed);
  const windup = choice("Against windup", [{ value: "back_calculation", label: "back-calculation" }, { value: "clamping", label: "clamping" }, { value: "none", label: "nothing" }], changed);
  const tau_I = number("Integral time τI", { value: round125(window / 8), unit: timeUnit, above: 0, optional: true }, changed);
  const tau_D = number("Derivative time τD", { value: null, unit: timeUnit, above: 0, optional: true }, changed);
  const sampling = number("Sampling time", { value: null, unit: timeUnit, above: 0, optional: true }, changed);
  const manual = number("In manual until", { value: null, unit: timeUnit, above: 0, optional: true }, changed);
  const horizon = number("Runs for", { value: window, unit: timeUnit, above: 0 }, changed);
  /** Fields that are in units of the chosen output and input. @type {Record<string, import("../../components/number-field.js").NumberField>} */
  let sized = {};
  const place = h("div", { class: "field-row" });
  // Until someone types a setpoint it is where the run starts.
  let typed = false;
  const suggest = h("button", { type: "button", class: "button", onclick: () => void propose() }, "Suggest gain and action");

  function shape() {
    const y = bench.answer.values[output.value] ?? 0;
    const u = bench.inputs.find(({ name }) => name === input.value);
    if (!u) return;
    typed = false;
    const [yUnit, uUnit] = [bench.unit(output.value), bench.unit(input.value)];
    const span = usualRange(u);
    const level = startOf() ?? y;
    sized = {
      setpoint: number("Setpoint", { value: Number(level.toPrecision(6)), unit: yUnit }, () => {
        typed = true;
        changed();
      }),
      step: number("Setpoint step", { value: round125(0.01 * Math.abs(level) || 0.1), unit: yUnit }, changed),
      Kc: number("Gain Kc", { value: round125((span.max - span.min) / (10 * (Math.abs(level) * 0.1 || 1))), unit: uUnit || yUnit ? `${uUnit || "1"}/${yUnit || "1"}` : "", min: 0 }, changed),
      low: number("u at least", { value: u.min ?? null, unit: uUnit, optional: true }, changed),
      high: number("u at most", { value: u.max ?? null, unit: uUnit, optional: true }, changed),
    };
    place.replaceChildren(...Object.values(sized));
  }

  /** The output where the run starts. */
  const startOf = () => run.history.columns[`outputs.${output.value}`]?.[0];

  /** From the linear model: the action from the direction in which u moves y first, the gain from how far. */
  async function propose() {
    suggest.disabled = true;
    try {
      const { channel, verdict, time_constants: times } = await api.workOut(bench.model.id, "linearize", { ...bench.request(), near: bench.setting.start, input: input.value, output: output.value });
      const { A, B, C } = channel.ss;
      const direction = firstMove(A, B, C);
      if (direction === 0 || !channel.gain) throw new Error(`${input.value} does not move ${output.value}`);
      action.value = direction > 0 ? "reverse" : "direct";
      if (sized["Kc"]) sized["Kc"].value = round125((verdict === "unstable" ? UNSTABLE : STABLE) / Math.abs(channel.gain));
      if (times[0]) tau_I.value = round125(times[0]);
      analysis.ask();
    } catch (error) {
      analysis.complain(error);
    } finally {
      suggest.disabled = false;
    }
  }

  const analysis = mountPlantAnalysis(host, bench, {
    id: "plant-loop",
    title: "Closed loop",
    help: HELP,
    action: "Close the loop",
    figure: createFigure,
    form: [fieldRow(output.root, input.root, action.root, windup.root), place, fieldRow(tau_I, tau_D, sampling, manual, horizon), suggest],
    send: (request) => api.workOut(bench.model.id, "control", request),
    request() {
      const { setpoint, step, Kc, low, high } = sized;
      const begins = startOf();
      if (setpoint && !typed && begins !== undefined) setpoint.value = Number(begins.toPrecision(6));
      if (setpoint?.value == null || Kc?.value == null || horizon.value === null) return null;
      const modes = manual.value === null ? [] : [{ t: 0, mode: "manual" }, { t: manual.value, mode: "auto" }];
      const inputs = bench.request().inputs;
      return {
        inputs,
        initial: bench.setting.start,
        horizon: horizon.value,
        points: POINTS,
        loops: [
          {
            output: output.value,
            input: input.value,
            setpoint: { level: setpoint.value, add: step?.value ? [{ type: "step", amplitude: step.value, start: horizon.value / 10 }] : [] },
            controller: { type: "pid", Kc: Kc.value, tau_I: tau_I.value, tau_D: tau_D.value, action: action.value },
            u_min: low?.value ?? null,
            u_max: high?.value ?? null,
            anti_windup: tau_I.value === null ? "none" : windup.value,
            sampling_time: sampling.value,
            modes,
          },
        ],
      };
    },
    onAnswer: (answer) => run.show(answer),
    // Its answer takes the place of the run: who moves an input of the live run wants to go on with that.
    follows: false,
    draw: (answer, theme, held) => plantLoopPlot(curvesOf(answer), theme, held),
    words: (answer) => [resultTable(answer)],
    table(answer) {
      const { t, y, loop } = { ...curvesOf(answer), loop: answer.loops[0] };
      return { header: [`t [${timeUnit}]`, "r", output.value, "y_m", "u"], rows: t.map((/** @type {number} */ at, /** @type {number} */ i) => [at, loop.r[i], y[i], loop.y_m[i], loop.u[i]]) };
    },
    describe: (answer) => `${answer.loops[0].output} under control by ${answer.loops[0].input} over ${formatNumber(answer.horizon)} ${timeUnit}.`,
    legend: () => ["r", "y", "y_m", "u"].map((signal) => ({ signal, label: SIGNALS[signal]?.label ?? signal, name: SIGNALS[signal]?.name ?? signal, dash: SIGNALS[signal]?.dash })),
  });
  shape();

  /** @param {any} answer */
  function curvesOf({ t, outputs, loops: [loop] }) {
    return { t, r: loop.r, y: outputs[loop.output], y_m: loop.y_m, u: loop.u, output: loop.output, outputUnit: bench.unit(loop.output), input: loop.input, inputUnit: bench.unit(loop.input), timeUnit };
  }

  /** @param {any} answer */
  function resultTable({ loops: [{ metrics }], truncated_at: cut, truncated_reason: reason }) {
    /** @param {string} name @param {string} unit */
    const cell = (name, unit) => (metrics[name] === null ? formatAbsent(metrics.reasons?.[name]) : formatWithUnit(metrics[name], unit));
    const table = valueTable("How well the setpoint is kept", ["", "value"], [
      ["IAE", cell("IAE", "")],
      ["Overshoot", cell("overshoot_pct", "%")],
      ["Rise time", cell("t_rise", timeUnit)],
      ["Settling time", cell("t_settle", timeUnit)],
      ["At a limit", cell("saturated_pct", "%")],
    ]);
    return h("div", {}, cut === null ? null : h("p", { class: "field-message" }, `The run ends at t = ${formatNumber(cut, 4)} ${timeUnit}: ${reason}.`), table);
  }
  return analysis;
}
