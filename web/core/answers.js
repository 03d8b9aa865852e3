/** What the server last said about the design: panels by name, which of them are wanted, and what is wrong. */

/** @import {LoopAnswer, PanelName, Panels, SystemText} from "./types.js" */

/** @typedef {ReturnType<typeof createAnswers>} Answers */
/** @typedef {{moving: boolean}} AnswerChange */

export function createAnswers() {
  /** @type {Panels} */
  let panels = {};
  /** @type {Map<PanelName, number>} */
  const wanted = new Map();
  /** @type {Set<(change: AnswerChange) => void>} */
  const listeners = new Set();
  /** @type {Set<() => void>} */
  const wantListeners = new Set();
  /** @type {{plant: SystemText | null, controller: SystemText | null, actuator: SystemText | null, sensor: SystemText | null, time_unit: string, error: any}} */
  let about = { plant: null, controller: null, actuator: null, sensor: null, time_unit: "s", error: null };

  /** @param {boolean} moving */
  function tell(moving) {
    for (const listener of [...listeners]) listener({ moving });
  }

  return {
    get panels() {
      return panels;
    },
    get plant() {
      return about.plant;
    },
    get controller() {
      return about.controller;
    },
    get actuator() {
      return about.actuator;
    },
    get sensor() {
      return about.sensor;
    },
    get time_unit() {
      return about.time_unit;
    },
    /** The last request's error, or null; while there is one the panels still show the last good loop. */
    get error() {
      return about.error;
    },

    /** @param {LoopAnswer} answer @param {boolean} moving */
    accept(answer, moving) {
      // What the server neither sent nor called unchanged belongs to an older loop.
      const kept = Object.fromEntries(answer.unchanged.map((name) => [name, panels[name]]));
      panels = { ...kept, ...answer.panels };
      const { plant, controller, actuator, sensor, time_unit } = answer;
      about = { plant, controller, actuator, sensor, time_unit, error: null };
      tell(moving);
    },
    /** @param {any} error */
    reject(error) {
      about = { ...about, error };
      tell(false);
    },

    /** @param {(change: AnswerChange) => void} listener @returns {() => void} */
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },

    /** Asks for these panels from now on. @param {PanelName[]} names @returns {() => void} */
    want(names) {
      for (const name of names) wanted.set(name, (wanted.get(name) ?? 0) + 1);
      for (const listener of [...wantListeners]) listener();
      return () => {
        for (const name of names) wanted.set(name, Math.max(0, (wanted.get(name) ?? 0) - 1));
      };
    },
    get wanted() {
      return [...wanted].filter(([, count]) => count > 0).map(([name]) => name);
    },
    /** @param {() => void} listener @returns {() => void} */
    onWant(listener) {
      wantListeners.add(listener);
      return () => wantListeners.delete(listener);
    },
  };
}
