/**
 * One analysis of the present design: asked at rest, never while a knob moves, and only where the question has
 * changed; the newest answer is the one kept.
 */

/** @import {Store} from "../store.js" */
/** @import {State} from "../types.js" */

import { createTransport } from "../transport.js";

/**
 * @template Request, Answer
 * @typedef {object} AnalysisOptions
 * @property {(state: State) => Request | null} request  null where there is nothing to ask
 * @property {(request: Request) => Promise<Answer>} send
 */

/**
 * @template Answer
 * @typedef {{answer: Answer | null, error: any, pending: boolean, dispose: () => void}} Analysis
 */

/**
 * @template Request, Answer
 * @param {Store} store
 * @param {AnalysisOptions<Request, Answer>} options
 * @param {() => void} onChange
 * @returns {Analysis<Answer>}
 */
export function createAnalysis(store, { request, send }, onChange) {
  /** @type {Analysis<Answer>} */
  const analysis = { answer: null, error: null, pending: false, dispose };
  let asked = "";

  const transport = createTransport({
    send,
    onAnswer(/** @type {Answer} */ answer, /** @type {Request} */ value) {
      // An answer to a question that is no longer asked.
      if (JSON.stringify(value) !== asked) return;
      Object.assign(analysis, { answer, error: null, pending: false });
      onChange();
    },
    onError(error, value) {
      if (JSON.stringify(value) !== asked) return;
      Object.assign(analysis, { error, pending: false });
      onChange();
    },
    retryAfter: (error) => error?.retryAfter ?? null,
  });

  function ask() {
    const value = request(store.get());
    const key = value === null ? "" : JSON.stringify(value);
    if (key === asked) return;
    asked = key;
    if (value === null) {
      Object.assign(analysis, { answer: null, error: null, pending: false });
      onChange();
      return;
    }
    analysis.pending = true;
    transport.push(value);
  }

  const stop = store.subscribe((_, { moving }) => {
    if (!moving) ask();
  });
  ask();

  function dispose() {
    stop();
    transport.close();
  }
  return analysis;
}
