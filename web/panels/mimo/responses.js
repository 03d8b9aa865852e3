/** What all loops do after one step: live while a knob moves. */

/** @import {Api} from "../../core/api.js" */
/** @import {MimoState, MimoStore} from "../../core/mimo/mimo.js" */
/** @import {Numbers, Ranges} from "../../core/types.js" */

import { formatWithUnit, sentence } from "../../core/format.js";
import { loopsRequest, testOf } from "../../core/mimo/mimo.js";
import { createTransport } from "../../core/transport.js";
import { h } from "../../components/dom.js";
import { number } from "../../components/form-parts.js";
import { icon } from "../../components/icons.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createSelectField } from "../../components/select-field.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { mimoResponsesPlot } from "../../plots/mimo/responses.js";

/**
 * @typedef {{t: Numbers, y: Numbers[], u: Numbers[], horizon: number, time_unit: string, verdict: {verdict: string, stable: boolean, because: string} | null,
 *   truncated_reason: string | null, reasons: Record<string, string>}} Answer
 */

const POINTS = { moving: 250, rest: 600 };
/** Width from which outputs and inputs stand side by side [px]. */
const WIDE = 620;

/** @param {HTMLElement} host @param {MimoStore} store @param {Api} api @param {{onError: (error: any) => void}} options */
export function mount(host, store, api, { onError }) {
  /** @type {{answer: Answer, state: MimoState} | null} */
  let found = null;
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  let drawnFor = "";
  let asked = "";
  let drawnWide = false;
  let stable = true;
  const verdict = h("p", { class: "mimo-verdict", role: "status" });
  const place = h("div", { class: "mimo-form" });
  const frame = createPanelFrame(host, {
    id: "mimo-responses",
    title: "Responses",
    help: "Every output and every input after one step, all loops as they are set; dead times are exact. A loop in manual holds its input; stepping its setpoint would move nothing, so the step is that of its input.",
    figure: createFigure,
    table: () => {
      if (!found) return null;
      const { answer } = found;
      return { header: [`t [${answer.time_unit}]`, ...names("outputs"), ...names("inputs")], rows: Array.from(answer.t, (t, k) => [t, ...[...answer.y, ...answer.u].map((values) => values[k] ?? null)]) };
    },
    arrange: ({ header, body, note }) => [header, place, verdict, body, note],
  });
  frame.root.classList.add("mimo-panel");
  const body = /** @type {HTMLElement} */ (frame.root.querySelector(".panel-body"));
  // Without a width, while it is being laid out, it stays as it is.
  const wide = () => (body.clientWidth === 0 ? drawnWide : body.clientWidth >= WIDE);

  /** @param {"outputs" | "inputs"} kind */
  function names(kind) {
    const letter = kind === "outputs" ? "y" : "u";
    return store.get().loops.map((_, i) => store.about[kind][i]?.name ?? `${letter}${i + 1}`);
  }
  /** @param {"outputs" | "inputs"} kind @param {number} i */
  const unitOf = (kind, i) => (store.about[kind][i]?.unit ?? "").replace(/^-$/, "");

  let built = "";
  function buildForm() {
    const { loops, test } = store.get();
    const manual = loops.map(({ mode }) => mode === "manual");
    const key = JSON.stringify([manual, test.kind, test.loop, store.about]);
    if (built === key) {
      size.value = store.get().test.size;
      return;
    }
    built = key;
    const focused = document.activeElement instanceof HTMLSelectElement && place.contains(document.activeElement);
    const select = createSelectField({
      label: "Step of",
      groups: [
        { label: null, choices: loops.map((_, i) => ({ value: `setpoint ${i}`, label: manual[i] ? `output of controller ${i + 1}, in manual` : `setpoint of y${i + 1}` })) },
        { label: null, choices: loops.map((_, j) => ({ value: `load ${j}`, label: `load with u${j + 1}` })) },
      ],
      onChoice(value) {
        const [kind, loop] = value.split(" ");
        store.set({ test: { ...store.get().test, kind: kind === "load" ? "load" : "setpoint", loop: Number(loop) } });
      },
    });
    select.show(`${test.kind} ${test.loop}`);
    const own = test.kind === "setpoint" && !manual[test.loop] ? unitOf("outputs", test.loop) : unitOf("inputs", test.kind === "load" ? test.loop : (store.get().pairing[test.loop] ?? 0));
    size = number("Size", { value: test.size, unit: own }, () => {
      if (size.value) store.set({ test: { ...store.get().test, size: size.value } });
    });
    place.replaceChildren(select.root, size);
    if (focused) place.querySelector("select")?.focus();
  }
  let size = number("Size", { value: 1 }, () => {});

  const transport = createTransport({
    send: (/** @type {{state: MimoState, moving: boolean}} */ { state, moving }) => {
      const { kind, loop, size: amplitude } = testOf(state);
      return api.analyse("mimo/simulate", { ...loopsRequest(state), changes: [{ kind, loop: loop + 1, size: amplitude }], points: moving ? POINTS.moving : POINTS.rest, verdict: !moving, arrays: "f4" });
    },
    onAnswer(/** @type {Answer} */ answer, { state, moving }) {
      found = { answer, state };
      onError(null);
      frame.root.classList.remove("stale");
      draw(moving);
    },
    onError(error) {
      frame.root.classList.add("stale");
      verdict.dataset["verdict"] = "marginal";
      verdict.replaceChildren(icon("marginal"), [error.message, error.hint].map(sentence).filter(Boolean).join(" "));
      onError(error);
    },
    retryAfter: (error) => error.retryAfter ?? null,
  });

  /** @param {boolean} moving */
  function draw(moving) {
    if (!found) return;
    const { answer, state } = found;
    const test = testOf(state);
    drawnWide = wide();
    const subject = JSON.stringify([state.plant, state.entries, test, drawnWide]);
    if (!moving && subject !== drawnFor) {
      ranges = {};
      drawnFor = subject;
    }
    const rows = state.loops.map((loop, i) => ({ name: names("outputs")[i] ?? "", unit: unitOf("outputs", i), values: answer.y[i] ?? [], setpoint: loop.mode === "auto" ? (test.kind === "setpoint" && test.loop === i ? test.size : 0) : null }));
    const inputs = state.loops.map((_, j) => ({ name: names("inputs")[j] ?? "", unit: unitOf("inputs", j), values: answer.u[j] ?? [], setpoint: null }));
    frame.root.style.setProperty("--rows", String(drawnWide ? rows.length : 2 * rows.length));
    const figure = mimoResponsesPlot({ t: answer.t, outputs: rows, inputs, horizon: answer.horizon, timeUnit: answer.time_unit, stable: answer.truncated_reason === null && (answer.verdict?.stable ?? stable), size: test.size, wide: drawnWide }, theme, { ranges, moving });
    ranges = figure.ranges;
    frame.show(figure, moving);
    verdict.classList.toggle("moving", moving);
    // What was asked for while a knob moved came without one; the next answer brings it.
    if (moving || answer.reasons["verdict"] === "not asked for") return;
    const told = answer.verdict?.verdict ?? "marginal";
    stable = answer.verdict?.stable ?? false;
    const words = answer.verdict ? `${told}: ${answer.verdict.because}` : sentence(answer.reasons["verdict"]);
    if (verdict.dataset["told"] !== words) {
      Object.assign(verdict.dataset, { told: words, verdict: told });
      verdict.replaceChildren(icon(told), h("strong", {}, sentence(told).replace(".", "")), h("span", {}, answer.verdict ? sentence(answer.verdict.because) : words));
    }
    const ends = rows.map(({ name, unit, values }) => `${name} ${formatWithUnit(values[values.length - 1] ?? 0, unit)}`);
    frame.note(answer.truncated_reason ? sentence(answer.truncated_reason) : "");
    frame.tell(`Responses to a ${test.kind} step of ${formatWithUnit(test.size, "")} in loop ${test.loop + 1}. At the end: ${ends.join(", ")}. The loops are ${told}.`, [
      { signal: "y", label: "y", name: "outputs" },
      { signal: "r", label: "r", name: "setpoints", dash: "dash" },
      { signal: "u", label: "u", name: "inputs" },
    ]);
  }

  store.subscribe((state, { moving }) => {
    if (!moving) buildForm();
    const key = JSON.stringify([loopsRequest(state), testOf(state), moving]);
    if (key === asked) return draw(moving);
    asked = key;
    transport.push({ state, moving });
  });
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });
  new ResizeObserver(() => {
    if (wide() !== drawnWide) draw(false);
  }).observe(body);
  buildForm();
  asked = JSON.stringify([loopsRequest(store.get()), testOf(store.get()), false]);
  transport.push({ state: store.get(), moving: false });
}
