/** Step 2, what is done to the plant: the kind of experiment, its numbers, and the button that begins it. */

/** @import {Api} from "../../core/api.js" */
/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {ExperimentKind, ExperimentSetting} from "../../core/experiments/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { cycleRequest, filledIn, relayRequest, stepRequest } from "../../core/experiments/requests.js";
import { toInput } from "../../core/format.js";
import { patiently } from "../../core/patience.js";
import { unitRatio } from "../../core/units.js";
import { h, setText } from "../../components/dom.js";
import { fieldRow, number } from "../../components/form-parts.js";
import "../../components/segmented-control.js";

/** @type {Record<ExperimentKind, {label: string, title: string, what: string, action: string}>} */
const KINDS = {
  step: { label: "Step test", title: "One step of the input, the loop open", what: "The loop is open. The input steps once, and the output is recorded: the record is what step 3 reads a model off.", action: "Make the step" },
  hand: { label: "By hand", title: "Raise the gain until the loop just rings", what: "Proportional control. Raise the gain until the loop just rings on and on: that gain is Ku, and the period of the ringing Pu.", action: "Run with this gain" },
  search: { label: "Search", title: "The same search, made by the lab", what: "The lab doubles the gain until the swings grow, then halves the bracket, as you would by hand.", action: "Search Ku" },
  relay: { label: "Relay", title: "A relay makes the loop ring by itself", what: "A relay instead of a controller: u jumps up when y is low and down when y is high. The loop rings near Pu, with swings that stay small.", action: "Switch the relay on" },
};

/** @param {Step} step @param {ExperimentBench} bench @param {Api} api */
export function mount(step, bench, api) {
  let asked = 0;
  const kinds = h("segmented-control", { label: "Experiment", class: "experiment-kinds" });
  kinds.options = Object.entries(KINDS).map(([value, { label, title }]) => ({ value, label, title }));
  kinds.addEventListener("value-change", () => {
    asked += 1;
    bench.setResult(null);
    step.say("");
    bench.setExperiment({ kind: /** @type {ExperimentKind} */ (kinds.value) });
  });
  const what = h("p", { class: "field-hint" });
  const fields = h("div", { class: "step-fields" });
  const button = h("button", { type: "submit", class: "button primary" });
  const form = h("form", { class: "step-fields", onsubmit: (/** @type {Event} */ event) => { event.preventDefault(); void run(); } }, fields, button);
  step.side.append(kinds, what, form, step.message);

  /** @param {keyof ExperimentSetting} name @param {string} label @param {number | null} chosen  where nothing is typed @param {object} options */
  function field(name, label, chosen, options) {
    const made = number(label, { value: /** @type {number | null} */ (bench.setting.experiment[name]), optional: true, ...options }, () => bench.setExperiment({ [name]: made.value }));
    made.setAttribute("placeholder", chosen === null ? "auto" : toInput(chosen));
    return made;
  }

  // Fields are made anew only where others are needed: who goes from one to the next must not lose it.
  let built = "";

  function build() {
    const { experiment, plant } = bench.setting;
    const { about } = bench;
    const { kind } = experiment;
    const library = plant.kind === "library";
    kinds.value = kind;
    setText(what, library && kind === "hand" ? `${KINDS.hand.what} On a plant of the library every gain is a run from rest.` : KINDS[kind].what);
    setText(button, KINDS[kind].action);
    button.hidden = kind === "hand" && !library;
    button.disabled = !about;
    const needed = JSON.stringify([kind, about]);
    if (!about || built === needed) return;
    built = needed;
    const { timeUnit, inputUnit, outputUnit } = about;
    const chosen = filledIn({ ...experiment, size: null, start: null, horizon: null, amplitude: null, hysteresis: null, Kc: null }, plant, about);
    const runs = (/** @type {number | null} */ auto) => field("horizon", "Runs for", auto, { unit: timeUnit, above: 0 });
    if (kind === "step") {
      const points = number("Samples", { value: experiment.points, min: 20 }, () => bench.setExperiment({ points: Math.min(5000, Math.max(20, Math.round(points.value ?? 200))) }));
      fields.replaceChildren(
        fieldRow(field("size", "Step of u", chosen.size, { unit: inputUnit }), field("start", "Made at", chosen.start, { unit: timeUnit, min: 0 })),
        fieldRow(runs(chosen.stepHorizon), points),
      );
    } else if (kind === "relay") {
      fields.replaceChildren(
        fieldRow(field("amplitude", "Height d, up and down", chosen.amplitude, { unit: inputUnit, above: 0 }), field("hysteresis", "Hysteresis ε", chosen.hysteresis, { unit: outputUnit, min: 0 })),
        ...(library ? [fieldRow(runs(chosen.cycleHorizon), h("span"))] : []),
      );
    } else {
      const gain = field("Kc", `Gain Kc${about.sign < 0 ? ", taken negative" : ""}`, chosen.Kc, { unit: unitRatio(inputUnit, outputUnit), above: 0 });
      fields.replaceChildren(...(kind === "hand" && library ? [fieldRow(gain, runs(chosen.cycleHorizon))] : library ? [fieldRow(runs(chosen.cycleHorizon), h("span"))] : []));
    }
  }

  async function run() {
    const { about, setting } = bench;
    if (!about || form.querySelector("[aria-invalid]")) return;
    const { kind } = setting.experiment;
    const now = (asked += 1);
    button.disabled = true;
    step.say(kind === "search" ? "Searching…" : "Running…");
    try {
      const { Kc, sign } = filledIn(setting.experiment, setting.plant, about);
      const answer = await patiently(() => {
        if (kind === "step") return api.experiment("step-test", stepRequest(setting, about));
        if (kind === "relay") return api.experiment("relay", relayRequest(setting, about));
        return api.experiment("ultimate-cycle", cycleRequest(setting, about, kind === "hand" ? sign * Kc : null));
      });
      if (now !== asked) return;
      step.say("");
      bench.setResult({ kind, answer });
    } catch (error) {
      if (now === asked) {
        bench.setResult(null);
        step.complain(error);
      }
    } finally {
      button.disabled = !bench.about;
    }
  }

  bench.on(["about", "experiment", "plant"], () => {
    build();
    if (!bench.about) {
      asked += 1;
      step.say("");
    }
  });
  build();
  return { begin: run };
}
