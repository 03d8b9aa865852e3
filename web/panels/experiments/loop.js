/** Step 5: the tuned controller on the true plant, and over it what the model promised. */

/** @import {Api} from "../../core/api.js" */
/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {PromisedRun, Side} from "../../core/experiments/promised-run.js" */
/** @import {Ranges, Table} from "../../core/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { filledIn, workbenchLink } from "../../core/experiments/requests.js";
import { formatAbsent, formatFixed, formatNumber, formatWithUnit, sentence, toInput, UNDEFINED } from "../../core/format.js";
import { patiently } from "../../core/patience.js";
import { runBoth } from "../../core/experiments/promised-run.js";
import { h, setText } from "../../components/dom.js";
import { valueTable } from "../../components/facts.js";
import { number } from "../../components/form-parts.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import "../../components/segmented-control.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { promisedLoopPlot } from "../../plots/experiments/promised_loop.js";

const HELP = "The loop closed around the plant itself, and dashed what the same controller does on the model. Where the two part, the model was wrong in what matters: try another method, or a gentler rule.";
/** What is settled is shown for so many settling times. */
const SHOWN = 1.8;
/** @type {{name: string, label: string, time?: boolean, unit?: string}[]} */
const ROWS = [
  { name: "overshoot_pct", label: "overshoot", unit: "%" },
  { name: "t_rise", label: "rise time", time: true },
  { name: "t_settle", label: "settling time", time: true },
  { name: "IAE", label: "IAE" },
  { name: "TV", label: "TV of u" },
  { name: "saturated_pct", label: "u at a limit", unit: "%" },
  { name: "GM_dB", label: "gain margin", unit: "dB" },
  { name: "PM_deg", label: "phase margin", unit: "°" },
  { name: "Ms", label: "Ms" },
];

