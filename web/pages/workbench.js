/** The workbench: which panels in which order, and the state in the address bar. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */

import { createApi } from "../core/api.js";
import { ANALYSES, PLOTS, SHOWN_NARROW, SHOWN_WIDE, takesRow, VIEW_IDS } from "../core/workbench/plots.js";
import { sentence } from "../core/format.js";
import { defaultState } from "../core/workbench/presets.js";
import { startSession } from "../core/workbench/session.js";
import { createStore, designOf } from "../core/store.js";
import { fromQuery, toQuery } from "../core/url.js";
import "../components/site-header.js";
import { toast } from "../components/status-toast.js";
import * as actionsBar from "../panels/workbench/actions-bar.js";
import * as bode from "../panels/workbench/bode.js";
import * as bodeIntegral from "../panels/analyses/bode-integral.js";
import * as compare from "../panels/analyses/compare.js";
import * as controllerCard from "../panels/workbench/controller-card.js";
import * as gainMap from "../panels/analyses/gain-map.js";
import * as instrumentsCard from "../panels/workbench/instruments-card.js";
import * as laplace from "../panels/analyses/laplace.js";
import * as limits from "../panels/analyses/limits.js";
import * as loopDiagram from "../panels/workbench/loop-diagram.js";
import * as lowOrder from "../panels/analyses/low-order.js";
import * as nichols from "../panels/workbench/nichols.js";
import * as numbers from "../panels/workbench/numbers.js";
import * as nyquist from "../panels/workbench/nyquist.js";
import * as plantCard from "../panels/workbench/plant-card.js";
import * as response from "../panels/analyses/response.js";
import * as rootLocus from "../panels/workbench/root-locus.js";
import * as routh from "../panels/analyses/routh.js";
import * as sensitivity from "../panels/workbench/sensitivity.js";
import * as spectrum from "../panels/analyses/spectrum.js";
import * as stability from "../panels/analyses/stability.js";
import * as stateSpace from "../panels/analyses/state-space.js";
import * as step from "../panels/workbench/step.js";
import * as testCard from "../panels/workbench/test-card.js";
import * as tradeOffCard from "../panels/workbench/trade-off-card.js";
import * as tuneCard from "../panels/workbench/tune-card.js";
import * as verdictBar from "../panels/workbench/verdict-bar.js";
import * as viewBar from "../panels/workbench/view-bar.js";

/** @typedef {(host: HTMLElement, store: Store, api: Api) => () => void} Mount */

/** @type {Record<string, Mount>} */
const STAGE = {
  step: step.mount,
  bode: bode.mount,
  nyquist: nyquist.mount,
  nichols: nichols.mount,
  root_locus: rootLocus.mount,
  sensitivity: sensitivity.mount,
  numbers: numbers.mount,
  response: response.mount,
  laplace: laplace.mount,
  routh: routh.mount,
  stability: stability.mount,
  state_space: stateSpace.mount,
  low_order: lowOrder.mount,
  compare: compare.mount,
  gain_map: gainMap.mount,
  limits: limits.mount,
  bode_integral: bodeIntegral.mount,
  spectrum: spectrum.mount,
};

const NARROW = matchMedia("(max-width: 63.99rem)");

/** @param {string} id @returns {HTMLElement} */
function place(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no #${id}`);
  return element;
}

const api = createApi();
const fallback = defaultState();
const initial = fromQuery(location.search, fallback, VIEW_IDS);
const chosen = initial.view.show.length > 0;
const store = createStore({ ...initial, view: { ...initial.view, show: chosen ? initial.view.show : NARROW.matches ? SHOWN_NARROW : SHOWN_WIDE } });

/** Whether the plots on the stage were picked, or are only what fits. */
let picked = chosen;

verdictBar.mount(place("verdict"), store, api);
const rail = place("rail");
loopDiagram.mount(rail, store, api);
// On a narrow page the sliders should be the first thing under the plot.
plantCard.mount(rail, store, api, { open: !NARROW.matches });
for (const panel of [controllerCard, instrumentsCard, tuneCard, tradeOffCard, testCard]) panel.mount(rail, store, api);
viewBar.mount(place("views"), store, api, { narrow: () => NARROW.matches, plots: PLOTS, analyses: ANALYSES });
actionsBar.mount(place("actions"), store, api);

const stage = place("stage");
/** @type {Map<string, {host: HTMLElement, dispose: () => void}>} */
const mounted = new Map();
/** What was on the stage before one plot was enlarged. @type {string[] | null} */
let before = null;

function layOut() {
  const { show } = store.get().view;
  for (const [id, { host, dispose }] of mounted) {
    if (show.includes(id)) continue;
    dispose();
    host.remove();
    mounted.delete(id);
  }
  for (const id of VIEW_IDS) {
    const mount = STAGE[id];
    if (!show.includes(id) || mounted.has(id) || !mount) continue;
    const host = document.createElement("div");
    host.className = takesRow(id) ? "slot row-slot" : "slot";
    host.dataset["plot"] = id;
    const next = VIEW_IDS.slice(VIEW_IDS.indexOf(id) + 1).map((name) => mounted.get(name)?.host).find(Boolean);
    stage.insertBefore(host, next ?? null);
    mounted.set(id, { host, dispose: mount(host, store, api) });
  }
  stage.dataset["plots"] = String(show.filter((id) => !takesRow(id)).length);
  document.body.classList.toggle("one-plot", show.length === 1);
}

stage.addEventListener("panel-expand", (event) => {
  const { id } = /** @type {CustomEvent<{id: string}>} */ (event).detail;
  const { show } = store.get().view;
  const alone = show.length === 1;
  const next = alone ? (before ?? SHOWN_WIDE) : [id];
  before = alone ? null : show;
  store.setView({ show: next });
  document.querySelector(`#panel-${id} .expand`)?.scrollIntoView({ block: "nearest" });
});

let writing = 0;
function writeUrl() {
  clearTimeout(writing);
  const state = store.get();
  const view = picked ? state.view : { ...state.view, show: [] };
  history.replaceState(null, "", `?${toQuery({ ...state, view })}`);
}

store.subscribe((_, change) => {
  if (change.view) {
    const shown = [...mounted.keys()].toSorted().join();
    layOut();
    if (shown !== [...mounted.keys()].toSorted().join()) picked = true;
  }
  // Browsers limit how often an address may be rewritten.
  clearTimeout(writing);
  if (!change.moving) writing = window.setTimeout(writeUrl, 150);
});

NARROW.addEventListener("change", () => {
  if (picked) return;
  store.setView({ show: NARROW.matches ? SHOWN_NARROW : SHOWN_WIDE });
  picked = false;
});

addEventListener("popstate", () => {
  const state = fromQuery(location.search, fallback, VIEW_IDS);
  store.set(designOf(state));
});

layOut();

/** Whether a card of the rail shows this error beside the field it is about. @param {any} error */
const saidInPlace = (error) => /plant|actuator|sensor/.test(String(error.path ?? ""));

let troubled = false;
startSession(store, api, {
  onStatus(status, error) {
    if (status === "waiting") toast().say(`${error.message} Trying again…`, { lasting: true });
    else if (status === "error" && !saidInPlace(error)) toast().say([error.message, error.hint].map(sentence).filter(Boolean).join(" "), { lasting: true });
    else if (troubled) toast().hush();
    troubled = status !== "ok" && !(status === "error" && saidInPlace(error));
  },
});
