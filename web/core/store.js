/**
 * The state of a bench: the design with undo and redo, the view, named snapshots, and the server's answers.
 * A knob that moves writes with `{moving: true}`; only the value it comes to rest at is a step of undo.
 */

/** @import {Design, State, View} from "./types.js" */
/** @import {Answers} from "./answers.js" */

import { createAnswers } from "./answers.js";

const UNDO_DEPTH = 200;

/** @typedef {{moving: boolean, design: boolean, view: boolean}} Change  what kind of change it was */
/** @typedef {{id: number, name: string, design: Design, panels: import("./types.js").Panels}} Snapshot */

/** @param {State} state @returns {Design} */
export function designOf({ plant, controller, actuator, sensor, horizon }) {
  return { plant, controller, actuator, sensor, horizon };
}

/** @param {Design} a @param {Design} b */
export function sameDesign(a, b) {
  return JSON.stringify(designOf(/** @type {State} */ (a))) === JSON.stringify(designOf(/** @type {State} */ (b)));
}

/** @typedef {ReturnType<typeof createStore>} Store */

/** @param {State} initial */
export function createStore(initial) {
  let state = initial;
  /** Where the design last came to rest. */
  let rest = designOf(initial);
  /** The run of merged changes that is going on. */
  let run = "";
  /** @type {Design[]} */
  let past = [];
  /** @type {Design[]} */
  let future = [];
  /** @type {Snapshot[]} */
  let snapshots = [];
  let nextSnapshot = 1;
  /** @type {Set<(state: State, change: Change) => void>} */
  const listeners = new Set();
  const answers = createAnswers();

  /** @param {Change} change */
  function tell(change) {
    for (const listener of [...listeners]) listener(state, change);
  }

  /** @param {Design} design */
  function goTo(design) {
    state = { ...state, ...design };
    rest = design;
    run = "";
    tell({ moving: false, design: true, view: false });
  }

  return {
    /** @type {Answers} */
    answers,

    get: () => state,

    /**
     * `merge` names a run of changes, such as the letters of one text, that undo takes back together.
     * @param {Partial<Design>} patch
     * @param {{moving?: boolean, merge?: string}} [options]
     */
    set(patch, { moving = false, merge = "" } = {}) {
      state = { ...state, ...patch };
      if (!moving && !sameDesign(rest, state)) {
        if (merge === "" || merge !== run) past = [...past, rest].slice(-UNDO_DEPTH);
        run = merge;
        future = [];
        rest = designOf(state);
      }
      tell({ moving, design: true, view: false });
    },

    /** @param {Partial<State["controller"]>} patch @param {{moving?: boolean}} [options] */
    setController(patch, options) {
      this.set({ controller: { ...state.controller, ...patch } }, options);
    },

    /** @param {Partial<View>} patch */
    setView(patch) {
      state = { ...state, view: { ...state.view, ...patch } };
      tell({ moving: false, design: false, view: true });
    },

    /** @param {Partial<View["analyses"]>} patch */
    setAnalyses(patch) {
      this.setView({ analyses: { ...state.view.analyses, ...patch } });
    },

    /** @param {(state: State, change: Change) => void} listener @returns {() => void} */
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },

    get canUndo() {
      return past.length > 0;
    },
    get canRedo() {
      return future.length > 0;
    },
    undo() {
      const previous = past.at(-1);
      if (!previous) return;
      past = past.slice(0, -1);
      future = [...future, rest];
      goTo(previous);
    },
    redo() {
      const next = future.at(-1);
      if (!next) return;
      future = future.slice(0, -1);
      past = [...past, rest];
      goTo(next);
    },

    get snapshots() {
      return snapshots;
    },
    /** Keeps the design and what is drawn of it, to compare with. @param {string} [name] */
    keep(name) {
      const id = nextSnapshot++;
      snapshots = [...snapshots, { id, name: name ?? `Response ${id}`, design: designOf(state), panels: { ...answers.panels } }];
      tell({ moving: false, design: false, view: true });
      return id;
    },
    /** @param {number} id */
    drop(id) {
      snapshots = snapshots.filter((snapshot) => snapshot.id !== id);
      tell({ moving: false, design: false, view: true });
    },
    /** @param {number} id */
    restore(id) {
      const found = snapshots.find((snapshot) => snapshot.id === id);
      if (found) this.set(found.design);
    },
  };
}
