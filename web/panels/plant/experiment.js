/** An experiment: one input follows a course over a set time, and the complete curves come back. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {PlantRun} from "../../core/plant/run.js" */

import { sentence } from "../../core/format.js";
import { round125 } from "../../core/plant/pace.js";
import { usualRange } from "../../core/plant/bench.js";
import { h, setText } from "../../components/dom.js";
import "../../components/number-field.js";
import { createSelectField } from "../../components/select-field.js";

/**
 * The numbers of each course; `size` is in units of the input, `time` in those of time.
 * @type {Record<string, {label: string, fields: {name: string, label: string, of: "size" | "time" | "rate" | "omega", share: number, above?: number}[]}>}
 */
const COURSES = {
  step: { label: "Step", fields: [{ name: "amplitude", label: "Size", of: "size", share: 0.1 }] },
  pulse: { label: "Pulse", fields: [{ name: "amplitude", label: "Size", of: "size", share: 0.1 }, { name: "width", label: "Lasts", of: "time", share: 0.1, above: 0 }] },
  ramp: { label: "Ramp", fields: [{ name: "slope", label: "Slope", of: "rate", share: 0.2 }] },
  sine: { label: "Sine", fields: [{ name: "amplitude", label: "Amplitude", of: "size", share: 0.05 }, { name: "omega", label: "ω", of: "omega", share: 20, above: 0 }] },
  noise: { label: "Noise", fields: [{ name: "std", label: "Standard deviation", of: "size", share: 0.02, above: 0 }, { name: "interval", label: "A new value every", of: "time", share: 0.01, above: 0 }] },
};
const POINTS = 801;

/**
 * @param {HTMLElement} host
 * @param {PlantBench} bench
 * @param {PlantRun} run
 * @param {Api} api
 * @param {{window: number}} options
 */
export function mount(host, bench, run, api, { window }) {
  /** @type {import("../../core/plant/types.js").Quantity | undefined} */
  let input = bench.inputs[0];
  let kind = "step";
  /** @type {Map<string, import("../../components/number-field.js").NumberField>} */
  const fields = new Map();
  const place = h("div", { class: "form-fields" });
  const message = h("p", { class: "field-message", role: "status" });
  const horizon = numberField("Runs for", window, bench.timeUnit, 0);
  const start = numberField("Begins at", round125(window / 10), bench.timeUnit);
  const choose = createSelectField({ label: "Input", groups: [{ label: null, choices: bench.inputs.map(({ name, meaning }) => ({ value: name, label: meaning ? `${name}, ${meaning}` : name })) }], onChoice: (name) => { input = bench.inputs.find((each) => each.name === name); build(); } });
  const course = createSelectField({ label: "Course", groups: [{ label: null, choices: Object.entries(COURSES).map(([value, { label }]) => ({ value, label })) }], onChoice: (value) => { kind = value; build(); } });
  const button = h("button", { type: "submit", class: "button primary" }, "Run the experiment");
  const form = h("form", { class: "form-fields", onsubmit: (/** @type {Event} */ event) => { event.preventDefault(); void go(); } }, choose.root, course.root, place, start, horizon, button, message);
  const root = h("details", { class: "plant-card plant-fold" }, h("summary", {}, h("h2", {}, "Experiment")), h("p", { class: "field-hint" }, "One input follows a course from the start of the run; the complete curves come at once."), form);
  if (bench.inputs.length > 0) host.append(root);

  /** @param {string} label @param {number} value @param {string} unit @param {number} [above] */
  function numberField(label, value, unit, above) {
    const field = document.createElement("number-field");
    for (const [key, text] of Object.entries({ label, unit, above })) if (text !== undefined) field.setAttribute(key, String(text));
    field.value = value;
    return field;
  }

  function build() {
    if (!input) return;
    const range = usualRange(input);
    const unit = bench.unit(input.name);
    fields.clear();
    const time = bench.timeUnit;
    const units = { size: unit, time, rate: `${unit || "1"}/${time}`, omega: `rad/${time}` };
    for (const { name, label, of, share, above } of COURSES[kind]?.fields ?? []) {
      const span = range.max - range.min;
      const scale = { size: span, time: window, rate: span / window, omega: 1 / window }[of];
      fields.set(name, numberField(label, round125(share * scale), units[of], above));
    }
    place.replaceChildren(...fields.values());
  }

  async function go() {
    if (!input) return;
    const signal = { type: kind, start: start.value ?? 0, ...Object.fromEntries([...fields].map(([name, field]) => [name, field.value])) };
    const { inputs, parameters } = bench.request();
    button.disabled = true;
    setText(message, "");
    try {
      const level = bench.setting.inputs[input.name] ?? input.value;
      const answer = await api.workOut(bench.model.id, "simulate", { parameters, initial: bench.setting.start, inputs: { ...inputs, [input.name]: { level, add: [signal] } }, horizon: horizon.value, points: POINTS });
      run.show(answer);
    } catch (error) {
      const { message: text, hint } = /** @type {any} */ (error);
      setText(message, [sentence(text), sentence(hint)].join(" ").trim());
    } finally {
      button.disabled = false;
    }
  }
  build();
  return { root };
}
