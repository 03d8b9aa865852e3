/**
 * Requests of a page whose values change faster than the server answers.
 *
 * One is in flight; of those that arrive meanwhile only the newest waits. None is ever aborted: the server
 * would compute it anyway, and a drag that aborts shows nothing until it ends. So the last value is always
 * sent, and its answer is the last one shown.
 */

/**
 * @template Value, Answer
 * @typedef {object} TransportOptions
 * @property {(value: Value) => Promise<Answer>} send
 * @property {(answer: Answer, value: Value) => void} onAnswer
 * @property {(error: any, value: Value) => void} onError
 * @property {(error: any) => number | null} [retryAfter]  seconds to wait before the same value is sent again; null gives up
 * @property {(callback: () => void, ms: number) => unknown} [wait]
 */

/**
 * @template Value, Answer
 * @param {TransportOptions<Value, Answer>} options
 */
export function createTransport({ send, onAnswer, onError, retryAfter = () => null, wait = (f, ms) => setTimeout(f, ms) }) {
  /** @type {{seq: number, value: Value} | null} */
  let waiting = null;
  let busy = false;
  let closed = false;
  let newest = 0;
  let shown = 0;

  async function pump() {
    if (busy || waiting === null || closed) return;
    const { seq, value } = waiting;
    waiting = null;
    busy = true;
    let pause = null;
    try {
      const answer = await send(value);
      if (!closed && seq > shown) {
        shown = seq;
        onAnswer(answer, value);
      }
    } catch (error) {
      if (!closed) {
        pause = retryAfter(error);
        // A newer value is on its way: what was wrong with this one is no longer of interest.
        if (waiting === null) onError(error, value);
        if (pause !== null && waiting === null) waiting = { seq, value };
      }
    }
    if (pause !== null) await new Promise((/** @type {(value?: unknown) => void} */ done) => wait(done, pause * 1000));
    busy = false;
    void pump();
  }

  return {
    /** @param {Value} value */
    push(value) {
      newest += 1;
      waiting = { seq: newest, value };
      void pump();
    },
    /** True while an answer is still to come. */
    get pending() {
      return busy || waiting !== null;
    },
    close() {
      closed = true;
      waiting = null;
    },
  };
}
