/** The curves of the run, growing with it, over what the linear model predicts. */

/** @import {FeedbackSession} from "../../core/state-feedback/session.js" */
/** @import {FeedbackRow} from "../../plots/state-feedback/run.js" */
/** @import {Ranges, Table} from "../../core/types.js" */

import { horizonOf } from "../../core/state-feedback/feedback.js";
import { formatNumber } from "../../core/format.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { feedbackRunPlot } from "../../plots/state-feedback/run.js";

/** ms between two drawings: a curve that grows is smooth at this. */
const EVERY = 40;

/** @param {HTMLElement} host @param {FeedbackSession} session */
export function mount(host, session) {
  const frame = createPanelFrame(host, {
    id: "feedback-run",
    title: "Run",
    help: "Solid: what the plant does, by its own nonlinear equations, limits included. Dashed: what the linear model predicts. Where they part, the linear law no longer knows its plant. Dotted: limits in red, and what an observer takes the states for.",
    figure: createFigure,
    table,
  });
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  let drawn = 0;
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });

  /** @returns {FeedbackRow[]} */
  function rows() {
    const { run, design, profile, state } = session;
    if (!run || !design) return [];
    const found = run.nonlinear ?? run.linear;
    if (!found) return [];
    const until = found.t.findIndex((t) => t > session.clock + 1e-12);
    const stop = found.t.findIndex((t) => t > session.end + 1e-12);
    const [count, whole] = [until < 0 ? found.t.length : until, stop < 0 ? found.t.length : stop];
    const now = session.values();
    const linear = run.nonlinear ? run.linear : null;
    const shown = profile.id === "matrices" ? design.states.slice(0, 3).map(({ name }) => name) : [...new Set([...profile.tilts.slice(0, 1).map((tilt) => tilt.state), profile.controlled])];
    /** @param {string} name @param {"states" | "outputs" | "inputs"} kind @param {string} signal @param {number[]} limits @returns {FeedbackRow} */
    const row = (name, kind, signal, limits) => {
      const tilt = profile.tilts.find((each) => each.state === name && each.unit === "°");
      const factor = tilt?.factor ?? 1;
      const unit = tilt?.unit ?? [...design.states, ...design.outputs, ...design.inputs].find((each) => each.name === name)?.unit ?? "";
      const scaled = (/** @type {number[] | undefined} */ values) => (values ?? []).map((value) => factor * value);
      const column = found[kind][name];
      return { name: tilt ? "tilt" : name, unit, signal, t: [...found.t.slice(0, count), session.clock], values: scaled([...(column ?? []).slice(0, count), now[name] ?? NaN]), whole: scaled((column ?? []).slice(0, whole)), predictedT: linear?.t ?? [], predicted: scaled(linear?.[kind][name]), estimate: scaled(found.estimates?.[name]?.slice(0, count)), limits };
    };
    const input = design.inputs[0]?.name ?? "";
    const track = profile.id === "cart-pendulum" && !state.endless ? [-1.2, 1.2] : [];
    return [
      ...shown.map((name, i) => row(name, name in found.states ? "states" : "outputs", i === 0 ? "y" : "y_m", name === "x" ? track : [])),
      row(input, "inputs", "u", state.limit === null || !profile.limit ? [] : [-state.limit, state.limit]),
    ];
  }

  /** @param {boolean} moving */
  function draw(moving) {
    const { run, design, state } = session;
    if (!run || !design) return;
    const figure = feedbackRunPlot({ rows: rows(), horizon: horizonOf(state, design, [...session.pushes]), cursor: session.clock, timeUnit: design.time_unit }, theme, { ranges, moving });
    ranges = figure.ranges;
    frame.show(figure, moving);
  }

  /** @returns {Table | null} */
  function table() {
    const found = session.run?.nonlinear ?? session.run?.linear;
    if (!found || !session.design) return null;
    const columns = [...Object.entries(found.states), ...Object.entries(found.inputs)];
    return { header: [`t [${session.design.time_unit}]`, ...columns.map(([name]) => name)], rows: found.t.map((t, k) => [t].concat(columns.map(([, values]) => values[k] ?? NaN))) };
  }

  function tell() {
    const words = rows().map(({ name, unit, values }) => `${name} is ${formatNumber(values.at(-1))} ${unit}`);
    frame.tell(`At t = ${formatNumber(session.clock)}: ${words.join(", ")}.`, [
      { signal: "y", label: "plant", name: "by the plant's own equations" },
      ...(session.design?.observer ? [{ signal: "d", label: "estimate", name: "what the observer takes the state for", dash: "dot" }] : []),
      ...(session.run?.nonlinear ? [{ signal: "rule", label: "linear model", name: "by the model that the feedback was designed on", dash: "dash" }] : []),
    ]);
  }

  return {
    /** @param {number} now  ms */
    frame(now) {
      if (now - drawn < EVERY) return;
      drawn = now;
      draw(true);
    },
    /** @param {{anew: boolean, moving: boolean}} how  anew: another plant, with axes of its own */
    refresh({ anew, moving }) {
      if (anew) ranges = {};
      draw(moving && !anew);
      if (!moving) tell();
    },
  };
}
