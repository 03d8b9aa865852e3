/** From an experiment to a controller, in five steps. */

import { createApi } from "../core/api.js";
import { createExperimentBench } from "../core/experiments/bench.js";
import { formatNumber } from "../core/format.js";
import { calm } from "../components/card.js";
import { createStep, createStepBar } from "../components/step-section.js";
import "../components/site-header.js";
import * as findings from "../panels/experiments/findings.js";
import * as hand from "../panels/experiments/hand.js";
import * as loop from "../panels/experiments/loop.js";
import * as plant from "../panels/experiments/plant.js";
import * as plot from "../panels/experiments/plot.js";
import * as rules from "../panels/experiments/rules.js";
import * as setup from "../panels/experiments/setup.js";
import * as data from "../panels/experiments/identify-data.js";
import * as model from "../panels/experiments/identify-model.js";
import * as record from "../panels/experiments/identify-plot.js";

const STEPS = [
  { id: "plant", label: "Plant", title: "The plant", lead: "What is to be controlled. From here on you know it only by what it answers." },
  { id: "experiment", label: "Experiment", title: "The experiment", lead: "Disturb the plant and watch." },
  { id: "model", label: "Model", title: "The model", lead: "Read a gain, a time constant and a dead time off the record." },
  { id: "controller", label: "Controller", title: "The controller", lead: "Let a rule tune a controller for what was found." },
  { id: "run", label: "Run", title: "The run on the true plant", lead: "What the model promised, and what the plant does." },
];
const WRITE_MS = 200;

/** @param {HTMLElement} main */
function open(main) {
  main.querySelector(".empty")?.remove();
  main.addEventListener("panel-expand", (event) => /** @type {HTMLElement} */ (event.target).classList.toggle("enlarged"));
  const api = createApi();
  const bench = createExperimentBench(location.search);
  const bar = createStepBar(main, STEPS);
  const [first, second, third, fourth, fifth] = STEPS.map((step, k) => createStep(main, { ...step, number: k + 1 }));
  if (!first || !second || !third || !fourth || !fifth) return;
  plant.mount(first, bench, api);
  const { begin } = setup.mount(second, bench, api);
  // A link that names what came after the experiment shows it at once; it is not to be waited for again.
  let atOnce = bench.setting.pick !== null || Object.keys(bench.setting.moved).length > 0;
  plot.mount(second, bench, { atOnce: () => atOnce });
  hand.mount(second, bench, api);
  findings.mount(second, bench);
  data.mount(third, bench, api);
  record.mount(third, bench);
  model.mount(third, bench, { next: () => fourth.root.scrollIntoView({ behavior: calm() ? "auto" : "smooth" }) });
  rules.mount(fourth, bench, api);
  loop.mount(fifth, bench, api);

  function where() {
    const { about, result, found, tuned, setting } = bench;
    const { system } = found.model ?? {};
    bar.show("plant", about ? (setting.plant.kind === "library" ? setting.plant.id : "set") : null);
    bar.show("experiment", found.ultimate ? `Ku ${formatNumber(found.ultimate.Ku)}` : result ? "done" : null);
    bar.show("model", system ? (system.K === undefined ? "found" : `K ${formatNumber(system.K)}`) : null);
    bar.show("controller", tuned ? `${tuned.type}, Kc ${formatNumber(tuned.Kc)}` : null);
    bar.show("run", tuned ? "done" : null);
  }
  bench.on(["about", "result", "found", "rules", "pick"], where);
  where();

  // What was done by hand is to be done again: no link can hold it.
  atOnce &&= bench.setting.experiment.kind !== "hand" || bench.setting.plant.kind === "library";
  if (atOnce) {
    const stop = bench.on(["about"], () => {
      if (!bench.about) return;
      stop();
      void begin().finally(() => (atOnce = false));
    });
  }

  let writing = 0;
  bench.on(["plant", "experiment", "method", "lines", "pick"], () => {
    clearTimeout(writing);
    writing = window.setTimeout(() => {
      const query = bench.query();
      history.replaceState(null, "", (query ? `?${query}` : location.pathname) + location.hash);
    }, WRITE_MS);
  });
}

const main = document.getElementById("main");
if (main) open(main);
