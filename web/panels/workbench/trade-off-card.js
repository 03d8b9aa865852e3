/** From robust to fast on one slider: the best settings for each limit of Ms, and where the present loop lies beside them. */

/** @import {Api} from "../../core/api.js" */
/** @import {TradeOffPoint} from "../../core/workbench/analysis-types.js" */
/** @import {Store} from "../../core/store.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { formatFixed, formatNumber, sentence } from "../../core/format.js";
import { applySetting } from "../../core/workbench/loop.js";
import { clamp } from "../../core/scale.js";
import { betweenLimits, tradeOffRequest } from "../../core/workbench/tuning.js";
import { createCard } from "../../components/card.js";
import { h, setText } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { tradeOffCurve } from "../../components/trade-off-curve.js";

/** Parts that the drawn curve has between its ends. */
const PARTS = 40;
/** An error up to this many times the least is as good: the curve is drawn between a few searches. */
const ALIKE = 1.03;

/** @typedef {{points: TradeOffPoint[]}} TradeOffAnswer */

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const { answers } = store;
  /** @type {import("../../core/workbench/analysis.js").Analysis<TradeOffAnswer> | null} */
  let analysis = null;
  let stopWanting = () => {};
  /** @type {HTMLElementTagNameMap["gain-slider"] | null} */
  let slider = null;
  /** The settings that the slider made last: while they are in force it stays where it was put. */
  let made = "";
  /** The curve is of this answer. @type {TradeOffAnswer | null} */
  let drawn = null;
  /** @type {{Ms: number, value: number}[]} */
  let curve = [];

  const card = createCard(host, { id: "card-trade-off", title: "Robust or fast", open: false, onToggle: (open) => (open ? start() : stop()) });
  card.summarise("the best settings on a slider");
  const track = h("div", { class: "trade-off-slider" });
  const picture = h("div", {});
  const words = h("p", { class: "field-hint", role: "status" });
  card.body.append(track, picture, words);

  function start() {
    if (analysis) return;
    stopWanting = answers.want(["margins", "metrics"]);
    analysis = createAnalysis(store, { request: tradeOffRequest, send: (request) => api.analyse("tune/trade-off", request) }, show);
    show();
  }

  function stop() {
    stopWanting();
    analysis?.dispose();
    analysis = null;
  }

  const settings = () => JSON.stringify(store.get().controller);

  /** @param {TradeOffAnswer} answer */
  function build({ points }) {
    const kept = points.filter(({ optimum }) => optimum?.value);
    const [low, high] = [kept[0]?.Ms_limit ?? 0, kept.at(-1)?.Ms_limit ?? 0];
    curve = kept.length < 2 ? [] : Array.from({ length: PARTS + 1 }, (_, k) => low + (k * (high - low)) / PARTS).flatMap((Ms) => {
      const value = betweenLimits(points, Ms)?.value;
      return value ? [{ Ms, value }] : [];
    });
    slider = null;
    track.replaceChildren();
    if (curve.length < 2) return;
    const created = h("gain-slider", { label: "Ms up to", min: low, max: high, linear: true, hard: true });
    created.addEventListener("value-input", (event) => set(event, true));
    created.addEventListener("value-change", (event) => set(event, false));
    slider = created;
    track.append(slider, h("div", { class: "slider-ends", "aria-hidden": "true" }, h("span", {}, "robust"), h("span", {}, "fast")));
  }

  /** @param {Event} event @param {boolean} moving */
  function set(event, moving) {
    const { controller } = store.get();
    const setting = betweenLimits(analysis?.answer?.points ?? [], /** @type {CustomEvent<{value: number}>} */ (event).detail.value);
    if (!setting) return;
    const next = applySetting({ ...setting, type: controller.type }, controller);
    made = JSON.stringify(next);
    store.set({ controller: next }, { moving });
  }

  function present() {
    const Ms = answers.panels.margins?.Ms ?? null;
    const value = answers.panels.metrics?.[store.get().view.signal]?.IAE ?? null;
    return answers.error || Ms === null || value === null ? null : { Ms, value };
  }

  function show() {
    if (!analysis) return;
    const answer = analysis.answer;
    if (answer !== drawn) {
      drawn = answer;
      if (answer) build(answer);
    }
    const ready = answer !== null && curve.length > 0;
    card.body.classList.toggle("stale", analysis.pending && ready);
    track.hidden = picture.hidden = !ready;
    const now = present();
    if (ready) {
      picture.replaceChildren(tradeOffCurve(curve, now));
      const [low, high] = [curve[0]?.Ms ?? 1, curve.at(-1)?.Ms ?? 2];
      if (slider && now && settings() !== made) slider.value = Number(clamp(now.Ms, low, high).toPrecision(3));
    }
    setText(words, said(now));
  }

  /** @param {{Ms: number, value: number} | null} now */
  function said(now) {
    const { controller, view, actuator, sensor } = store.get();
    if (analysis?.error) return sentence(analysis.error.message);
    if (!tradeOffRequest(store.get())) return "For PI and PID: choose one in the Controller card.";
    if (!analysis?.answer) return "Searching the best settings…";
    if (curve.length === 0) return sentence(analysis.answer.points.at(-1)?.reason ?? "no settings were found");
    const left = actuator.trim() || sensor.trim() ? " Actuator and sensor are left out of the search." : "";
    if (!now) return `The present loop is not stable, or its error does not end: move the slider.${left}`;
    const best = betweenLimits(analysis.answer.points, now.Ms)?.value ?? null;
    const here = `■ Now: Ms ${formatFixed(now.Ms, 2)}, IAE ${formatNumber(now.value)} after a ${view.signal} step.`;
    if (settings() === made || (best !== null && now.value < ALIKE * best)) return `${here} No ${controller.type} does much better with this Ms.${left}`;
    return `${here} ${best === null ? "The curve shows the best for each Ms." : `The best ${controller.type} with this Ms reaches ${formatNumber(best)}.`}${left}`;
  }

  const stopAnswers = answers.subscribe(show);
  const stopStore = store.subscribe((_, change) => {
    if (change.view) show();
  });
  return () => {
    stopAnswers();
    stopStore();
    stop();
    card.root.remove();
  };
}
