/** The curves of the run, growing with it, and what happens on the way in words. */

/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {PlantRun} from "../../core/plant/run.js" */
/** @import {Ranges, Table} from "../../core/types.js" */

import { formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { h } from "../../components/dom.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createSelectField } from "../../components/select-field.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { plantRunPlot } from "../../plots/plant/run.js";

const COLOURS = ["y", "y_m", "d", "n"];
/** ms between two drawings: a curve that grows is smooth at this. */
const EVERY = 50;
const FIRST_OUTPUTS = 3;
/** As many names as a legend can hold; of a plant with more curves the states wait in a list. */
const LISTED = 12;

/**
 * @param {HTMLElement} host
 * @param {PlantBench} bench
 * @param {PlantRun} run
 * @param {{window: () => number}} options  length of the time axis at the run's speed
 */
export function mount(host, bench, run, options) {
  const isOutput = new Set(bench.outputs.map(({ name }) => name));
  const curves = [
    ...bench.outputs.map(({ name }, i) => ({ key: `outputs.${name}`, name, signal: COLOURS[i % COLOURS.length] ?? "y", on: i < FIRST_OUTPUTS })),
    ...bench.model.states.filter(({ name }) => !isOutput.has(name)).map(({ name }, i) => ({ key: `states.${name}`, name, signal: COLOURS[(i + 1) % COLOURS.length] ?? "y", on: false })),
    ...bench.inputs.map(({ name }, i) => ({ key: `inputs.${name}`, name, signal: "u", on: i === 0 })),
  ];
  const many = curves.length > LISTED;
  /** Those in the legend. */
  const listed = new Set(curves.filter(({ key, on }) => on || !many || !key.startsWith("states.")).slice(0, LISTED));
  const more = createSelectField({
    label: "Add a curve",
    groups: [{ label: null, choices: [{ value: "", label: "Choose…" }, ...curves.filter((curve) => !listed.has(curve)).map(({ key, name }) => ({ value: key, label: name }))] }],
    onChoice(key) {
      const curve = curves.find((one) => one.key === key);
      more.show("");
      if (!curve) return;
      listed.add(curve);
      set(curve, true);
    },
  });
  const log = h("ol", { class: "run-log", role: "log", "aria-label": "What has happened" });
  const frame = createPanelFrame(host, {
    id: "plant-run",
    title: "Run",
    help: "The plant's outputs and inputs over simulated time. Press a name to show or hide its curve; drag in the plot to zoom in. The menu saves all samples of the run as CSV.",
    controls: many ? [more.root] : [],
    figure: createFigure,
    table,
  });
  frame.root.append(log);
  const plot = /** @type {HTMLElement} */ (frame.root.querySelector(".panel-body"));
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  let drawn = 0;
  let base = NaN;
  let told = "";
  const stopTheme = onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });

  /** @returns {Table | null} */
  function table() {
    const { t, columns } = run.history;
    const count = run.whole ? t.length : t.findIndex((time) => time > run.clock);
    const until = count < 0 ? t.length : count;
    return {
      header: [`t [${bench.timeUnit}]`, ...curves.map(({ name }) => (bench.unit(name) ? `${name} [${bench.unit(name)}]` : name))],
      rows: t.slice(0, until).map((time, i) => [time].concat(curves.map(({ key }) => columns[key]?.[i] ?? NaN))),
    };
  }

  /** The time axis: grows in jumps of half its length, so that it holds still in between. @returns {[number, number]} */
  function timeAxis() {
    if (run.whole) return [run.start, run.end];
    const length = options.window();
    if (!(base <= run.clock && run.clock <= base + length)) base = run.clock <= length ? 0 : Math.floor((2 * run.clock) / length - 1) * (length / 2);
    return [base, base + length];
  }

  /** @param {boolean} moving */
  function draw(moving) {
    const shown = curves.filter(({ on }) => on);
    const { t, columns } = run.history;
    if (shown.length === 0 || t.length === 0) return;
    const window = timeAxis();
    const first = Math.max(0, t.findIndex((time) => time >= window[0]) - 1);
    const past = run.whole ? t.length : t.findIndex((time) => time > run.clock);
    const last = past < 0 ? t.length : past;
    const now = run.values();
    /** The curve ends where the clock is, not at the sample before. @param {number} value @returns {number[]} */
    const tip = (value) => (run.whole || last === 0 ? [] : [value]);
    plot.style.setProperty("--rows", String(shown.length));
    const figure = plantRunPlot(
      {
        t: [...t.slice(first, last), ...tip(run.clock)],
        rows: shown.map(({ key, name, signal }) => ({ name, unit: bench.unit(name), signal, values: [...(columns[key] ?? []).slice(first, last), ...tip(now[name] ?? NaN)] })),
        window,
        cursor: run.whole ? run.clock : null,
        timeUnit: bench.timeUnit,
      },
      theme,
      { ranges, moving },
    );
    ranges = figure.ranges;
    frame.show(figure, moving);
  }

  /** @param {typeof curves[number]} curve @param {boolean} on */
  function set(curve, on) {
    curve.on = on;
    // An empty plot tells nothing.
    if (!curves.some((one) => one.on)) curve.on = true;
    ranges = {};
    draw(false);
    tell();
  }

  function tell() {
    const now = run.values();
    const words = curves.filter(({ on }) => on).map(({ name }) => `${name} is ${formatWithUnit(now[name], bench.unit(name), 4)}`);
    frame.tell(
      `At t = ${formatNumber(run.clock, 4)} ${bench.timeUnit}: ${words.join(", ")}.`,
      curves.filter((curve) => listed.has(curve)).map((curve) => ({
        signal: curve.signal,
        label: curve.name,
        name: isOutput.has(curve.name) ? "output" : curve.key.startsWith("inputs") ? "input" : "state",
        on: curve.on,
        toggle: () => set(curve, !curve.on),
      })),
    );
  }

  function report() {
    const { events, ended } = run.told;
    const at = (/** @type {number} */ t) => `t = ${formatNumber(t, 4)} ${bench.timeUnit}`;
    // What stops a run is an event too: it is told once.
    const lines = events.map(({ message, t }) => `${sentence(message).replace(/\.$/, "")}, at ${at(t)}.`);
    if (ended && !events.some(({ t }) => t === ended?.t)) lines.push(`The run ends at ${at(ended.t)}: ${sentence(ended.reason)}`);
    if (run.error) lines.push(sentence(run.error.message) + (run.error.hint ? ` ${sentence(run.error.hint)}` : ""));
    const text = lines.join("\n");
    if (text === told) return;
    told = text;
    log.replaceChildren(...lines.slice(-6).map((line) => h("li", {}, line)));
  }

  return {
    root: frame.root,
    /** @param {number} now  ms */
    frame(now) {
      if (now - drawn < EVERY) return;
      drawn = now;
      draw(true);
      report();
    },
    /** @param {{anew?: boolean}} [how]  anew: other curves altogether */
    refresh({ anew = false } = {}) {
      if (anew) {
        ranges = {};
        base = NaN;
      }
      draw(false);
      tell();
      report();
    },
    dispose() {
      stopTheme();
      frame.dispose();
    },
  };
}
