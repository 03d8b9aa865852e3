/** One plant: its drawing, moved by a run that goes on, its curves, and what can be worked out about it. */

/** @import {MatrixDocument} from "../core/plant/types.js" */

import { createApi } from "../core/api.js";
import { createPlantBench } from "../core/plant/bench.js";
import { paceOf, round125 } from "../core/plant/pace.js";
import { createPlantRun } from "../core/plant/run.js";
import { h } from "../components/dom.js";
import "../components/site-header.js";
import * as entries from "../panels/plant/matrix-entries.js";
import * as balance from "../panels/plant/balance.js";
import * as experiment from "../panels/plant/experiment.js";
import * as facts from "../panels/plant/facts.js";
import * as inputs from "../panels/plant/inputs.js";
import * as linear from "../panels/plant/linear.js";
import * as loop from "../panels/plant/loop.js";
import * as map from "../panels/plant/map.js";
import * as phase from "../panels/plant/phase.js";
import * as picture from "../panels/plant/picture.js";
import * as plot from "../panels/plant/plot.js";
import * as profile from "../panels/plant/profile.js";
import * as steady from "../panels/plant/steady.js";
import * as steps from "../panels/plant/transfer-matrix.js";

/** Seconds in which the curves of an experiment are played. */
const PLAYED_IN = 10;
const LONGEST_TICK = 0.1;

/** @param {HTMLElement} main */
function enlarge(main) {
  main.addEventListener("panel-expand", (event) => /** @type {HTMLElement} */ (event.target).classList.toggle("enlarged"));
}

/** @param {string} id @param {HTMLElement} main */
async function open(id, main) {
  const api = createApi();
  let answer;
  try {
    answer = await api.plant(id);
  } catch (error) {
    const { message, hint } = /** @type {any} */ (error);
    main.replaceChildren(h("h1", {}, "No such plant"), h("p", { class: "empty" }, `${message}${hint ? `: ${hint}` : ""}. `, h("a", { href: "/plants" }, "See all plants")));
    return;
  }
  const { title, summary, notes } = answer.document;
  document.title = `${title} · looplab`;
  const head = h("header", { class: "plant-head" }, h("p", { class: "plant-group" }, h("a", { href: "/plants" }, "Plants"), ` › ${answer.group}`), h("h1", {}, title), h("p", {}, summary ?? ""), notes ? h("p", { class: "facts" }, `Lecture notes §${notes}`) : null);
  if (answer.kind === "transfer-matrix") {
    const matrix = /** @type {MatrixDocument} */ (/** @type {unknown} */ (answer.document));
    head.append(h("p", { class: "facts" }, `Source: ${matrix.source}`));
    // Loops want an input each.
    if (matrix.inputs.length === matrix.outputs.length && matrix.inputs.length > 1) head.append(h("p", {}, h("a", { class: "button primary", href: `/mimo?${new URLSearchParams({ plant: id })}` }, "Close its loops"), " Pairing, interaction, decoupling."));
    const panels = h("div", { class: "plant-analyses" });
    main.replaceChildren(head, panels);
    entries.mount(panels, matrix, answer.equations);
    steps.mount(panels, matrix, api);
    enlarge(main);
    return;
  }
  const bench = createPlantBench(answer, location.search);
  const pace = paceOf(answer.time_scale, bench.timeUnit);
  const { model } = bench;
  const [rail, middle, right, below] = [h("div", { class: "plant-rail" }), h("div", { class: "plant-middle" }), h("div", { class: "plant-right" }), h("div", { class: "plant-below" })];
  main.replaceChildren(head, h("div", { class: "plant-bench" }, middle, right, rail), below);

  /** @type {() => void} */
  let refresh = () => {};
  const run = createPlantRun(bench, { simulate: (request) => api.workOut(id, "simulate", request), speed: pace.speed, onChange: () => refresh() });
  const pictured = picture.mount(middle, bench, run, pace);
  const plotted = plot.mount(right, bench, run, { window: () => round125(12 * run.speed) });
  const knobs = inputs.mount(rail, bench);
  experiment.mount(rail, bench, run, api, { window: round125(5 * (answer.time_scale ?? 1)) });
  const told = facts.mount(below, bench);
  const analyses = h("div", { class: "plant-analyses" });
  below.append(analyses);
  const rows = profile.mount(analyses, bench, run);
  const { inputs: u = [], states } = model;
  steady.mount(analyses, bench, api);
  if (u.length > 0) {
    map.mount(analyses, bench, api);
    linear.mount(analyses, bench, run, api);
    loop.mount(analyses, bench, run, api, { window: round125(5 * (answer.time_scale ?? 1)) });
  }
  if (states.length >= 2) phase.mount(analyses, bench, api);
  balance.mount(analyses, bench, api);

  let frame = 0;
  let before = 0;
  let whole = false;
  /** @param {number} now */
  function show(now) {
    frame = 0;
    run.tick(Math.min(LONGEST_TICK, Math.max(0, (now - before) / 1000)), run.whole ? (run.end - run.start) / PLAYED_IN : run.speed);
    before = now;
    pictured.frame();
    plotted.frame(now);
    rows?.frame(now);
    if (run.playing) frame ||= requestAnimationFrame(show);
  }
  refresh = () => {
    pictured.refresh();
    plotted.refresh({ anew: run.whole !== whole });
    rows?.refresh();
    whole = run.whole;
    if (frame === 0) {
      before = performance.now();
      frame = requestAnimationFrame(show);
    }
  };
  let writing = 0;
  bench.subscribe(({ moving, restart }) => {
    if (restart) {
      const going = run.playing;
      run.reset();
      if (going) run.play();
    } else run.changed();
    knobs.refresh();
    told.refresh();
    if (moving) return;
    clearTimeout(writing);
    writing = window.setTimeout(() => {
      const query = bench.query();
      history.replaceState(null, "", query ? `?${query}` : location.pathname);
    }, 200);
  });
  enlarge(main);
  run.reset();
}

const main = document.getElementById("main");
if (main) void open(decodeURIComponent(location.pathname.split("/").at(-1) ?? ""), main);
