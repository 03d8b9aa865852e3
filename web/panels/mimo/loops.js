/** The loops: pairing, settings for all of them at a press, and a card with knobs for each. */

/** @import {Api} from "../../core/api.js" */
/** @import {MimoLoop, MimoStore} from "../../core/mimo/mimo.js" */

import { formatNumber, sentence } from "../../core/format.js";
import { pairedRequest, tunedLoop } from "../../core/mimo/mimo.js";
import { createCard } from "../../components/card.js";
import { h, setText } from "../../components/dom.js";
import "../../components/gain-slider.js";
import "../../components/segmented-control.js";

const METHODS = [
  { method: "blt", label: "BLT", title: "All loops together: Ziegler–Nichols, detuned until the biggest log modulus is 2 dB for each loop" },
  { method: "simc", label: "SIMC", title: "Each loop for its own entry, as if it were alone" },
  { method: "ziegler_nichols", label: "Ziegler–Nichols", title: "Each loop for its own entry, as if it were alone" },
];
const KNOBS = /** @type {const} */ ([
  { name: "Kc", min: 0.01, max: 100, time: false },
  { name: "tau_I", min: 0.1, max: 1000, time: true },
  { name: "tau_D", min: 0.01, max: 100, time: true },
]);

/** @param {HTMLElement} host @param {MimoStore} store @param {Api} api */
export function mount(host, store, api) {
  const card = createCard(host, { id: "card-loops", title: "All loops" });
  const status = h("p", { class: "field-hint", role: "status" });
  const pairing = h("segmented-control", { label: "Pairing" });
  pairing.options = [
    { value: "0,1", label: "straight", title: "straight: y1 with u1, y2 with u2" },
    { value: "1,0", label: "crossed", title: "crossed: y1 with u2, y2 with u1" },
  ];
  pairing.addEventListener("value-change", () => store.set({ pairing: pairing.value.split(",").map(Number) }));
  const straight = h("div", { class: "row labelled" }, h("span", {}, "Pairing"), pairing);
  const buttons = METHODS.map(({ method, label, title }) => h("button", { type: "button", class: "button", title, onclick: () => void tune(method, label) }, label));
  const places = h("div", { class: "mimo-loops" });
  card.body.append(straight, h("div", { class: "row" }, h("span", { class: "field-label" }, "Tune by"), ...buttons), status);
  host.append(places);
  /** @type {((loop: MimoLoop, index: number) => void)[]} */
  let cards = [];

  /** @param {string} method @param {string} label */
  async function tune(method, label) {
    const asked = JSON.stringify(pairedRequest(store.get()));
    try {
      const { settings, factor } = await api.analyse("mimo/tune", { ...pairedRequest(store.get()), method });
      if (asked !== JSON.stringify(pairedRequest(store.get()))) return;
      const loops = store.get().loops.map((loop, i) => (settings[i]?.controller ? tunedLoop(loop, settings[i].controller) : loop));
      store.set({ loops });
      /** @type {string[]} */
      const reasons = settings.map((/** @type {any} */ each) => each.reason ?? "");
      const same = reasons[0] && reasons.every((reason) => reason === reasons[0]);
      const refused = same ? `${label} does not apply: ${sentence(reasons[0])}` : reasons.map((reason, i) => (reason ? `Loop ${i + 1} stays as it was: ${sentence(reason)}` : "")).filter(Boolean).join(" ");
      setText(status, refused ? refused : factor ? `Tuned by ${label}: detuned by a factor of ${formatNumber(factor)}.` : `Tuned by ${label}, each loop as if it were alone.`);
    } catch (error) {
      const { message, hint } = /** @type {any} */ (error);
      setText(status, [message, hint].map(sentence).filter(Boolean).join(" "));
    }
  }

  /** @param {number} index */
  function build(index) {
    const own = createCard(places, { id: `card-loop-${index + 1}`, title: `Loop ${index + 1}` });
    /** @param {string} label @param {{value: string, label: string, title?: string}[]} options @param {(value: any) => Partial<MimoLoop>} change */
    const choice = (label, options, change) => {
      const control = h("segmented-control", { label: `${label} of loop ${index + 1}` });
      control.options = options;
      control.addEventListener("value-change", () => store.setLoop(index, change(control.value)));
      return control;
    };
    const mode = choice("Mode", [{ value: "auto", label: "automatic" }, { value: "manual", label: "manual" }], (value) => ({ mode: value }));
    const type = choice("Controller type", ["P", "PI", "PID"].map((value) => ({ value, label: value })), (value) => ({ type: value }));
    const action = choice(
      "Action",
      [
        { value: "reverse", label: "reverse", title: "reverse: u falls when y rises, for a positive gain" },
        { value: "direct", label: "direct", title: "direct: u rises when y rises, for a negative gain" },
      ],
      (value) => ({ action: value }),
    );
    const knobs = KNOBS.map(({ name, min, max, time }) => {
      const slider = h("gain-slider", { name, min, max, above: "0", unit: time ? store.about.timeUnit : null });
      const take = (/** @type {boolean} */ moving) => (/** @type {Event} */ event) => store.setLoop(index, { [name]: /** @type {CustomEvent<{value: number}>} */ (event).detail.value }, { moving });
      slider.addEventListener("value-input", take(true));
      slider.addEventListener("value-change", take(false));
      return { name, slider };
    });
    own.body.append(h("div", { class: "row spread" }, mode, type), h("div", { class: "knobs" }, ...knobs.map(({ slider }) => slider)), h("div", { class: "row labelled" }, h("span", {}, "Action"), action));
    return (/** @type {MimoLoop} */ loop, /** @type {number} */ input) => {
      setText(/** @type {Element} */ (own.root.querySelector(".card-title")), `Loop ${index + 1}: y${index + 1} with u${input + 1}`);
      mode.value = loop.mode;
      type.value = loop.type;
      action.value = loop.action;
      for (const { name, slider } of knobs) {
        slider.hidden = (name === "tau_I" && loop.type === "P") || (name === "tau_D" && loop.type !== "PID");
        if (!slider.hidden) slider.value = loop[name];
      }
      own.summarise(`${loop.mode === "manual" ? "manual" : loop.type}, Kc ${loop.action === "direct" ? "−" : ""}${formatNumber(loop.Kc)}`);
    };
  }

  let built = "";
  function show() {
    const { loops, pairing: order } = store.get();
    const key = `${loops.length} ${store.about.timeUnit}`;
    if (built !== key) {
      built = key;
      places.replaceChildren();
      cards = loops.map((_, i) => build(i));
      setText(status, "");
    }
    straight.hidden = loops.length !== 2;
    pairing.value = order.join(",");
    for (const [i, loop] of loops.entries()) cards[i]?.(loop, order[i] ?? i);
    card.summarise(order.map((j, i) => `y${i + 1}–u${j + 1}`).join(", "));
  }
  store.subscribe(show);
  show();
}
