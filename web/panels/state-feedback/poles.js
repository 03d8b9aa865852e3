/** Where the poles go: dragged in the s-plane, typed, or found by weights; and those of the observer. */

/** @import {FeedbackSession} from "../../core/state-feedback/session.js" */
/** @import {Complex, Ranges, Table} from "../../core/types.js" */

import { parsePoles, polesLine, stateCount, weightsOf, written } from "../../core/state-feedback/feedback.js";
import { formatComplex } from "../../core/roots.js";
import { tidy } from "../../core/scale.js";
import { h, set, setText, uniqueId } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createPlaneHandle } from "../../components/plane-handle.js";
import "../../components/segmented-control.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { feedbackPolesPlot } from "../../plots/state-feedback/poles.js";

/** One press of an arrow key. */
const KEY_STEP = 0.1;

/** Reals first, then each pair. @param {Complex[]} poles @returns {Complex[]} */
function ordered(poles) {
  const real = poles.filter(([, im]) => im === 0);
  return [...real, ...poles.filter(([, im]) => im > 0).flatMap(([re, im]) => /** @type {Complex[]} */ ([[re, im], [re, -im]]))];
}

/** @param {HTMLElement} host @param {FeedbackSession} session */
export function mount(host, session) {
  const method = h("segmented-control", { label: "How the gain is found", class: "small" });
  method.options = [
    { value: "poles", label: "Poles", title: "Say where the closed-loop poles are" },
    { value: "lqr", label: "LQR", title: "Say what deviations and effort cost; the gain of least cost follows" },
  ];
  method.addEventListener("value-change", () => {
    if (method.value === "lqr") session.set({ method: "lqr" });
    else session.set({ method: "poles", poles: ordered(session.state.poles.length === wanted() ? session.state.poles : rounded(session.design?.feedback.obtained ?? [])) });
  });
  /** @type {import("../../plots/figure.js").FigureHandle | null} */
  let figure = null;
  /** @type {HTMLElement | null} */
  let plane = null;
  const frame = createPanelFrame(host, {
    id: "feedback-poles",
    title: "Poles",
    help: "Crosses: the plant by itself. Squares: the plant under feedback; drag them, or use the arrow keys. Circles: the observer. Left of the axis is stable; farther left is faster and takes more force.",
    controls: [method],
    figure(element) {
      plane = element;
      figure = createFigure(element);
      element.addEventListener("figure-drawn", place);
      return figure;
    },
    table,
  });
  const hint = uniqueId("poles-message");
  const typed = h("input", { type: "text", class: "list-input", id: uniqueId("poles"), autocomplete: "off", spellcheck: "false", "aria-describedby": hint });
  const message = h("span", { class: "field-message", id: hint });
  const typing = h("div", { class: "list-field" }, h("label", { for: typed.id, class: "field-label" }, "Poles"), typed, message);
  typed.addEventListener("change", () => {
    const poles = parsePoles(typed.value);
    const complaint = poles === null ? "Type poles like -2+1i, -2-1i, -5." : poles.length !== wanted() ? `${wanted()} poles are needed: one for each state${session.state.integral ? " and one for the integral" : ""}.` : "";
    setText(message, complaint);
    set(typed, { "aria-invalid": complaint ? "true" : null });
    if (poles && !complaint) session.set({ poles });
  });
  const weights = h("div", { class: "feedback-weights" });
  frame.root.append(h("div", { class: "feedback-form" }, typing, weights));

  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  /** @type {{handle: ReturnType<typeof createPlaneHandle>, index: number}[]} */
  let handles = [];
  let kinds = "";
  let built = "";
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });

  const wanted = () => stateCount(session.state) + (session.state.integral ? 1 : 0);
  /** @param {Complex[]} poles */
  const rounded = (poles) => poles.map(([re, im]) => /** @type {Complex} */ ([Number(re.toPrecision(3)), Number(im.toPrecision(3))]));

  function place() {
    for (const { handle } of handles) handle.place();
  }

  /** @param {number} index @param {{x: number, y: number}} value @param {boolean} moving */
  function move(index, { x, y }, moving) {
    const poles = session.state.poles.map((pole) => /** @type {Complex} */ ([...pole]));
    const pole = poles[index];
    if (!pole) return;
    const re = tidy(x);
    if (pole[1] === 0 && !kinds[index]?.startsWith("p")) poles[index] = [re, 0];
    else {
      const im = Math.abs(tidy(y)) < 0.02 * (ranges["yaxis"]?.[1] ?? 1) ? 0 : Math.abs(tidy(y));
      poles[index] = [re, im];
      poles[index + 1] = [re, im === 0 ? 0 : -im];
    }
    session.set({ poles: moving ? poles : ordered(poles) }, { moving });
  }

  /** A handle for each real pole and for each pair; made anew only at rest. @param {boolean} moving */
  function showHandles(moving) {
    const { poles, method: how } = session.state;
    const now = how === "poles" ? poles.map(([, im]) => (im === 0 ? "r" : im > 0 ? "p" : "-")).join("") : "";
    if (now !== kinds && !moving) {
      for (const { handle } of handles) {
        handle.dispose();
        handle.root.remove();
      }
      kinds = now;
      handles = [...now].flatMap((kind, index) => {
        if (kind === "-") return [];
        const handle = createPlaneHandle({
          toPixels: (value) => figure?.pixelsOf(value) ?? null,
          toValues: (pixels) => figure?.valuesAt(pixels) ?? null,
          step: (value, across, up) => ({ x: value.x + KEY_STEP * across, y: kind === "p" ? Math.max(0, value.y + KEY_STEP * up) : 0 }),
          describe: ({ x, y }) => `Closed-loop pole ${kind === "p" ? `pair at ${formatComplex([x, y])}` : `at ${formatComplex([x, 0])}`}. Arrow keys move it.`,
          onMove: (value, still) => move(index, kind === "p" ? value : { x: value.x, y: 0 }, still),
        });
        plane?.parentElement?.append(handle.root);
        return [{ handle, index }];
      });
    }
    for (const { handle, index } of handles) {
      const pole = poles[index];
      handle.show(pole ? { x: pole[0], y: pole[1] } : null);
    }
  }

  /** @param {boolean} moving */
  function draw(moving) {
    const { design, state } = session;
    if (!design) return;
    const shown = feedbackPolesPlot({ plant: design.poles, feedback: state.method === "poles" && state.poles.length > 0 ? state.poles : design.feedback.obtained, observer: design.observer?.obtained ?? [] }, theme, { ranges, moving });
    ranges = shown.ranges;
    frame.show(shown, moving);
    showHandles(moving);
  }

  /** @returns {Table | null} */
  function table() {
    const { design } = session;
    if (!design) return null;
    /** @param {string} of @param {Complex[]} poles */
    const list = (of, poles) => poles.map(([re, im]) => [of, re, im]);
    return { header: ["of", "Re", "Im"], rows: [...list("plant", design.poles), ...list("feedback", design.feedback.obtained), ...list("observer", design.observer?.obtained ?? [])] };
  }

  function buildWeights() {
    const { state, design } = session;
    const names = [...(design?.states ?? []).map(({ name }) => name), ...(state.integral ? ["∫ error"] : [])];
    const now = JSON.stringify([state.plant, names]);
    if (now === built) return;
    built = now;
    /** @param {string} label @param {number} value @param {(value: number) => object} patch */
    const slider = (label, value, patch) => {
      const field = h("gain-slider", { label, min: 0.01, max: 100 });
      field.value = value;
      field.addEventListener("value-input", () => session.set(patch(field.value), { moving: true }));
      field.addEventListener("value-change", () => session.set(patch(field.value)));
      return field;
    };
    weights.replaceChildren(
      ...names.map((name, i) => slider(`Weight of ${written(name)}`, weightsOf(state)[i] ?? 1, (value) => ({ weights: weightsOf(session.state).map((old, k) => (k === i ? value : old)) }))),
      slider("Weight of effort", state.effort, (effort) => ({ effort })),
    );
  }

  return {
    /** @param {{anew: boolean, moving: boolean}} how */
    refresh({ anew, moving }) {
      const { state } = session;
      if (anew) ranges = {};
      method.value = state.method;
      typing.hidden = state.method !== "poles";
      weights.hidden = state.method !== "lqr";
      if (document.activeElement !== typed && state.method === "poles") {
        typed.value = polesLine(state.poles);
        setText(message, "");
        set(typed, { "aria-invalid": null });
      }
      buildWeights();
      draw(moving);
      if (moving || !session.design) return;
      const { plant, feedback } = { plant: session.design.poles, feedback: session.design.feedback.obtained };
      frame.tell(`Poles of the plant: ${polesLine(plant)}. Under feedback: ${polesLine(feedback)}.`, [
        { signal: "sum", label: "plant", name: "poles without feedback", glyph: "×" },
        { signal: "pole", label: "feedback", name: "poles under feedback", glyph: "■" },
        ...(session.design.observer ? [{ signal: "P", label: "observer", name: "poles of the estimate's error", glyph: "○" }] : []),
      ]);
    },
  };
}
