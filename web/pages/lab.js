/** A lab: the text with its exercises at the left, the bench at the right; on a narrow page a tab each. */

/** @import {Lab, Settings} from "../core/lab/types.js" */

import { createApi } from "../core/api.js";
import { inWords, settingsOf, stateOf, withSettings } from "../core/lab/bench.js";
import { createProgress, localStore } from "../core/lab/progress.js";
import { ANALYSES, PLOTS } from "../core/workbench/plots.js";
import { startSession } from "../core/workbench/session.js";
import { createStore } from "../core/store.js";
import { h } from "../components/dom.js";
import "../components/site-header.js";
import { createStage } from "../components/stage.js";
import { toast } from "../components/status-toast.js";
import { createTabs } from "../components/tabs.js";
import * as actionsBar from "../panels/workbench/actions-bar.js";
import * as bode from "../panels/workbench/bode.js";
import * as bodeIntegral from "../panels/analyses/bode-integral.js";
import * as knobs from "../panels/lab/knobs.js";
import * as laplace from "../panels/analyses/laplace.js";
import * as limits from "../panels/analyses/limits.js";
import * as lowOrder from "../panels/analyses/low-order.js";
import * as nichols from "../panels/workbench/nichols.js";
import * as reading from "../panels/lab/reading.js";
import * as numbers from "../panels/workbench/numbers.js";
import * as nyquist from "../panels/workbench/nyquist.js";
import * as response from "../panels/analyses/response.js";
import * as rootLocus from "../panels/workbench/root-locus.js";
import * as routh from "../panels/analyses/routh.js";
import * as sensitivity from "../panels/workbench/sensitivity.js";
import * as spectrum from "../panels/analyses/spectrum.js";
import * as stability from "../panels/analyses/stability.js";
import * as stateSpace from "../panels/analyses/state-space.js";
import * as step from "../panels/workbench/step.js";
import * as verdictBar from "../panels/workbench/verdict-bar.js";
import * as viewBar from "../panels/workbench/view-bar.js";

/** @typedef {import("../components/stage.js").Mount} Mount */

/** An analysis that could change the plant, without the means to. @param {typeof response.mount} mount @returns {Mount} */
const asGiven = (mount) => (host, store, api) => mount(host, store, api, { plantGiven: true });

/** @type {Record<string, Mount>} */
const MOUNTS = {
  step: step.mount,
  bode: bode.mount,
  nyquist: nyquist.mount,
  nichols: nichols.mount,
  root_locus: rootLocus.mount,
  sensitivity: sensitivity.mount,
  numbers: numbers.mount,
  response: asGiven(response.mount),
  laplace: laplace.mount,
  routh: routh.mount,
  stability: stability.mount,
  state_space: asGiven(stateSpace.mount),
  low_order: asGiven(lowOrder.mount),
  limits: limits.mount,
  bode_integral: bodeIntegral.mount,
  spectrum: spectrum.mount,
};
const SHOWN_WIDE = 3;
const NARROW = matchMedia("(max-width: 63.99rem)");

const api = createApi();
const labId = decodeURIComponent(location.pathname.split("/").findLast(Boolean) ?? "");

/** @param {string} id @returns {HTMLElement} */
function place(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no #${id}`);
  return element;
}

async function load() {
  place("reading").replaceChildren(h("p", { class: "empty", role: "status" }, "Loading the lab…"));
  let lab;
  try {
    lab = await api.lab(labId);
  } catch (error) {
    fail(error);
    return;
  }
  open(lab);
}

/** @param {any} error */
function fail({ status, message, hint }) {
  const unknown = status === 404;
  document.body.classList.add("no-lab");
  place("reading").replaceChildren(
    h(
      "div",
      { class: "lab-missing" },
      h("h1", {}, unknown ? "No such lab" : "This lab cannot be shown"),
      h("p", {}, unknown ? "There is no lab at this address. It may have been renamed." : [message, hint].filter(Boolean).join(" ")),
      h("p", { class: "row" }, h("a", { class: "button primary", href: "/labs" }, "See all labs"), unknown ? "" : h("button", { type: "button", class: "button", onclick: () => void load() }, "Try again")),
    ),
  );
}

