/** The test the loop is put to: step in setpoint or load, and how long it is watched. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { formatWithUnit } from "../../core/format.js";
import { createCard } from "../../components/card.js";
import { h } from "../../components/dom.js";
import "../../components/number-field.js";
import "../../components/segmented-control.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const card = createCard(host, { id: "card-test", title: "Test", open: false });
  const signal = h("segmented-control", { label: "Step in" });
  signal.options = [
    { value: "setpoint", label: "Setpoint r" },
    { value: "load", label: "Load d" },
  ];
  const horizon = h("number-field", { label: "Watch for", unit: answers.time_unit, above: "0", max: "1e6", optional: true, placeholder: "automatic" });
  card.body.append(
    h("div", { class: "row labelled" }, h("span", {}, "Unit step in"), signal),
    horizon,
    h("p", { class: "field-hint" }, "Empty: the time axis follows the loop. The load acts on the plant's input."),
  );
  signal.addEventListener("value-change", () => store.setView({ signal: signal.value === "load" ? "load" : "setpoint" }));
  horizon.addEventListener("value-change", (event) => store.set({ horizon: /** @type {CustomEvent<{value: number | null}>} */ (event).detail.value }));

  function show() {
    const { view, horizon: end } = store.get();
    signal.value = view.signal;
    horizon.value = end;
    const now = end ?? answers.panels.step?.horizon ?? null;
    card.summarise(`${view.signal} step${now === null ? "" : `, ${formatWithUnit(now, answers.time_unit)}`}`);
  }
  const stopStore = store.subscribe(show);
  const stopAnswers = answers.subscribe(({ moving }) => {
    if (!moving) show();
  });
  show();
  return () => {
    stopStore();
    stopAnswers();
    card.root.remove();
  };
}
