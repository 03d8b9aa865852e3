/** The plant whose poles are placed, and what the controller shall have. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {PlacementAnswer, PlacementState} from "../../core/design/pole-placement.js" */

import { sentence } from "../../core/format.js";
import { groupsOf } from "../../core/design/pole-groups.js";
import { PLACEMENT_PRESETS } from "../../core/design/pole-placement.js";
import { h } from "../../components/dom.js";
import { createExpressionField } from "../../components/expression-field.js";
import "../../components/number-field.js";
import "../../components/segmented-control.js";

const HIGHEST_ORDER = 8;

/** @param {HTMLElement} host @param {DesignBench<PlacementState, PlacementAnswer>} bench */
export function mount(host, bench) {
  const plant = createExpressionField({
    id: "placement-plant",
    symbol: "G",
    hint: "Any transfer function without dead time.",
    commit: (text) => bench.set({ plant: text, groups: [] }),
  });
  const presets = PLACEMENT_PRESETS.map((preset) =>
    h("button", { type: "button", class: "button small", title: preset.teaches, onclick: () => bench.set({ plant: preset.plant, groups: groupsOf(preset.poles ?? []), integrator: false, pade_order: null }) }, preset.name),
  );
  /** @param {string} label @param {string} says @param {"integrator" | "scaled"} name @param {boolean} ask */
  const toggle = (label, says, name, ask) => {
    const input = h("input", { type: "checkbox", role: "switch" });
    input.addEventListener("change", () => bench.set({ [name]: input.checked }, { ask }));
    return { input, root: h("label", { class: "design-switch" }, input, h("span", {}, h("b", {}, label), h("span", {}, says))) };
  };
  const integrator = toggle("Integral action", "L contains s: no offset, one pole more to place.", "integrator", true);
  const scaled = toggle("Scale the setpoint by 1/T(0)", "Takes the offset away as long as the model is right.", "scaled", false);
  const structure = h("segmented-control", { label: "Degrees of the controller", class: "small" });
  structure.options = [
    { value: "biproper", label: "Least order", title: "As many zeros as poles may be" },
    { value: "strictly_proper", label: "Strictly proper", title: "One pole more: noise is passed on less" },
  ];
  structure.addEventListener("value-change", () => bench.set({ structure: structure.value === "strictly_proper" ? "strictly_proper" : "biproper" }));
  const pade = h("number-field", { label: "Order of the Padé approximation", min: 1, max: HIGHEST_ORDER, optional: true, placeholder: "none" });
  pade.addEventListener("value-change", () => bench.set({ pade_order: pade.value === null ? null : Math.round(pade.value), groups: [] }));
  const dead = h("div", { class: "design-dead-time", hidden: true });
  const message = h("p", { class: "analysis-message wrong", role: "status", hidden: true });

  host.append(
    h("section", { class: "design-card-form", "aria-label": "Plant" }, h("h2", {}, "Plant"), plant.root, h("div", { class: "design-presets", role: "group", "aria-label": "Examples" }, ...presets), message, dead),
    h("section", { class: "design-card-form", "aria-label": "Wishes for the controller" }, h("h2", {}, "The controller shall have"), integrator.root, scaled.root, structure),
  );

  function show() {
    const { state, error, answer } = bench;
    plant.show(state.plant);
    const typed = error?.path?.startsWith("plant.") ? error : null;
    plant.complain(typed);
    const other = error && !typed ? error : null;
    message.hidden = other === null;
    message.textContent = other ? [sentence(other.message), sentence(other.hint)].join(" ").trim() : "";
    const delayed = /dead time/.test(other?.message ?? "");
    dead.hidden = !delayed && !answer?.design.approximation;
    if (!dead.hidden && !dead.firstChild) dead.append(pade, h("a", { class: "button small", href: "/smith-predictor" }, "Or use a Smith predictor"));
    pade.value = state.pade_order;
    integrator.input.checked = state.integrator;
    scaled.input.checked = state.scaled;
    const free = state.integrator || answer?.design.static_gain === 1;
    scaled.input.disabled = free || !answer?.design.reference_gain;
    structure.value = state.structure;
  }
  bench.subscribe(({ moving }) => !moving && show());
  show();
}
