/** The REST client: JSON in, JSON out, and one readable error for whatever goes wrong. */

/** @import {LabSummary, LoopAnswer, RootLocusPanel, System, TuneAnswer} from "./types.js" */

import { decodeArrays } from "./decode.js";

export class ApiError extends Error {
  /**
   * @param {string} message
   * @param {{code?: string, path?: string | null, hint?: string | null, status?: number, retryAfter?: number | null}} [details]
   */
  constructor(message, { code = "error", path = null, hint = null, status = 0, retryAfter = null } = {}) {
    super(message);
    this.name = "ApiError";
    this.code = code;
    this.path = path;
    this.hint = hint;
    this.status = status;
    /** Seconds after which it may work; null where asking again cannot help. */
    this.retryAfter = retryAfter;
  }

  /** Where in a typed expression the error is, counted from 1. */
  get column() {
    const found = /\bcolumn (\d+)/.exec(`${this.message} ${this.hint ?? ""}`);
    return found ? Number(found[1]) : null;
  }
}

/** @typedef {ReturnType<typeof createApi>} Api */

/**
 * @param {{base?: string, fetch?: typeof globalThis.fetch}} [options]
 */
export function createApi({ base = "/api/v1", fetch = globalThis.fetch.bind(globalThis) } = {}) {
  /**
   * @param {string} path
   * @param {object} [body]
   * @returns {Promise<any>}
   */
  async function call(path, body) {
    let response;
    try {
      response = await fetch(base + path, {
        method: body === undefined ? "GET" : "POST",
        headers: body === undefined ? { Accept: "application/json" } : { Accept: "application/json", "Content-Type": "application/json" },
        ...(body === undefined ? {} : { body: JSON.stringify(body) }),
      });
    } catch {
      throw new ApiError("The server cannot be reached.", { code: "unreachable", hint: "Is it still running?", retryAfter: 1 });
    }
    const answer = await response.json().catch(() => null);
    if (response.ok && answer !== null) return answer;
    const error = answer?.error ?? {};
    const busy = response.status === 503 || response.status === 429;
    throw new ApiError(error.message ?? `The server answered ${response.status}.`, {
      code: error.code,
      path: error.path,
      hint: error.hint,
      status: response.status,
      retryAfter: busy ? Number(response.headers.get("Retry-After")) || 1 : null,
    });
  }

  return {
    /** @param {object} request @returns {Promise<LoopAnswer>} */
    loop: async (request) => decodeArrays(await call("/loop", request)),
    /** @param {object} request @returns {Promise<Omit<RootLocusPanel, "key">>} */
    rootLocus: (request) => call("/root-locus", request),
    /** @param {{plant?: System, model?: object, ultimate?: object, relay?: object, rules?: string[], types?: string[]}} request @returns {Promise<TuneAnswer>} */
    tune: (request) => call("/tune", request),
    /** @returns {Promise<{rules: import("./workbench/analysis-types.js").RuleEntry[]}>} */
    rules: () => call("/tune/rules"),
    /** One analysis. @param {"response" | "laplace" | "routh" | "stability" | "state-space" | "approximate" | "compare" | "gain-map" | "tune/optimal" | "tune/trade-off" | "mimo/rga" | "mimo/simulate" | "mimo/interaction" | "mimo/decoupler" | "mimo/tune" | "state-feedback" | "state-feedback/simulate" | "state-feedback/region" | "pole-placement" | "smith" | "limits" | "bode-integral" | "spectrum"} route @param {object} request @returns {Promise<any>} */
    analyse: async (route, request) => decodeArrays(await call(`/${route}`, request)),
    /** @returns {Promise<{plants: import("./plant/types.js").PlantSummary[]}>} */
    plants: () => call("/plants"),
    /** @param {string} id @returns {Promise<import("./plant/types.js").PlantAnswer>} */
    plant: (id) => call(`/plants/${encodeURIComponent(id)}`),
    /** One thing worked out for a plant. @param {string} id @param {string} route @param {object} request @returns {Promise<any>} */
    workOut: (id, route, request) => call(`/plants/${encodeURIComponent(id)}/${route}`, request),
    /** @param {"step-test" | "ultimate-cycle" | "relay"} kind @param {object} request @returns {Promise<any>} */
    experiment: (kind, request) => call(`/experiments/${kind}`, request),
    /** @param {object} request @returns {Promise<import("./experiments/types.js").IdentifyAnswer>} */
    identify: (request) => call("/identify", request),
    /** @returns {Promise<{labs: LabSummary[]}>} */
    labs: () => call("/labs"),
    /** @param {string} id @returns {Promise<any>} */
    lab: (id) => call(`/labs/${encodeURIComponent(id)}`),
    /** @param {string} id @param {object} answer @returns {Promise<any>} */
    check: (id, answer) => call(`/labs/${encodeURIComponent(id)}/check`, answer),
    /** @returns {Promise<{status: string, version: string}>} */
    health: () => call("/health"),
  };
}