/** Only what this bench has: a lab may have changed since it was last open. @param {Settings | null} saved @param {Lab} lab */
function usable(saved, { bench }) {
  const fits = bench.sliders.filter(({ knob, min, max, can_be_off }) => {
    const value = saved?.[knob];
    return value === null ? can_be_off : typeof value === "number" && value >= min && value <= max;
  });
  return Object.fromEntries(fits.map(({ knob }) => [knob, saved?.[knob] ?? null]));
}

/** @param {Lab} lab */
function open(lab) {
  document.title = `${lab.title} · looplab`;
  document.body.classList.remove("no-lab");
  const { bench } = lab;
  const progress = createProgress(lab.id, localStore());
  const initial = stateOf(bench);
  /** @param {import("../core/workbench/plots.js").ViewItem[]} items */
  const offered = (items) => items.filter(({ id }) => bench.panels.includes(id)).toSorted((a, b) => bench.panels.indexOf(a.id) - bench.panels.indexOf(b.id));
  const shown = () => bench.panels.slice(0, NARROW.matches ? 1 : SHOWN_WIDE);
  const store = createStore({
    ...initial,
    controller: { ...initial.controller, ...withSettings(initial.controller, usable(progress.saved.settings, lab)) },
    view: { ...initial.view, show: shown() },
  });

  const tabs = createTabs(place("tabs"), "Lesson and bench", [
    { id: "reading", label: "Lesson", panel: place("reading") },
    { id: "bench", label: "Bench", panel: place("bench") },
  ]);
  const asTabs = () => tabs.use(NARROW.matches);
  NARROW.addEventListener("change", () => {
    asTabs();
    store.setView({ show: shown() });
  });
  asTabs();

  let closeReading = () => {};
  function openReading() {
    closeReading();
    place("reading").replaceChildren();
    closeReading = reading.mount(place("reading"), store, api, { lab, progress, goToBench, startOver });
  }

  function goToBench() {
    tabs.select("bench");
    place("knobs").querySelector("input")?.focus();
  }

  function startOver() {
    const takeBack = progress.clear();
    openReading();
    scrollTo({ top: 0 });
    toast().say("Your answers in this lab are cleared.", { action: { label: "Undo", run: () => { takeBack(); openReading(); } }, lasting: true });
  }

  openReading();
  verdictBar.mount(place("verdict"), store, api);
  knobs.mount(place("knobs"), store, api, bench);
  viewBar.mount(place("views"), store, api, { narrow: () => NARROW.matches, plots: offered(PLOTS), analyses: offered(ANALYSES) });
  actionsBar.mount(place("actions"), store, api, { link: false });
  createStage(place("stage"), store, api, bench.panels.map((id) => ({ id, mount: /** @type {Mount} */ (MOUNTS[id]) })));

  store.subscribe(({ controller }, change) => {
    if (change.design && !change.moving) progress.keepSettings(settingsOf(controller, bench.sliders));
  });
  store.answers.subscribe(({ moving }) => {
    if (moving) return;
    const { verdict } = store.answers.panels;
    tabs.note("bench", verdict ? `${inWords(settingsOf(store.get().controller, bench.sliders.slice(0, 1)), bench.sliders)}, ${verdict.verdict}` : "");
  });

  startSession(store, api, {
    onStatus(status, error) {
      if (status === "waiting") toast().say(`${error.message} Trying again…`, { lasting: true });
      else if (status === "error") toast().say([error.message, error.hint].filter(Boolean).join(" "), { lasting: true });
    },
  });

  // The browser looked for the part in the address before it was there.
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

void load();
