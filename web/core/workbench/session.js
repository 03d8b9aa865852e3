/** Keeps a store's answers up to date with its design: asks while a knob moves, and asks for full quality at rest. */

/** @import {Api} from "../api.js" */
/** @import {Store} from "../store.js" */
/** @import {State} from "../types.js" */

import { runawayHorizon, settledHorizon } from "../horizon.js";
import { loopOf } from "./loop.js";
import { createTransport } from "../transport.js";

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

  /** The time axis found for a plant, so that it holds as long as it suits. */
  let axis = { plant: "", horizon: /** @type {number | null} */ (null) };

  /**
   * At rest the figures are computed over the server's own horizon, which depends on the plant alone, and the
   * curves over a time axis that suits the response.
   * @param {Ask} ask
   */
  async function send(ask) {
    const whole = request(ask);
    if (ask.moving || ask.state.horizon !== null || !whole.want.includes("step")) return api.loop(whole);
    // Curves over time share one axis.
    const timed = whole.want.filter((name) => name === "step" || name === "gang_steps");
    const judged = new Set([...whole.want, "verdict", "metrics"]);
    for (const name of timed) judged.delete(name);
    const figures = await api.loop({ ...whole, want: [...judged] });
    const plant = JSON.stringify([ask.state.plant, ask.state.actuator, ask.state.sensor]);
    const verdict = figures.panels.verdict ?? answers.panels.verdict;
    const suits = verdict?.closed_loop_stable ? settledHorizon(figures.panels.metrics ?? answers.panels.metrics, axis.plant === plant ? axis.horizon : null) : null;
    /** @param {number | null} horizon */
    const curves = async (horizon) => {
      const { panels, unchanged } = await api.loop({ ...whole, want: timed, horizon });
      axis = { plant, horizon: (panels.step ?? answers.panels.step)?.horizon ?? null };
      return { ...figures, panels: { ...figures.panels, ...panels }, unchanged: [...figures.unchanged, ...unchanged] };
    };
    const first = await curves(suits);
    const grows = verdict && !verdict.closed_loop_stable && first.panels.step ? runawayHorizon(first.panels.step) : null;
    return grows === null ? first : curves(grows);
  }

  const transport = createTransport({
    send,
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
