/**
 * What a design page is set to, and what the server said to it: one request in flight, the newest waiting. Who listens
 * is told of both; the address follows at rest.
 */

import { createTransport } from "../transport.js";

const WRITE_MS = 200;

/** @typedef {{moving: boolean, what: "state" | "answer" | "error"}} Change */

/**
 * @template State, Answer
 * @typedef {object} DesignBench
 * @property {Readonly<State>} state
 * @property {Answer | null} answer
 * @property {any} error  of the newest request; null where it was answered
 * @property {(patch: Partial<State>, how?: {moving?: boolean, ask?: boolean}) => void} set
 * @property {(listener: (change: Change) => void) => () => void} subscribe
 */

/**
 * @template State, Answer
 * @param {{
 *   state: State,
 *   send: (state: State, how: {moving: boolean, last: Answer | null}) => Promise<Answer>,
 *   accept?: (state: State, answer: Answer, how: {moving: boolean}) => Partial<State>,
 *   write?: (state: State) => void,
 * }} options  accept: what an answer changes in the state, as poles that the server has added
 * @returns {DesignBench<State, Answer>}
 */
export function createDesignBench({ state, send, accept = () => ({}), write = () => {} }) {
  /** @type {Set<(change: Change) => void>} */
  const listeners = new Set();
  let writing = 0;
  function writeSoon() {
    clearTimeout(writing);
    writing = window.setTimeout(() => write(bench.state), WRITE_MS);
  }
  const tell = (/** @type {Change} */ change) => {
    for (const listener of listeners) listener(change);
  };

  const transport = createTransport({
    send: (/** @type {{state: State, moving: boolean}} */ { state: asked, moving }) => send(asked, { moving, last: bench.answer }),
    onAnswer(answer, { state: asked, moving }) {
      Object.assign(bench, { answer, error: null });
      // What has moved on meanwhile is not put back.
      if (asked === bench.state) bench.state = { ...bench.state, ...accept(bench.state, answer, { moving }) };
      tell({ moving, what: "answer" });
      // What the answer changed belongs in the address too; a page that was only opened keeps its own.
      if (!moving && asked !== opened) writeSoon();
    },
    onError(error, { moving }) {
      bench.error = error;
      tell({ moving, what: "error" });
    },
    retryAfter: (error) => error?.retryAfter ?? null,
  });

  /** @type {DesignBench<State, Answer>} */
  const bench = {
    state,
    answer: null,
    error: null,
    set(patch, { moving = false, ask = true } = {}) {
      bench.state = { ...bench.state, ...patch };
      tell({ moving, what: "state" });
      if (ask) transport.push({ state: bench.state, moving });
      if (!moving) writeSoon();
    },
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
  const opened = bench.state;
  queueMicrotask(() => transport.push({ state: bench.state, moving: false }));
  return bench;
}

/** Puts a query into the address without a step of history. @param {URLSearchParams} query */
export function writeAddress(query) {
  const text = query.toString().replace(/%2C/g, ",").replace(/%3B/g, ";").replace(/%2F/g, "/").replace(/%28/g, "(").replace(/%29/g, ")").replace(/%5E/g, "^");
  history.replaceState(null, "", text ? `?${text}` : location.pathname);
}
