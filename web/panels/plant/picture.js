/** The plant itself: its drawing, moved by the run, and the knobs of the run below it. */

/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {PlantRun} from "../../core/plant/run.js" */

import { formatNumber, formatWithUnit } from "../../core/format.js";
import { h, set, setText } from "../../components/dom.js";
import "../../components/plant-schematic.js";
import { createSelectField } from "../../components/select-field.js";

const STEPS = 1000;

/**
 * @param {HTMLElement} host
 * @param {PlantBench} bench
 * @param {PlantRun} run
 * @param {{speeds: number[]}} options
 */
export function mount(host, bench, run, { speeds }) {
  const { model, answer, timeUnit } = bench;
  const signals = [...bench.parameters, ...(model.variables ?? []), ...bench.outputs, ...bench.inputs, ...model.states];
  const drawing = document.createElement("plant-schematic");
  const figures = h("dl", { class: "plant-figures" });
  const readings = new Map(model.states.map(({ name }) => [name, h("dd")]));
  if (answer.drawing) drawing.drawing = answer.drawing;
  else figures.append(...[...readings].flatMap(([name, place]) => [h("dt", {}, name), place]));

  const play = h("button", { type: "button", class: "button primary run-play", onclick: () => (run.playing ? run.pause() : run.play()) }, "Run");
  const reset = h("button", { type: "button", class: "button", onclick: () => run.reset() }, "Reset");
  const clock = h("output", { class: "run-clock", "aria-label": "Simulated time" });
  const pace = createSelectField({
    label: "Speed",
    groups: [{ label: null, choices: speeds.map((speed) => ({ value: String(speed), label: `${formatNumber(speed, 2)} ${timeUnit} a second` })) }],
    onChoice: (value) => run.setSpeed(Number(value)),
  });
  pace.show(String(run.speed));
  const scrub = h("input", { type: "range", class: "run-scrub", min: 0, max: STEPS, step: 1, value: 0, "aria-label": "Moment of the run" });
  scrub.addEventListener("input", () => run.seek(run.start + (Number(scrub.value) / STEPS) * (run.end - run.start)));

  const root = h(
    "section",
    { class: "plant-picture", "aria-label": "The plant" },
    answer.drawing ? h("div", { class: "plant-drawing" }, drawing) : figures,
    scrub,
    h("div", { class: "run-bar" }, play, reset, clock, pace.root),
  );
  host.append(root);
  drawing.units = Object.fromEntries(signals.map(({ name }) => [name, bench.unit(name)]));
  drawing.values = answer.values;

  return {
    root,
    /** Once for every frame of the screen. */
    frame() {
      const values = run.values();
      if (Object.keys(run.history.columns).length > 0) drawing.values = values;
      for (const [name, place] of readings) setText(place, formatWithUnit(values[name], bench.unit(name), 4));
      setText(clock, `t = ${formatNumber(run.clock, 4)} ${timeUnit}`);
      const at = String(Math.round(((run.clock - run.start) / (run.end - run.start || 1)) * STEPS));
      if (document.activeElement !== scrub || run.playing) scrub.value = at;
      set(scrub, { "aria-valuetext": `t = ${formatNumber(run.clock, 3)} ${timeUnit}` });
    },
    /** When the run has begun, rested or ended. */
    refresh() {
      drawing.still = !run.playing;
      setText(play, run.playing ? "Pause" : "Run");
      setText(reset, run.whole ? "Back to the live run" : "Reset");
      pace.root.hidden = run.whole;
    },
  };
}
