/** Step 2 by hand: the loop runs on while the gain is moved, and the page says whether it decays, rings on or grows. */

/** @import {Api} from "../../core/api.js" */
/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {ProportionalLoop} from "../../core/experiments/proportional-loop.js" */
/** @import {Ranges, Table} from "../../core/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { filledIn, systemOf } from "../../core/experiments/requests.js";
import { formatNumber, formatWithUnit } from "../../core/format.js";
import { patiently } from "../../core/patience.js";
import { round125 } from "../../core/plant/pace.js";
import { createProportionalLoop } from "../../core/experiments/proportional-loop.js";
import { createSwings, judge } from "../../core/experiments/swings.js";
import { h, setText } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createSelectField } from "../../components/select-field.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { experimentRunPlot } from "../../plots/experiments/run.js";
import { createFigure } from "../../plots/figure.js";

const HELP = "Start the loop and raise Kc step by step; after each change, watch a few swings, and bump the setpoint where they have died out. Between decaying and growing lies the gain at which they go on for ever: Ku. Circles are the peaks that the verdict is made of.";
/** Steps of the simulation in a period, periods in the window, seconds that one lasts. */
const PER_PERIOD = 240;
const IN_WINDOW = 12;
const SECONDS = 1.5;
const EVERY = 50;
const LONGEST_TICK = 0.1;
/** Swings below this part of the setpoint's step have died out. */
const LEAST = 2e-3;
const SPEEDS = [0.5, 1, 3];
/** Periods without a turn after which nothing more is to come. */
const DEAD = 1.5;
const DIED_OUT = { word: "died out", next: "Raise Kc and bump the setpoint." };
/** @type {Record<ReturnType<typeof judge>["verdict"], {word: string, next: string}>} */
const VERDICTS = {
  "too few": { word: "too few swings to judge", next: "Wait for a few swings; if none come, raise Kc or bump the setpoint." },
  decaying: { word: "decaying", next: "Raise Kc." },
  sustained: { word: "sustained", next: "This is the ultimate gain, as far as the eye can tell." },
  growing: { word: "growing", next: "Lower Kc before the loop runs away." },
};

