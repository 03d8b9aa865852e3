/** Keeps a store's answers up to date with its design: asks while a knob moves, and asks for full quality at rest. */

/** @import {Api} from "./api.js" */
/** @import {Store} from "./store.js" */
/** @import {PanelName, State} from "./types.js" */

import { loopOf } from "./loop.js";
import { createTransport } from "./transport.js";

const POINTS = { moving: 300, rest: 800 };

/** @typedef {{state: State, moving: boolean}} Ask */

/**
 * @param {Store} store
 * @param {Api} api
 * @param {{onStatus?: (status: "ok" | "waiting" | "error", error: any) => void}} [options]
 * @returns {() => void} stops it
 */
export function startSession(store, api, { onStatus = () => {} } = {}) {
  const { answers } = store;

  /** @param {Ask} ask */
  function request({ state, moving }) {
    const held = answers.panels;
    /** @type {Record<string, string>} */
    const have = {};
    for (const name of answers.wanted) {
      const key = held[name]?.key;
      if (key !== undefined) have[name] = key;
    }
    // While a knob moves the axes hold, so the samples must cover them: the last axes are asked for by value.
    const horizon = state.horizon ?? (moving ? (held.step?.horizon ?? null) : null);
    const omega = held.bode?.omega ?? held.nyquist?.omega;
    return {
      loop: loopOf(state),
      want: answers.wanted,
      have,
      horizon,
      points: moving ? POINTS.moving : POINTS.rest,
      omega: moving && omega ? [omega[0], omega[omega.length - 1]] : null,
      arrays: "f4",
    };
  }

  const transport = createTransport({
    send: (/** @type {Ask} */ ask) => api.loop(request(ask)),
    onAnswer(answer, { moving }) {
      answers.accept(answer, moving);
      onStatus("ok", null);
    },
    onError(error) {
      const waiting = error?.retryAfter !== null && error?.retryAfter !== undefined;
      if (waiting) onStatus("waiting", error);
      else {
        answers.reject(error);
        onStatus("error", error);
      }
    },
    retryAfter: (error) => error?.retryAfter ?? null,
  });

  const ask = (/** @type {boolean} */ moving) => transport.push({ state: store.get(), moving });

  const stopState = store.subscribe((_, change) => {
    if (change.design) ask(change.moving);
  });

  // Panels are mounted one after the other; one request answers them all.
  let asked = false;
  function askSoon() {
    if (asked) return;
    asked = true;
    queueMicrotask(() => {
      asked = false;
      if (answers.wanted.length > 0) ask(false);
    });
  }
  const stopWant = answers.onWant(askSoon);
  askSoon();

  return () => {
    stopState();
    stopWant();
    transport.close();
  };
}

/** @type {PanelName[]} */
export const ALL_PANELS = ["verdict", "step", "bode", "nyquist", "root_locus", "poles", "margins", "metrics", "sensitivity"];
