/** The plant: typed as an expression, set as a simple model, or picked from a list. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {System} from "../../core/types.js" */

import { PRESETS } from "../../core/workbench/presets.js";
import { createCard } from "../../components/card.js";
import { h } from "../../components/dom.js";
import { createExpressionField } from "../../components/expression-field.js";
import "../../components/gain-slider.js";
import { icon } from "../../components/icons.js";
import { showMath } from "../../components/mathml.js";
import { createMatrixEditor } from "../../components/matrix-editor.js";
import { attachMenu } from "../../components/menu.js";
import "../../components/segmented-control.js";
import { toast } from "../../components/status-toast.js";

/** @type {Record<"fopdt" | "sopdt", {name: string, min: number, max: number, linear?: boolean}[]>} */
const MODEL = {
  fopdt: [
    { name: "K", min: 0.1, max: 10 },
    { name: "tau", min: 0.05, max: 50 },
    { name: "theta", min: 0, max: 5, linear: true },
  ],
  sopdt: [
    { name: "K", min: 0.1, max: 10 },
    { name: "tau", min: 0.05, max: 50 },
    { name: "zeta", min: 0, max: 2, linear: true },
    { name: "theta", min: 0, max: 5, linear: true },
  ],
};

/** @type {Record<"fopdt" | "sopdt" | "ss", System>} */
const START = { fopdt: { type: "fopdt", K: 1, tau: 3, theta: 1 }, sopdt: { type: "sopdt", K: 1, tau: 1, zeta: 0.5, theta: 0 }, ss: { type: "ss", A: [[0, 1], [-2, -3]], B: [[0], [1]], C: [[1, 0]], D: [[0]], theta: 0 } };

/** @param {System} plant */
function deadTime(plant) {
  return "theta" in plant ? plant.theta : 0;
}

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} _api
 * @param {{open?: boolean}} [options]
 * @returns {() => void}
 */
export function mount(host, store, _api, { open = true } = {}) {
  const { answers } = store;
  const card = createCard(host, { id: "card-plant", title: "Plant", open });
  const math = h("div", { class: "math-display" });
  const kind = h("segmented-control", { label: "Plant given as" });
  kind.options = [
    { value: "expr", label: "Expression", title: "Any transfer function in s" },
    { value: "fopdt", label: "1st order", title: "First order with dead time" },
    { value: "sopdt", label: "2nd order", title: "Second order with dead time" },
    { value: "ss", label: "Matrices", title: "State equations x′ = A x + B u, y = C x + D u" },
  ];

  const field = createExpressionField({
    id: "plant-text",
    symbol: "P",
    hint: "Like (s+3)/(s^2 (s+2)) exp(-0.1 s)",
    commit: (text, run) => store.set({ plant: { type: "expr", text } }, { merge: run }),
  });
  const expression = field.root;
  const model = h("div", { class: "knobs" });
  const matrices = createMatrixEditor({ onMatrices: (typedIn) => store.set({ plant: { type: "ss", theta: deadTime(store.get().plant), ...typedIn } }) });
  const presets = h("button", { type: "button", class: "button", "aria-label": "Pick a plant" }, "Pick", icon("chevron"));
  card.body.append(h("div", { class: "plant-head" }, math, h("span", { class: "menu-holder" }, presets)), kind, expression, model, matrices.root);

  /** @type {Map<string, import("../../components/gain-slider.js").GainSlider>} */
  const knobs = new Map();
  let built = "";

  const groups = [...new Set(PRESETS.map(({ group }) => group))];
  /** @param {import("../../core/workbench/presets.js").Preset} preset */
  const entry = ({ name, teaches, plant, controller }) => ({
    label: name,
    detail: teaches,
    run() {
      store.set({ plant, controller: Object.assign({}, store.get().controller, { form: "ideal", action: "reverse" }, controller), actuator: "", sensor: "", horizon: null });
      toast().say(`${name}: plant and a first controller are set.`, { action: { label: "Undo", run: () => store.undo() } });
    },
  });
  attachMenu(
    presets,
    groups.flatMap((group) => [{ heading: group }].concat(/** @type {any} */ (PRESETS.filter((preset) => preset.group === group).map(entry)))),
  );

  kind.addEventListener("value-change", () => {
    const { plant } = store.get();
    if (kind.value === plant.type) return;
    if (kind.value === "expr") store.set({ plant: { type: "expr", text: answers.plant?.text || "1/(s+1)" } });
    else store.set({ plant: START[/** @type {"fopdt" | "sopdt" | "ss"} */ (kind.value)] });
  });

  /** @param {"fopdt" | "sopdt"} type */
  function build(type) {
    if (built === type) return;
    built = type;
    knobs.clear();
    model.replaceChildren(
      ...MODEL[type].map(({ name, min, max, linear }) => {
        const knob = h("gain-slider", { name, min, max, linear: linear ?? false, unit: name === "tau" || name === "theta" ? answers.time_unit : null });
        const take = (/** @type {boolean} */ moving) => (/** @type {Event} */ event) => {
          const { value } = /** @type {CustomEvent<{value: number}>} */ (event).detail;
          store.set({ plant: /** @type {System} */ ({ ...store.get().plant, [name]: value }) }, { moving });
        };
        knob.addEventListener("value-input", take(true));
        knob.addEventListener("value-change", take(false));
        knobs.set(name, knob);
        return knob;
      }),
    );
  }

  function showPlant() {
    const { plant } = store.get();
    kind.value = plant.type;
    expression.hidden = plant.type !== "expr";
    model.hidden = plant.type === "expr" || plant.type === "ss";
    matrices.root.hidden = plant.type !== "ss";
    if (plant.type === "expr") {
      field.show(plant.text);
      card.summarise(plant.text);
    } else if (plant.type === "ss") {
      matrices.show(plant);
      card.summarise(`matrices, ${plant.A.length === 1 ? "1 state" : `${plant.A.length} states`}`);
    } else {
      build(plant.type);
      for (const [name, knob] of knobs) knob.value = /** @type {Record<string, any>} */ (plant)[name];
      card.summarise(plant.type === "fopdt" ? "first order with dead time" : "second order with dead time");
    }
  }

  function showAnswer() {
    const wrong = answers.error;
    const mine = wrong && (wrong.path === null || wrong.path === undefined || String(wrong.path).includes("plant"));
    showMath(math, answers.plant?.mathml);
    math.classList.toggle("stale", Boolean(mine));
    field.complain(mine ? wrong : null);
  }

  const stopStore = store.subscribe(showPlant);
  const stopAnswers = answers.subscribe(showAnswer);
  showPlant();
  showAnswer();
  return () => {
    field.dispose();
    stopStore();
    stopAnswers();
    card.root.remove();
  };
}
