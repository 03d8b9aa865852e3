/** Step 1: the plant, as an expression, a first-order lag with dead time, or one of the library; and how well it is measured. */

/** @import {Api} from "../../core/api.js" */
/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {PlantKind, PlantSetting} from "../../core/experiments/types.js" */
/** @import {PlantAnswer, PlantSummary} from "../../core/plant/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { aboutPlant } from "../../core/experiments/about.js";
import { patiently } from "../../core/patience.js";
import { h } from "../../components/dom.js";
import { createExpressionField } from "../../components/expression-field.js";
import { fieldRow, number } from "../../components/form-parts.js";
import "../../components/plant-schematic.js";
import "../../components/segmented-control.js";
import { createSelectField } from "../../components/select-field.js";

/** @param {Step} step @param {ExperimentBench} bench @param {Api} api */
export function mount(step, bench, api) {
  /** @type {PlantSummary[] | null} */
  let shelf = null;
  /** @type {PlantAnswer | null} */
  let answer = null;
  let asked = 0;

  const kinds = h("segmented-control", { label: "The plant is given as" });
  kinds.options = [
    { value: "expr", label: "Expression", title: "A transfer function, typed" },
    { value: "fopdt", label: "First order", title: "A gain, a time constant and a dead time" },
    { value: "library", label: "Library", title: "A nonlinear plant of the library" },
  ];
  kinds.addEventListener("value-change", () => bench.setPlant({ kind: /** @type {PlantKind} */ (kinds.value) }));
  const expression = createExpressionField({ id: "experiment-plant", symbol: "P", hint: "As in 2 exp(-3s)/((10s+1)(3s+1)); dead time is exact.", commit: (text) => bench.setPlant({ text }) });
  const fields = h("div", { class: "step-fields" });
  const measured = h("div", { class: "step-fields" });
  const more = h("details", { class: "step-fold" }, h("summary", {}, "Noise, drift and limits"), measured);
  const drawing = document.createElement("plant-schematic");
  const link = h("a", {}, "Open its page");
  const about = h("p", { class: "field-hint" });
  const picture = h("figure", { class: "experiment-drawing", hidden: true }, drawing, h("figcaption", {}, about, link));
  step.side.append(kinds, fields, more, step.message);
  step.stage.append(picture);

  /** @param {string} name @param {string} label @param {object} [options] */
  function field(name, label, options = {}) {
    const key = /** @type {keyof PlantSetting} */ (name);
    const made = number(label, { value: /** @type {number | null} */ (bench.setting.plant[key]), ...options }, () => bench.setPlant({ [key]: made.value }));
    return made;
  }

  /** @param {string} label @param {"id" | "input" | "output" | "point"} name @param {{value: string, label: string}[]} choices */
  function choose(label, name, choices) {
    const made = createSelectField({ label, groups: [{ label: null, choices }], onChoice: (value) => bench.setPlant(name === "id" ? { id: value, input: "", output: "", point: "" } : { [name]: value }) });
    made.show(bench.setting.plant[name]);
    return made.root;
  }

  // Fields are made anew only where others are needed: who goes from one to the next must not lose it.
  let [built, units] = ["", { inputUnit: "", outputUnit: "", timeUnit: "s" }];

  function build() {
    const { plant } = bench.setting;
    const library = plant.kind === "library";
    kinds.value = plant.kind;
    expression.show(plant.text);
    picture.hidden = !(library && answer?.drawing);
    units = bench.about ?? units;
    const { inputUnit, outputUnit, timeUnit } = units;
    const needed = JSON.stringify([plant.kind, library && answer?.document.id, library && [plant.input, plant.output], inputUnit, outputUnit, timeUnit]);
    if (built === needed) return;
    built = needed;
    if (plant.kind === "expr") fields.replaceChildren(expression.root);
    else if (plant.kind === "fopdt") fields.replaceChildren(fieldRow(field("K", "Gain K"), field("tau", "Time constant τ", { unit: "s", above: 0 }), field("theta", "Dead time θ", { unit: "s", min: 0 })));
    else if (shelf) {
      const { inputs = [], outputs = [], operating_points: points = [] } = answer?.document ?? {};
      const named = (/** @type {{name: string, meaning?: string}} */ { name, meaning }) => ({ value: name, label: meaning ? `${name}, ${meaning}` : name });
      fields.replaceChildren(
        choose("Plant", "id", shelf.map(({ id, title }) => ({ value: id, label: title }))),
        choose("Moved input u", "input", inputs.map(named)),
        choose("Measured output y", "output", outputs.map(named)),
        choose("Operating point", "point", [{ value: "", label: "as it starts" }, ...points.map(({ name, title }) => ({ value: name, label: title ?? name }))]),
      );
    }
    measured.replaceChildren(
      fieldRow(field("noise", "Noise, standard deviation", { unit: outputUnit, min: 0 }), field("drift", "Drift of the measurement", { unit: `${outputUnit || "1"}/${timeUnit}` })),
      fieldRow(field("u_min", "u at least", { unit: inputUnit, optional: true }), field("u_max", "u at most", { unit: inputUnit, optional: true })),
      ...(library ? [fieldRow(field("sensor_tau", "Sensor lag", { unit: timeUnit, above: 0, optional: true }), field("sensor_theta", "Sensor dead time", { unit: timeUnit, min: 0 })), h("p", { class: "field-hint" }, "The sensor is in every loop that is closed, not in the step test.")] : []),
    );
    if (plant.noise || plant.drift || plant.u_min !== null || plant.u_max !== null || plant.sensor_tau !== null || plant.sensor_theta) more.open = true;
    if (library && answer?.drawing && drawing.drawing !== answer.drawing) {
      drawing.drawing = answer.drawing;
      drawing.values = answer.values;
      drawing.still = true;
      about.textContent = answer.document.summary ?? "";
      link.href = `/plants/${answer.document.id}`;
    }
  }

  /** The chosen plant of the library, with an input and an output that it has. */
  async function look() {
    const { plant } = bench.setting;
    shelf ??= (await patiently(() => api.plants())).plants.filter(({ kind, inputs, outputs }) => kind === "nonlinear" && inputs.length > 0 && outputs.length > 0);
    if (answer?.document.id !== plant.id) answer = await patiently(() => api.plant(plant.id));
    const { inputs = [], outputs = [], operating_points: points = [] } = answer.document;
    const known = (/** @type {{name: string}[]} */ all, /** @type {string} */ name) => all.some((each) => each.name === name);
    if (!known(inputs, plant.input)) plant.input = inputs[0]?.name ?? "";
    if (!known(outputs, plant.output)) plant.output = outputs[0]?.name ?? "";
    if (plant.point && !known(points, plant.point)) plant.point = "";
    return answer;
  }

  async function learn() {
    const now = (asked += 1);
    const { plant } = bench.setting;
    expression.complain(null);
    step.say("");
    try {
      const library = plant.kind === "library" ? await look() : null;
      if (now !== asked) return;
      build();
      const found = await patiently(() => aboutPlant(api, plant, library));
      if (now === asked) bench.setAbout(found);
    } catch (error) {
      if (now !== asked) return;
      bench.setAbout(null, error);
      if (plant.kind === "expr") expression.complain(error);
      else step.complain(error);
    }
    if (now === asked) build();
  }

  bench.on(["plant"], () => {
    build();
    if (!bench.about) void learn();
  });
  build();
  void learn();
}
