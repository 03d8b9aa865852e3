/** Asking again while the server is busy. */

const TIMES = 8;

/**
 * @template Answer
 * @param {() => Promise<Answer>} ask
 * @param {(ms: number) => Promise<unknown>} [wait]
 * @returns {Promise<Answer>}
 */
export async function patiently(ask, wait = (ms) => new Promise((done) => setTimeout(done, ms))) {
  for (let k = 1; ; k++) {
    try {
      return await ask();
    } catch (error) {
      const { retryAfter } = /** @type {any} */ (error);
      if (!retryAfter || k === TIMES) throw error;
      await wait(1000 * retryAfter);
    }
  }
}
