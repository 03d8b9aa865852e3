/** Several loops on one process: the process and its loops on the left; what they do, and how they interact, beside. */

import { createApi } from "../core/api.js";
import { entryText, FIRST_LOOP, createMimoStore, pairedRequest, tunedLoop } from "../core/mimo/mimo.js";
import { fromMimoQuery, toMimoQuery } from "../core/mimo/url.js";
import { h } from "../components/dom.js";
import { icon } from "../components/icons.js";
import "../components/site-header.js";
import { bindUndoKeys } from "../components/undo-keys.js";
import * as decoupler from "../panels/mimo/decoupler.js";
import * as diagram from "../panels/mimo/diagram.js";
import * as interaction from "../panels/mimo/interaction.js";
import * as loopCards from "../panels/mimo/loops.js";
import * as plantCard from "../panels/mimo/plant.js";
import * as responses from "../panels/mimo/responses.js";
import * as rga from "../panels/mimo/rga.js";

/** @import {MimoState} from "../core/mimo/mimo.js" */
/** @import {MatrixDocument, PlantSummary} from "../core/plant/types.js" */

/** Share of the settling time in which a loop without dead time is asked to close. */
const BRISK = 1 / 40;
const TUNE_BY = ["blt", "simc"];

const api = createApi();

/** Settings to begin with: all loops together where that can be, else each for its own entry. @param {MimoState} state @param {number} horizon */
async function tuned(state, horizon) {
  for (const method of TUNE_BY) {
    const { settings } = await api.analyse("mimo/tune", { ...pairedRequest(state), method, ...(method === "simc" ? { tau_c: horizon * BRISK } : {}) });
    // A rule that does not apply to any loop: the next one may.
    if (settings.some((/** @type {any} */ each) => each.controller)) return state.loops.map((loop, i) => (settings[i]?.controller ? tunedLoop(loop, settings[i].controller) : loop));
  }
  return state.loops;
}

/** A state of another process: paired as recommended, and tuned. @param {MimoState} state @returns {Promise<Partial<MimoState>>} */
async function settled(state) {
  const n = state.entries.length;
  const all = Array.from({ length: n }, (_, i) => i);
  const blank = { ...state, pairing: all, loops: all.map(() => FIRST_LOOP) };
  const { pairing, horizon } = await api.analyse("mimo/rga", { plant: pairedRequest(blank).plant, points: 2 });
  const paired = { ...blank, pairing: pairing ? pairing.map((/** @type {number} */ j) => j - 1) : all };
  return { ...paired, loops: await tuned(paired, horizon), test: { ...state.test, loop: 0 }, seen: 0, decoupler: n > 2 && state.decoupler === "dynamic" ? "none" : state.decoupler };
}

/** @param {string} id @returns {Promise<string[][]>} */
async function entriesOf(id) {
  const { kind, document: found } = await api.plant(id);
  if (kind !== "transfer-matrix") throw new Error("This plant is not a transfer matrix.");
  return /** @type {MatrixDocument} */ (/** @type {unknown} */ (found)).entries.map((row) => row.map(entryText));
}

/** @param {HTMLElement} main */
async function open(main) {
  const { plants } = await api.plants();
  const matrices = plants.filter(({ kind, inputs, outputs }) => kind === "transfer-matrix" && inputs.length === outputs.length);
  let { state, tuned: known } = fromMimoQuery(location.search);
  if (state.plant && !matrices.some(({ id }) => id === state.plant)) {
    state = fromMimoQuery("").state;
    known = false;
  }
  if (state.plant) {
    const entries = await entriesOf(state.plant);
    known = known && entries.length === state.loops.length;
    state = { ...state, entries };
  }
  if (!known) {
    try {
      state = { ...state, ...(await settled(state)) };
    } catch {
      // What is wrong with the process shows at its entries.
      const all = state.entries.map((_, i) => i);
      state = { ...state, pairing: all, loops: all.map(() => FIRST_LOOP) };
    }
  }
  build(main, state, matrices);
}

/** @param {HTMLElement} main @param {MimoState} initial @param {PlantSummary[]} matrices */
function build(main, initial, matrices) {
  const store = createMimoStore(initial);
  const rail = h("div", { class: "mimo-rail" });
  const stage = h("div", { class: "mimo-stage" });
  const analyses = h("div", { class: "mimo-analyses" });
  const button = (/** @type {string} */ picture, /** @type {string} */ label, /** @type {string} */ title, /** @type {() => void} */ run) => h("button", { type: "button", class: "icon-button", "aria-label": label, title, onclick: run }, icon(picture));
  const [undo, redo] = [button("undo", "Undo", "Undo (Ctrl+Z)", () => store.undo()), button("redo", "Redo", "Redo (Ctrl+Shift+Z)", () => store.redo())];
  main.querySelector(".mimo-head")?.append(h("div", { class: "mimo-history", role: "group", "aria-label": "History" }, undo, redo));
  main.append(h("div", { class: "mimo-bench" }, rail, stage, analyses));

  let wanted = 0;
  /** Another process, once it has been paired and tuned; only the newest counts. @param {Partial<MimoState>} patch */
  async function adopt(patch) {
    const turn = ++wanted;
    const next = { ...store.get(), ...patch };
    try {
      if (next.plant) next.entries = await entriesOf(next.plant);
      const found = await settled(next);
      if (turn === wanted) store.set(found);
      process.complain(null);
    } catch (error) {
      if (turn === wanted) process.complain(error);
    }
  }
  const process = plantCard.mount(rail, store, {
    plants: matrices,
    choose: (id) => void adopt({ plant: id }),
    // An entry that moves a little is the same process: its loops stay as they are.
    write: (entries, timeUnit) => (entries.length === store.get().loops.length ? store.set({ plant: "", entries, timeUnit }) : void adopt({ plant: "", entries, timeUnit })),
  });
  loopCards.mount(rail, store, api);
  const picture = diagram.mount(stage, store);
  responses.mount(stage, store, api, { onError: (error) => process.complain(error) });
  rga.mount(analyses, store, api, {
    onAnswer(answer) {
      picture.gains(answer.gains);
      store.name({ timeUnit: answer.time_unit, inputs: answer.inputs, outputs: answer.outputs });
    },
  });
  interaction.mount(analyses, store, api);
  decoupler.mount(analyses, store, api);

  let writing = 0;
  const remember = () => {
    undo.disabled = !store.canUndo;
    redo.disabled = !store.canRedo;
    clearTimeout(writing);
    writing = window.setTimeout(() => history.replaceState(null, "", `?${toMimoQuery(store.get())}`), 250);
  };
  store.subscribe((_, { moving }) => {
    if (!moving) remember();
  });
  remember();
  bindUndoKeys(store);
  main.addEventListener("panel-expand", (event) => /** @type {HTMLElement} */ (event.target).classList.toggle("enlarged"));
}

const main = document.getElementById("main");
if (main) void open(main).catch((error) => main.append(h("p", { class: "empty" }, `The page could not be set up. ${error?.message ?? ""}`)));
