/** What stands between controller and plant, and between plant and controller: actuator and sensor, typed or none. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { createCard } from "../../components/card.js";
import { h } from "../../components/dom.js";
import { createExpressionField } from "../../components/expression-field.js";
import { showMath } from "../../components/mathml.js";

/** @typedef {"actuator" | "sensor"} Instrument */

/** @type {{name: Instrument, title: string, symbol: string, hint: string}[]} */
const INSTRUMENTS = [
  { name: "actuator", title: "Actuator", symbol: "A", hint: "From u to the plant, like exp(-0.1s)/(0.2s+1). Empty: none." },
  { name: "sensor", title: "Sensor", symbol: "H", hint: "From y to the controller, like exp(-0.5s). Empty: none." },
];

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const first = store.get();
  const card = createCard(host, { id: "card-instruments", title: "Actuator and sensor", open: Boolean(first.actuator || first.sensor) });
  const parts = INSTRUMENTS.map(({ name, title, symbol, hint }) => {
    const math = h("div", { class: "math-display small" });
    const field = createExpressionField({ id: `${name}-text`, symbol, hint, commit: (text, run) => store.set({ [name]: text }, { merge: run }) });
    card.body.append(h("div", { class: "instrument", role: "group", "aria-label": title }, h("h3", {}, title), math, field.root));
    return { name, symbol, math, field };
  });

  function show() {
    const state = store.get();
    for (const { name, field } of parts) field.show(state[name]);
    const present = parts.filter(({ name }) => state[name].trim() !== "");
    card.summarise(present.length === 0 ? "none" : present.map(({ name, symbol }) => `${symbol} = ${state[name]}`).join(", "));
  }

  function showAnswers() {
    const wrong = answers.error;
    for (const { name, math, field } of parts) {
      const mine = wrong && String(wrong.path ?? "").includes(name);
      math.hidden = !answers[name] && !mine;
      showMath(math, answers[name]?.mathml);
      math.classList.toggle("stale", Boolean(mine));
      field.complain(mine ? wrong : null);
    }
  }

  const stopStore = store.subscribe(show);
  const stopAnswers = answers.subscribe(showAnswers);
  show();
  showAnswers();
  return () => {
    for (const { field } of parts) field.dispose();
    stopStore();
    stopAnswers();
    card.root.remove();
  };
}