/** @param {Step} step @param {ExperimentBench} bench @param {Api} api */
export function mount(step, bench, api) {
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  /** @type {ProportionalLoop | null} */
  let loop = null;
  let swings = createSwings(LEAST);
  let [read, since, clock, playing, runaway] = [0, -Infinity, 0, false, false];
  let [frame, before, drawn, base, pace, asked] = [0, 0, 0, 0, 1, 0];

  const knob = h("gain-slider", { name: "Kc", above: 0 });
  const start = h("button", { type: "button", class: "button primary run-play", onclick: () => (playing ? rest() : void go()) }, "Start the loop");
  const bump = h("button", { type: "button", class: "button", disabled: true, onclick: bumpIt }, "Bump the setpoint");
  const again = h("button", { type: "button", class: "button", disabled: true, onclick: () => reset() }, "Begin again");
  const take = h("button", { type: "button", class: "button primary", disabled: true, onclick: takeIt }, "This is Ku");
  const clockText = h("output", { class: "run-clock", "aria-label": "Simulated time" });
  const speed = createSelectField({ label: "Speed", groups: [{ label: null, choices: SPEEDS.map((s) => ({ value: String(s), label: s === 1 ? "usual" : `${s} ×` })) }], onChoice: (value) => { pace = Number(value); } });
  speed.show("1");
  const word = h("strong", { class: "hand-word" });
  const figures = h("span", {});
  const next = h("span", { class: "hand-next" });
  const said = h("p", { class: "hand-verdict", role: "status" }, word, figures, next);
  const panel = createPanelFrame(step.stage, { id: "by-hand", title: "The loop under your hand", help: HELP, figure: createFigure, table, arrange: ({ header, body }) => [header, h("div", { class: "hand-knob" }, knob, take), body, said, h("div", { class: "run-bar" }, start, bump, again, clockText, speed.root)] });

  const unit = () => bench.about?.timeUnit ?? "s";
  const period = () => bench.about?.ultimate?.Pu ?? bench.about?.scale ?? 1;

  /** @returns {Table | null} */
  function table() {
    const curves = loop?.curves;
    return curves ? { header: [`t [${unit()}]`, "r", "u", "y"], rows: curves.t.map((t, k) => [t, curves.r[k] ?? null, curves.u[k] ?? null, curves.y_m[k] ?? null]) } : null;
  }

  function reset() {
    rest();
    loop = null;
    swings = createSwings(Math.max(LEAST, 5 * bench.setting.plant.noise));
    [read, since, clock, base, runaway, ranges] = [0, -Infinity, 0, 0, false, {}];
    bump.disabled = again.disabled = take.disabled = true;
    setText(start, "Start the loop");
    setText(word, "");
    setText(figures, "");
    setText(next, "Set a small gain and start the loop: the setpoint steps by 1.");
    draw(false);
  }

  function rest() {
    playing = false;
    setText(start, "Go on");
  }

  async function go() {
    const { about, setting } = bench;
    if (!about) return;
    if (runaway) reset();
    if (!loop) {
      const now = (asked += 1);
      try {
        const { A, B, C, D } = await patiently(() => api.analyse("state-space", { system: systemOf(setting.plant) }));
        if (now !== asked || bench.about !== about) return;
        if (D[0]?.[0]) return step.complain({ message: "the plant passes its input on at once, so that the loop's swings are jumps", hint: "give it a lag" });
        const { noise, u_min, u_max } = setting.plant;
        const theta = setting.plant.kind === "fopdt" ? setting.plant.theta : await deadTime();
        if (now !== asked) return;
        loop = createProportionalLoop({ A, B, C, theta }, { Kc: about.sign * knob.value, step: period() / PER_PERIOD, low: u_min, high: u_max, noise: () => noise * normal() });
        step.say("");
      } catch (error) {
        step.complain(error);
        return;
      }
    }
    playing = true;
    bump.disabled = again.disabled = false;
    setText(start, "Pause");
    before = performance.now();
    frame ||= requestAnimationFrame(tick);
  }

  /** Dead time of the expression, which stands beside its states. */
  async function deadTime() {
    const { plant } = await patiently(() => api.loop({ loop: { plant: systemOf(bench.setting.plant), controller: { type: "pid", Kc: 1 } }, want: [] }));
    return /** @type {any} */ (plant)?.theta ?? 0;
  }

  function bumpIt() {
    if (!loop) return;
    loop.r = loop.r ? 0 : 1;
    since = loop.end;
  }

  knob.addEventListener("value-input", moved);
  knob.addEventListener("value-change", () => {
    moved();
    bench.setExperiment({ Kc: knob.value });
  });
  function moved() {
    if (!loop || !bench.about || loop.Kc === bench.about.sign * knob.value) return;
    loop.Kc = bench.about.sign * knob.value;
    since = loop.end;
    verdict();
  }

  function verdict() {
    if (!loop) return;
    const found = judge(swings.points, since);
    const last = Math.max(since, swings.points.t.at(-1) ?? -Infinity);
    const dead = found.verdict === "too few" && loop.end - last > DEAD * period();
    const { word: say, next: then } = dead ? DIED_OUT : VERDICTS[found.verdict];
    const held = loop.limited > loop.end - 2 * (found.Pu ?? period());
    said.dataset["verdict"] = runaway ? "growing" : held ? "held" : found.verdict.replace(" ", "-");
    take.disabled = found.verdict !== "sustained" || held;
    setText(word, runaway ? "run away" : held && found.verdict === "sustained" ? "held by the limit" : say);
    setText(figures, found.Pu === null ? "" : `period ${formatWithUnit(found.Pu, unit())}, amplitude ${formatNumber(found.amplitude)}, each swing ${formatNumber((found.ratio ?? 0) * 100)} % of the one a period before`);
    setText(next, runaway ? "The swings have left all bounds. Begin again with a smaller gain." : held ? "u is at its limit: the swings are held by the limit, not by the gain. Lower Kc." : then);
  }

  function takeIt() {
    if (!loop) return;
    const { Pu } = judge(swings.points, since);
    if (Pu) bench.setUltimate({ Ku: loop.Kc, Pu, by: "your hand", relay: null });
  }

  /** @param {number} now */
  function tick(now) {
    frame = 0;
    if (!loop || !playing) return draw(false);
    clock += (Math.min(LONGEST_TICK, Math.max(0, (now - before) / 1000)) * pace * period()) / SECONDS;
    before = now;
    if (!loop.until(clock)) {
      runaway = true;
      rest();
      setText(start, "Begin again");
    }
    const { t, y_m } = loop.curves;
    for (; read < t.length; read++) swings.push(t[read] ?? 0, y_m[read] ?? 0);
    if (now - drawn > EVERY || runaway) {
      drawn = now;
      draw(playing);
      verdict();
    }
    if (playing) frame = requestAnimationFrame(tick);
  }

  /** @param {boolean} moving */
  function draw(moving) {
    if (panel.root.hidden || !bench.about) return;
    const { outputName, inputName } = bench.about;
    const { t, r, y_m, u } = loop?.curves ?? { t: [], r: [], y_m: [], u: [] };
    const length = round125(IN_WINDOW * period());
    if (!(base <= clock && clock <= base + length)) base = Math.max(0, Math.floor((2 * clock) / length - 1) * (length / 2));
    const first = Math.max(0, t.findIndex((time) => time >= base));
    const turns = swings.points.t.map((_, k) => k).filter((k) => (swings.points.t[k] ?? 0) >= base);
    const figure = experimentRunPlot(
      {
        y: { t: t.slice(first), y: y_m.slice(first) },
        u: { t: t.slice(first), y: u.slice(first) },
        r: { t: t.slice(first), y: r.slice(first) },
        turns: { t: turns.map((k) => swings.points.t[k] ?? 0), y: turns.map((k) => swings.points.y[k] ?? 0) },
        window: [base, base + length],
        yRange: null,
        uRange: null,
        yName: outputName,
        uName: inputName,
        timeUnit: unit(),
      },
      theme,
      { ranges, moving },
    );
    ranges = figure.ranges;
    panel.show(figure, moving);
    setText(clockText, `t = ${formatNumber(clock, 4)} ${unit()}`);
    if (!moving) panel.tell(`Loop under proportional control at t = ${formatNumber(clock)} ${unit()}.`, [{ signal: "r", label: "r", name: "setpoint", dash: "dash" }, { signal: "y", label: "y", name: "output, as measured" }, { signal: "u", label: "u", name: "controller output" }]);
  }

  let madeFor = bench.about;
  function show() {
    const { setting, about } = bench;
    const here = setting.experiment.kind === "hand" && setting.plant.kind !== "library";
    panel.root.hidden = !here;
    if (!here) return rest();
    if (madeFor === about && loop) return;
    madeFor = about;
    asked += 1;
    if (about) {
      const { Kc } = filledIn(setting.experiment, setting.plant, about);
      const size = round125(1 / Math.abs(about.gain || 1));
      knob.setAttribute("min", String(size / 10));
      knob.setAttribute("max", String(size * 100));
      knob.value = Kc;
    }
    start.disabled = !about;
    reset();
  }
  bench.on(["about", "experiment"], show);
  bench.on(["plant"], () => {
    if (!panel.root.hidden && bench.about) reset();
  });
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });
  show();
}

/** A number of the normal distribution, by Box and Muller. */
function normal() {
  return Math.sqrt(-2 * Math.log(1 - Math.random())) * Math.cos(2 * Math.PI * Math.random());
}
