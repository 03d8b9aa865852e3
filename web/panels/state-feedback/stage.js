/** The plant itself, moved by the run: how it starts, the button that lets it go, and how it ended. */

/** @import {Api} from "../../core/api.js" */
/** @import {FeedbackSession} from "../../core/state-feedback/session.js" */
/** @import {FeedbackRun} from "../../core/state-feedback/feedback.js" */

import { runRequest, verdictOf } from "../../core/state-feedback/feedback.js";
import { formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { h, set, setText } from "../../components/dom.js";
import "../../components/gain-slider.js";
import "../../components/plant-schematic.js";
import "../../components/segmented-control.js";

const STEPS = 1000;
const PACES = [
  { value: "1", label: "Real time", title: "As fast as it happens" },
  { value: "0.25", label: "Slow", title: "A quarter of that" },
];

/** What is to blame, by the first trial that is caught. */
const CONCLUSIONS = ["It is the motor that is too weak.", "It is the track that is too short.", "Motor and track are both too small.", "It is the observer: until its estimate has found the tilt, the law pushes the wrong amount."];
const FAR = "Neither motor nor track is to blame: this far from upright the linear model is wrong, and its law pushes the wrong amount. Map the region below to see how far it holds.";

/**
 * @param {HTMLElement} host
 * @param {FeedbackSession} session
 * @param {Api} api
 * @param {Map<string, import("../../core/plant/types.js").PlantSummary>} plants
 */
export function mount(host, session, api, plants) {
  const picture = h("div", { class: "feedback-drawing" });
  const tilts = h("div", { class: "feedback-tilts" });
  const go = h("button", { type: "button", class: "button primary feedback-go", onclick: () => session.letGo() }, "Let go");
  const pause = h("button", { type: "button", class: "button", onclick: () => (session.playing ? session.pause() : session.play()) }, "Pause");
  const left = h("button", { type: "button", class: "button", onclick: () => session.push(-1) }, "← Push");
  const right = h("button", { type: "button", class: "button", onclick: () => session.push(1) }, "Push →");
  const clock = h("output", { class: "feedback-clock", "aria-label": "Time of the run" });
  const pace = h("segmented-control", { label: "Pace", class: "small" });
  pace.options = PACES;
  pace.value = "1";
  pace.addEventListener("value-change", () => (session.pace = Number(pace.value)));
  const scrub = h("input", { type: "range", class: "feedback-scrub", min: 0, max: STEPS, step: 1, value: 0, "aria-label": "Moment of the run" });
  scrub.addEventListener("input", () => session.seek((Number(scrub.value) / STEPS) * session.end));
  const verdict = h("p", { class: "feedback-verdict", role: "status" });
  const why = h("button", { type: "button", class: "button small", onclick: () => void explain() }, "Why?");
  const because = h("div", { class: "feedback-because", "aria-live": "polite" });
  host.append(
    h(
      "section",
      { class: "feedback-stage", "aria-label": "The plant" },
      picture,
      h("div", { class: "feedback-start" }, tilts, go),
      h("div", { class: "feedback-told" }, verdict, why),
      because,
      scrub,
      h("div", { class: "feedback-bar" }, pause, left, right, clock, pace),
    ),
  );
  const drawing = document.createElement("plant-schematic");
  let shownPlant = "";
  let asked = "";

  function build() {
    shownPlant = session.state.plant;
    const summary = plants.get(shownPlant);
    picture.replaceChildren();
    if (summary?.drawing) {
      picture.append(drawing);
      drawing.drawing = summary.drawing;
      drawing.values = summary.values;
    }
    picture.hidden = !summary?.drawing;
    tilts.replaceChildren(
      ...(session.state.plant === "matrices" ? session.state.matrices.A.map((_, i) => ({ state: `x${i + 1}`, label: `x${i + 1} starts at`, factor: 1, unit: "", min: -2, max: 2, step: 0.1 })) : session.profile.tilts).slice(0, 4).map((tilt) => {
        const slider = h("gain-slider", { label: tilt.label, unit: tilt.unit, min: tilt.min, max: tilt.max, linear: true, step: tilt.step, hard: session.state.plant !== "matrices" });
        slider.value = Number((tilt.factor * (session.state.start[tilt.state] ?? 0)).toPrecision(4));
        slider.dataset["state"] = tilt.state;
        slider.dataset["factor"] = String(tilt.factor);
        const move = (/** @type {boolean} */ moving) => session.set({ start: { ...session.state.start, [tilt.state]: slider.value / tilt.factor } }, { moving });
        slider.addEventListener("value-input", () => move(true));
        slider.addEventListener("value-change", () => move(false));
        return slider;
      }),
    );
    const { push } = session.profile;
    for (const [button, way] of /** @type {[HTMLElement, string][]} */ ([[left, "to the left"], [right, "to the right"]])) set(button, { title: push ? `${push.label} ${shownPlant === "cart-pendulum" ? way : ""}`.trim() : null });
    left.hidden = right.hidden = push === null;
    if (shownPlant !== "cart-pendulum") {
      setText(left, "− Pulse");
      setText(right, "+ Pulse");
    } else {
      setText(left, "← Push");
      setText(right, "Push →");
    }
  }

  function showTilts() {
    for (const slider of tilts.querySelectorAll("gain-slider")) {
      const value = Number((Number(slider.dataset["factor"]) * (session.state.start[slider.dataset["state"] ?? ""] ?? 0)).toPrecision(4));
      if (slider.value !== value && !slider.contains(document.activeElement)) slider.value = value;
    }
  }

  function tell() {
    const { run, design, error } = session;
    because.hidden = asked === "" || asked !== keyOf(run);
    if (error) {
      set(verdict, { "data-kind": "bad" });
      verdict.replaceChildren(h("strong", {}, "No such feedback. "), sentence(error.message), error.hint ? ` ${sentence(error.hint)}` : "");
      why.hidden = true;
      return;
    }
    if (!run || !design) return;
    if (!session.finished) {
      set(verdict, { "data-kind": "open" });
      const text = session.playing ? "Running…" : session.clock > 0 ? "Paused." : session.state.plant === "cart-pendulum" ? "Tilt the rod, then press Let go." : "Choose a start, then press Let go.";
      if (verdict.textContent !== text) verdict.replaceChildren(text);
      why.hidden = true;
      return;
    }
    const { kind, head, text } = verdictOf(session.state, design, run);
    set(verdict, { "data-kind": kind });
    if (verdict.textContent !== `${head} ${text}`) verdict.replaceChildren(h("strong", {}, head), ` ${text}`);
    why.hidden = kind !== "bad" || session.profile.endless === null || !run.nonlinear || !because.hidden;
  }

  /** @param {FeedbackRun | null} run */
  const keyOf = (run) => (run ? JSON.stringify([session.state, session.pushes.length]) : "");

  /** The same start without what may have stopped it. */
  async function explain() {
    const { design, run, state } = session;
    if (!design || !run) return;
    asked = keyOf(run);
    because.hidden = false;
    because.replaceChildren(h("p", { class: "finding" }, "Trying it without the limits…"));
    const trials = [
      { name: "a motor without limit", instead: { free: true } },
      { name: "a track without end", instead: { endless: true } },
      { name: "both", instead: { free: true, endless: true } },
      ...(state.observer ? [{ name: "both, and every state measured", instead: { free: true, endless: true, seen: true } }] : []),
    ];
    try {
      const found = await Promise.all(trials.map(({ instead }) => api.analyse("state-feedback/simulate", { ...runRequest(state, design, [], instead), points: 201 })));
      if (asked !== keyOf(session.run)) return;
      const saved = found.map((/** @type {FeedbackRun} */ trial) => trial.nonlinear?.outcome === "caught");
      const lines = trials.map(({ name }, i) => {
        const trial = /** @type {FeedbackRun} */ (found[i]);
        const event = trial.nonlinear?.events[0];
        return h("li", { "data-kind": saved[i] ? "good" : "bad" }, h("span", {}, `With ${name}: `), h("strong", {}, saved[i] ? "caught" : `lost${event ? `, ${event.message} after ${formatNumber(event.t, 2)} ${design.time_unit}` : ""}`));
      });
      const conclusion = design.closed_loop_stable ? (CONCLUSIONS[saved.indexOf(true)] ?? FAR) : "The feedback itself is unstable: a pole lies right of the axis.";
      because.replaceChildren(h("p", {}, "The same start again,"), h("ul", {}, ...lines), h("p", {}, h("strong", {}, conclusion)));
    } catch (error) {
      because.replaceChildren(h("p", { class: "finding" }, sentence(/** @type {Error} */ (error).message)));
    }
    tell();
  }

  return {
    /** Once for every frame of the screen. */
    frame() {
      const values = session.values();
      if (Object.keys(values).length > 0 && !picture.hidden) drawing.values = values;
      const unit = session.design?.time_unit ?? "s";
      setText(clock, `t = ${formatNumber(session.clock, 3)} ${unit}`);
      if (document.activeElement !== scrub || session.playing) scrub.value = String(Math.round((session.clock / (session.end || 1)) * STEPS));
      set(scrub, { "aria-valuetext": `t = ${formatWithUnit(session.clock, unit)}` });
    },
    refresh() {
      if (shownPlant !== session.state.plant || (shownPlant === "matrices" && tilts.children.length !== Math.min(4, session.state.matrices.A.length))) build();
      drawing.units = Object.fromEntries([...(session.design?.states ?? []), ...(session.design?.inputs ?? [])].map(({ name, unit }) => [name, unit]));
      drawing.still = !session.playing;
      setText(pause, session.playing ? "Pause" : "Play");
      set(go, { "data-waiting": session.clock === 0 && !session.playing ? "" : null });
      showTilts();
      tell();
    },
  };
}