/** @param {Step} step @param {ExperimentBench} bench @param {Api} api */
export function mount(step, bench, api) {
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  /** @type {PromisedRun | null} */
  let run = null;
  let asked = "";
  /** @type {"setpoint" | "load"} */
  let signal = "setpoint";
  const signals = h("segmented-control", { label: "Step of", class: "small" });
  signals.options = [
    { value: "setpoint", label: "Setpoint", title: "The setpoint steps" },
    { value: "load", label: "Load", title: "A load at the plant's input steps" },
  ];
  signals.value = signal;
  signals.addEventListener("value-change", () => {
    signal = signals.value === "load" ? "load" : "setpoint";
    ranges = {};
    show();
  });
  const place = h("div", {});
  const says = h("p", { class: "run-says", role: "status" });
  const figures = h("div", { class: "run-figures" });
  const remark = h("p", { class: "finding" });
  const link = h("a", { class: "button", hidden: true }, "Open model and controller in the workbench");
  const empty = h("p", { class: "empty" });
  step.side.append(place, says, figures, remark, link, step.message);
  const panel = createPanelFrame(step.stage, { id: "true-loop", title: "Promised and true", help: HELP, figure: createFigure, table, controls: [signals] });
  step.stage.prepend(empty);

  /** Whether the record has a plant behind it that can be controlled. */
  const behind = () => (bench.source?.from === "text" ? null : bench.about);
  const sides = () => ({ promised: run?.promised?.[signal] ?? null, true_: run?.true_?.[signal] ?? null });

  /** @returns {Table | null} */
  function table() {
    const { promised, true_ } = sides();
    const lead = true_ ?? promised;
    if (!lead) return null;
    const [p, q] = [promised?.curve, true_?.curve];
    const rows = Math.max(p?.t.length ?? 0, q?.t.length ?? 0);
    return { header: ["t, true plant", "y", "u", "t, promised", "y", "u"], rows: Array.from({ length: rows }, (_, k) => [q?.t[k] ?? null, q?.y[k] ?? null, q?.u[k] ?? null, p?.t[k] ?? null, p?.y[k] ?? null, p?.u[k] ?? null]) };
  }

  function buildChange() {
    const { about, setting } = bench;
    if (setting.plant.kind !== "library" || !about) return place.replaceChildren();
    const { change } = filledIn({ ...setting.experiment, change: null }, setting.plant, about);
    const field = number("Setpoint step", { value: setting.experiment.change, unit: about.outputUnit, optional: true }, () => bench.setExperiment({ change: field.value || null }));
    field.setAttribute("placeholder", toInput(change));
    place.replaceChildren(h("div", { class: "step-fields" }, field));
  }

  async function go() {
    const { tuned, setting, found } = bench;
    const about = behind();
    if (!tuned || (!about && !found.model)) {
      asked = "";
      run = null;
      return show();
    }
    const { Kc, tau_I, tau_D } = tuned;
    const key = JSON.stringify([setting.plant, setting.experiment.change, about?.rest, found.model, Kc, tau_I, tau_D]);
    if (key === asked) return show();
    asked = key;
    step.say("Closing the loop…");
    try {
      const next = await patiently(() => runBoth(api, setting, about, found.model, tuned));
      if (asked !== key) return;
      run = next;
      step.say("");
    } catch (error) {
      if (asked !== key) return;
      run = null;
      step.complain(error);
    }
    ranges = {};
    show();
  }

  /** @param {Side | null} side @param {typeof ROWS[number]} row */
  function cell(side, { name, time, unit }) {
    if (!side) return UNDEFINED;
    const value = side.values[name];
    if (value == null) return formatAbsent(side.reasons[name]);
    return time ? formatWithUnit(value, bench.source?.timeUnit || bench.about?.timeUnit || "") : unit ? `${formatFixed(value, 1)} ${unit}` : formatNumber(value, 4);
  }

  /** What the two have to do with each other, in a sentence. */
  function verdict() {
    const { promised, true_ } = sides();
    if (true_?.stable === false) return promised?.stable ? "The model promised a stable loop, and on the true plant it is unstable." : "The loop is unstable.";
    if (true_?.cut) return sentence(`the run ends early: ${true_.cut}`);
    const [p, q] = [promised?.values["overshoot_pct"], true_?.values["overshoot_pct"]];
    if (signal === "setpoint" && p != null && q != null) return `The model promised ${formatFixed(p, 0)} % overshoot; the true plant gives ${formatFixed(q, 0)} %.`;
    const [a, b] = [promised?.values["IAE"], true_?.values["IAE"]];
    if (a != null && b != null) return `The model promised an IAE of ${formatNumber(a)}; the true plant gives ${formatNumber(b)}.`;
    return true_ ? "The controller on the true plant." : "What the model promises.";
  }

  function show() {
    const { tuned, about, setting, source } = bench;
    const { promised, true_ } = sides();
    const lead = true_ ?? promised;
    panel.root.hidden = !lead;
    empty.hidden = lead !== null;
    setText(empty, tuned ? "" : "Pick a rule in step 4: its controller runs here, on the plant itself.");
    signals.hidden = !run?.true_?.load && run?.true_ !== null;
    const to = tuned ? workbenchLink(bench.found, setting.plant, tuned) : null;
    link.hidden = to === null;
    if (to) link.href = to;
    setText(says, lead ? verdict() : "");
    setText(remark, remarkOf());
    figures.replaceChildren();
    if (!lead) return;
    const cells = ROWS.filter(({ name }) => [promised, true_].some((side) => side && name in side.values && (side.values[name] !== null || side.reasons[name])));
    figures.replaceChildren(valueTable(signal === "load" ? "After a step of the load" : "After a step of the setpoint", ["", "promised", "true plant"], cells.map((row) => [row.label, cell(promised, row), cell(true_, row)])));
    const [end, change] = [lead.curve.t.at(-1) ?? 1, setting.plant.kind === "library" && about ? filledIn(setting.experiment, setting.plant, about).change : 1];
    const settled = [promised, true_].flatMap((side) => side?.values["t_settle"] ?? []);
    const level = signal === "load" ? 0 : (setting.plant.kind === "library" && behind() ? (about?.level ?? 0) : 0) + change;
    const { outputName = "y", inputName = "u", outputUnit = "", inputUnit = "" } = source ?? about ?? {};
    const unit = (/** @type {string} */ name, /** @type {string} */ of) => (of ? `${name} [${of}]` : name);
    const figure = promisedLoopPlot(
      { true_: true_?.curve ?? { t: [], y: [], u: [] }, promised: promised?.curve ?? null, r: { t: [0, end], y: [level, level] }, until: settled.length === 2 || (true_?.stable === false && settled.length === 1) ? Math.min(end, SHOWN * Math.max(...settled)) : end, yName: unit(outputName, outputUnit), uName: unit(inputName, inputUnit), timeUnit: source?.timeUnit || about?.timeUnit || "as recorded" },
      theme,
      { ranges, moving: false },
    );
    ranges = figure.ranges;
    panel.show(figure, false);
    panel.tell(verdict(), [
      { signal: "y", label: "true plant", name: "output of the plant itself" },
      ...(promised ? [{ signal: "model", label: "promised", name: "the same controller on the model", dash: "dash" }] : []),
      { signal: "r", label: "r", name: "setpoint", dash: "dash" },
      { signal: "u", label: "u", name: "controller output" },
    ]);
  }

  /** What this run leaves out. */
  function remarkOf() {
    if (!run) return "The controller that you pick in step 4 runs on the plant of step 1.";
    const { plant } = bench.setting;
    if (!run.true_) return "No plant stands behind a record of your own: this is the promise alone. Try the controller on your plant, with care.";
    if (run.reason) return sentence(run.reason);
    if (plant.kind !== "library" && (plant.u_min !== null || plant.u_max !== null || plant.noise || plant.drift)) return "On a linear plant this run has neither noise nor limits of u.";
    return "";
  }

  bench.on(["about"], buildChange);
  bench.on(["rules", "pick", "plant", "about", "experiment", "found", "source"], () => void go());
  onThemeChange(() => {
    theme = readTheme();
    show();
  });
  buildChange();
  void go();
}
