/** What is measured, what is held, and what the plant allows: observer, setpoint, limits. */

/** @import {FeedbackSession} from "../../core/state-feedback/session.js" */
/** @import {Complex} from "../../core/types.js" */

import { h, set } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { createMatrixEditor } from "../../components/matrix-editor.js";
import "../../components/segmented-control.js";

/** The poles with one more for the integral, or without it. @param {Complex[]} poles @param {boolean} integral @returns {Complex[]} */
function withIntegral(poles, integral) {
  const slowest = poles.toSorted(([a], [b]) => b - a)[0]?.[0] ?? -1;
  if (integral) return [[Number((0.7 * slowest).toPrecision(2)), 0], ...poles];
  const real = poles.filter(([, im]) => im === 0).toSorted(([a], [b]) => b - a)[0];
  if (real) return poles.filter((pole) => pole !== real);
  // A pair that loses one leaves the other on the real axis.
  const pair = poles.findIndex(([, im]) => im > 0);
  return poles.flatMap((pole, i) => (i === pair ? [/** @type {Complex} */ ([pole[0], 0])] : i === pair + 1 ? [] : [pole]));
}

/** @param {HTMLElement} host @param {FeedbackSession} session */
export function mount(host, session) {
  const matrices = createMatrixEditor({ onMatrices: (found) => session.set({ matrices: found, method: "lqr", poles: [], weights: [], start: { x1: 1 } }) });

  const observer = h("segmented-control", { label: "What is measured" });
  observer.options = [
    { value: "", label: "Every state", title: "The feedback is given every state as it is" },
    { value: "on", label: "Outputs only", title: "An observer estimates the states from the outputs" },
  ];
  observer.addEventListener("value-change", () => session.set({ observer: observer.value === "on" }));
  const speed = h("gain-slider", { label: "Observer faster by", min: 1, max: 20, above: 0 });
  for (const event of ["value-input", "value-change"]) speed.addEventListener(event, () => session.set({ speed: speed.value }, { moving: event === "value-input" }));
  const observed = h("p", { class: "field-hint" }, "Its first estimate is upright and at rest: it has to find out about the tilt.");

  const reach = h("segmented-control", { label: "How the setpoint is reached" });
  reach.options = [
    { value: "", label: "Gain N", title: "A gain before the loop, right for the exact model" },
    { value: "on", label: "Integral", title: "Integrate the error: no offset, even with a load" },
  ];
  reach.addEventListener("value-change", () => {
    const integral = reach.value === "on";
    if (integral !== session.state.integral) session.set({ integral, poles: session.state.poles.length > 0 ? withIntegral(session.state.poles, integral) : [], weights: integral ? session.state.weights : session.state.weights.slice(0, -1) });
  });
  const setpoint = h("div");
  const limit = h("div");
  const endless = h("input", { type: "checkbox" });
  endless.addEventListener("change", () => session.set({ endless: endless.checked }));
  const track = h("label", { class: "feedback-check" }, endless, " Endless track");
  const plant = h("div", { class: "feedback-group" }, h("h3", {}, "The plant"), limit, track);
  const own = h("div", { class: "feedback-group" }, h("h3", {}, "My model"), matrices.root);
  host.append(
    h(
      "section",
      { class: "feedback-card", "aria-label": "Settings" },
      own,
      h("div", { class: "feedback-group" }, h("h3", {}, "What is measured"), observer, speed, observed),
      h("div", { class: "feedback-group" }, h("h3", {}, "Setpoint"), setpoint, reach),
      plant,
    ),
  );
  let built = "";

  function build() {
    const { profile } = session;
    built = profile.id;
    const { min, max, unit, label } = profile.setpoint;
    const go = h("gain-slider", { label, unit, min, max, linear: true, step: (max - min) / 80 });
    for (const event of ["value-input", "value-change"]) go.addEventListener(event, () => session.set({ setpoint: go.value }, { moving: event === "value-input" }));
    setpoint.replaceChildren(go);
    limit.replaceChildren();
    if (profile.limit) {
      const strongest = h("gain-slider", { label: "Motor gives up to", unit: profile.limit.unit, min: profile.limit.min, max: profile.limit.max, above: 0 });
      for (const event of ["value-input", "value-change"]) strongest.addEventListener(event, () => session.set({ limit: strongest.value }, { moving: event === "value-input" }));
      limit.append(strongest);
    }
    track.hidden = profile.endless === null;
    plant.hidden = profile.limit === null && profile.endless === null;
    own.hidden = profile.id !== "matrices";
    observed.hidden = profile.id !== "cart-pendulum";
  }

  return {
    refresh() {
      const { state } = session;
      if (built !== state.plant) build();
      observer.value = state.observer ? "on" : "";
      speed.hidden = !state.observer;
      observed.hidden = !state.observer || state.plant !== "cart-pendulum";
      speed.value = state.speed;
      reach.value = state.integral ? "on" : "";
      const [go, strongest] = [setpoint.querySelector("gain-slider"), limit.querySelector("gain-slider")];
      if (go) go.value = state.setpoint;
      if (strongest && state.limit !== null) strongest.value = state.limit;
      endless.checked = state.endless;
      if (state.plant === "matrices") matrices.show(state.matrices);
      set(track, { "data-on": state.endless ? "" : null });
    },
  };
}
