/** Choosing an input signal: which one, and what it is set by. */

/** @import {InputField} from "../core/inputs.js" */
/** @import {InputShape} from "../core/types.js" */

import { startingInput } from "../core/inputs.js";
import { h } from "./dom.js";
import { createListField } from "./list-field.js";
import "./number-field.js";
import "./segmented-control.js";
import { createSelectField } from "./select-field.js";

const NONE = "none";

/**
 * @typedef {object} InputFormOptions
 * @property {Record<string, {label: string, fields: InputField[]}>} known
 * @property {string} [none]  how "no input" is called, where it may be chosen
 * @property {string} timeUnit
 * @property {(input: InputShape | null) => void} onInput
 */

/** @param {InputFormOptions} options */
export function createInputForm({ known, none, timeUnit, onInput }) {
  const fields = h("div", { class: "form-fields" });
  /** @type {Map<string, import("./number-field.js").NumberField>} */
  const numbers = new Map();
  /** @type {InputShape | null} */
  let input = null;
  let built = "";

  const types = Object.entries(known).map(([value, { label }]) => ({ value, label }));
  const kind = createSelectField({
    label: "Input u(t)",
    groups: [{ label: null, choices: none ? [...types, { value: NONE, label: none }] : types }],
    onChoice: (type) => onInput(type === NONE ? null : startingInput(type, known)),
  });
  const root = h("div", { class: "form-fields" }, kind.root, fields);

  /** @param {Record<string, any>} patch */
  const change = (patch) => {
    if (input) onInput({ ...input, ...patch });
  };

  // Times and values change together: half of a new pair waits for the other.
  let [times, values] = [/** @type {number[]} */ ([]), /** @type {number[]} */ ([])];
  const pair = () => {
    if (times.length === values.length) change({ times, values });
  };
  const samples = {
    times: createListField({ label: "Times", onValues: (list) => { times = list; pair(); }, check: (list) => (list.some((t, i) => t < 0 || t <= (list[i - 1] ?? -1)) ? "Times must grow, from 0 on." : "") }),
    values: createListField({ label: "Values, as many", onValues: (list) => { values = list; pair(); } }),
    hold: h("segmented-control", { label: "Between samples", class: "small" }),
  };
  samples.hold.options = [
    { value: "zero", label: "Held", title: "Each value is held until the next one" },
    { value: "linear", label: "Joined", title: "Values are joined by straight lines" },
  ];
  samples.hold.addEventListener("value-change", () => change({ hold: samples.hold.value }));

  /** @param {string} type */
  function build(type) {
    if (built === type) return;
    built = type;
    numbers.clear();
    if (type === "sampled") {
      fields.replaceChildren(samples.times.root, samples.values.root, samples.hold);
      return;
    }
    const made = (known[type]?.fields ?? []).map(({ name, label, min, above, unit }) => {
      const field = h("number-field", { label, min, above, unit: unit?.replace("time", timeUnit) });
      field.addEventListener("value-change", (event) => change({ [name]: /** @type {CustomEvent<{value: number}>} */ (event).detail.value }));
      numbers.set(name, field);
      return field;
    });
    fields.replaceChildren(...made);
  }

  return {
    root,
    /** @param {InputShape | null} next */
    show(next) {
      input = next;
      kind.show(next?.type ?? NONE);
      build(next?.type ?? NONE);
      for (const [name, field] of numbers) field.value = next?.[name] ?? null;
      if (next?.type !== "sampled") return;
      [times, values] = [next["times"], next["values"]];
      samples.times.show(times);
      samples.values.show(values);
      samples.hold.value = next["hold"];
    },
  };
}
