/** Step 2, the record growing as the experiment runs, with the knobs of its clock. */

/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {Ranges, Table} from "../../core/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { createPlayback, PLAYED_IN } from "../../core/playback.js";
import { formatNumber } from "../../core/format.js";
import { stairs } from "../../core/experiments/stairs.js";
import { calm } from "../../components/card.js";
import { h, setText } from "../../components/dom.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createSelectField } from "../../components/select-field.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { extent, niceRange } from "../../plots/axes.js";
import { experimentRunPlot } from "../../plots/experiments/run.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";

const HELP = "The output y and the input u as they are recorded. The experiment is played: pause it, go back, or change its speed. Circles are turning points. The menu saves the record as CSV.";
const STEPS = 1000;
const LONGEST_TICK = 0.1;

/** @param {Step} step @param {ExperimentBench} bench @param {{atOnce: () => boolean}} options  atOnce: the next result is shown whole */
export function mount(step, bench, { atOnce }) {
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  let frame = 0;
  let before = 0;
  let finished = true;
  const play = h("button", { type: "button", class: "button primary run-play", onclick: () => (player.playing ? player.pause() : player.play()) }, "Pause");
  const whole = h("button", { type: "button", class: "button", onclick: () => player.seek(player.end) }, "Show all");
  const clock = h("output", { class: "run-clock", "aria-label": "Simulated time" });
  const speed = createSelectField({ label: "Plays in", groups: [{ label: null, choices: PLAYED_IN.map((s) => ({ value: String(s), label: `${s} s` })) }], onChoice: (value) => player.setSeconds(Number(value)) });
  const scrub = h("input", { type: "range", class: "run-scrub", min: 0, max: STEPS, step: 1, value: 0, "aria-label": "Moment of the experiment" });
  scrub.addEventListener("input", () => player.seek(player.start + (Number(scrub.value) / STEPS) * (player.end - player.start)));
  const bar = h("div", { class: "run-bar" }, play, whole, clock, speed.root);
  const empty = h("p", { class: "empty" }, "Nothing has been done to the plant yet. Choose an experiment and begin it.");
  const panel = createPanelFrame(step.stage, { id: "experiment", title: "Record", help: HELP, figure: createFigure, table, arrange: ({ header, body }) => [header, body, scrub, bar] });
  step.stage.prepend(empty);
  const player = createPlayback({ onChange: refresh });
  speed.show(String(player.seconds));

  /** The curves of the answer that is there. */
  function curves() {
    const { answer, kind } = /** @type {import("../../core/experiments/types.js").Result} */ (bench.result);
    return kind === "hand" || kind === "search" ? answer.run : answer;
  }

  /** @returns {Table | null} */
  function table() {
    if (!bench.result) return null;
    const { t, u, y, r } = curves();
    const columns = r ? [t, r, u, y] : [t, u, y];
    return { header: [`t [${bench.about?.timeUnit}]`, ...(r ? ["r"] : []), "u", "y"], rows: t.map((/** @type {number} */ _, /** @type {number} */ k) => columns.map((column) => column[k])) };
  }

  /** @param {boolean} moving */
  function draw(moving) {
    const { result, about } = bench;
    if (!result || !about) return;
    const { t, u, y, r, turning_points: turns } = curves();
    const past = t.findIndex((/** @type {number} */ time) => time > player.clock);
    const n = past < 0 ? t.length : past;
    const held = result.kind === "step" || result.kind === "relay";
    const until = { t: t.slice(0, n), u: u.slice(0, n), y: y.slice(0, n) };
    const band = result.kind === "relay" ? bandOf(result.answer, player.end) : { t: r ? t : [], y: r ?? [] };
    const seen = (turns?.t ?? []).filter((/** @type {number} */ time) => time <= player.clock).length;
    const unit = (/** @type {string} */ name, /** @type {string} */ of) => (of ? `${name} [${of}]` : name);
    const relative = result.kind === "relay" && about.rest ? " from rest" : "";
    const figure = experimentRunPlot(
      {
        y: { t: until.t, y: until.y },
        u: held ? stairs(until.t, until.u) : { t: until.t, y: until.u },
        r: band,
        turns: { t: turns?.t.slice(0, seen) ?? [], y: turns?.y.slice(0, seen) ?? [] },
        window: [player.start, player.end],
        yRange: niceRange(...extent(y, band.y)),
        uRange: niceRange(...extent(u)),
        yName: unit(about.outputName + relative, about.outputUnit),
        uName: unit(about.inputName + relative, about.inputUnit),
        timeUnit: about.timeUnit,
      },
      theme,
      { ranges, moving },
    );
    ranges = figure.ranges;
    panel.show(figure, moving);
    setText(clock, `t = ${formatNumber(player.clock, 4)} ${about.timeUnit}`);
    if (document.activeElement !== scrub || player.playing) scrub.value = String(Math.round(((player.clock - player.start) / (player.end - player.start || 1)) * STEPS));
  }

  /** @param {number} now */
  function tick(now) {
    frame = 0;
    player.tick(Math.min(LONGEST_TICK, Math.max(0, (now - before) / 1000)));
    before = now;
    draw(player.playing);
    if (player.playing) frame ||= requestAnimationFrame(tick);
  }

  function refresh() {
    setText(play, player.playing ? "Pause" : player.done ? "Play again" : "Play");
    whole.disabled = player.done;
    if (!bench.result) return;
    if (player.playing && frame === 0) {
      before = performance.now();
      frame = requestAnimationFrame(tick);
    } else if (!player.playing) {
      draw(false);
      const { kind } = bench.result;
      panel.tell(`${kind === "step" ? "Step test" : kind === "relay" ? "Relay feedback" : "Proportional control"}, shown up to t = ${formatNumber(player.clock)} ${bench.about?.timeUnit ?? ""}.`, [
        ...(kind === "step" ? [] : [kind === "relay" ? { signal: "r", label: "dead band", name: "the relay switches at its edges", dash: "dash" } : { signal: "r", label: "r", name: "setpoint", dash: "dash" }]),
        { signal: "y", label: "y", name: "output, as measured" },
        { signal: "u", label: "u", name: SIGNALS["u"]?.name ?? "u" },
      ]);
    }
    if (player.done && !finished) {
      finished = true;
      bench.finish();
    }
  }

  function show() {
    const { result } = bench;
    panel.root.hidden = !result;
    ranges = {};
    finished = !result;
    if (!result) return player.pause();
    const { t } = curves();
    player.load(t[0] ?? 0, t.at(-1) ?? 1, calm() || atOnce());
  }

  /** By hand, a linear plant runs in a panel of its own. */
  function invite() {
    const { experiment, plant } = bench.setting;
    empty.hidden = Boolean(bench.result) || (experiment.kind === "hand" && plant.kind !== "library");
  }

  bench.on(["result"], show);
  bench.on(["result", "experiment"], invite);
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });
  show();
  invite();
}

/** The edges at which a relay with hysteresis switches, one line back and forth. @param {any} answer @param {number} end */
function bandOf({ relay }, end) {
  const edge = relay?.hysteresis ?? 0;
  return edge > 0 ? { t: [0, end, end, 0], y: [edge, edge, -edge, -edge] } : { t: [0, end], y: [0, 0] };
}
