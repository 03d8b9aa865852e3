/** The state feedback page at work: what it is set to, what the server says of it, and the clock that plays a run. */

/** @import {Api} from "../api.js" */
/** @import {FeedbackDesign, FeedbackRun, FeedbackState, PushNow} from "./feedback.js" */

import { designRequest, endOf, MOST_PUSHES, runRequest } from "./feedback.js";
import { profileOf } from "./plants.js";
import { createTransport } from "../transport.js";

/** @typedef {ReturnType<typeof createFeedbackSession>} FeedbackSession */
/** @typedef {{moving: boolean, design: boolean}} FeedbackChange  design: what is said of the design may be new */

/** Seconds from the press to the push: about what the server takes, so that nothing that was seen changes. */
const LEAD = 0.1;
/** A plant whose time is not that of people is played in this many seconds. */
const PLAYED_IN = 6;

/** @param {Api} api @param {FeedbackState} initial */
export function createFeedbackSession(api, initial) {
  let state = initial;
  /** @type {FeedbackDesign | null} */
  let design = null;
  /** @type {FeedbackRun | null} */
  let run = null;
  /** @type {any} */
  let error = null;
  /** @type {PushNow[]} */
  let pushes = [];
  let designed = "";
  let clock = 0;
  let playing = false;
  let pace = 1;
  /** A push has been asked for, and the run that holds it is not there yet. */
  let awaited = false;
  let moving = false;
  /** @type {Set<(change: FeedbackChange) => void>} */
  const listeners = new Set();
  const tell = (/** @type {FeedbackChange} */ change) => listeners.forEach((listener) => listener(change));

  const transport = createTransport({
    /** @param {{state: FeedbackState, pushes: PushNow[]}} asked */
    async send(asked) {
      const request = designRequest(asked.state);
      const key = JSON.stringify(request);
      const found = key === designed && design ? design : /** @type {FeedbackDesign} */ (await api.analyse("state-feedback", request));
      return { key, design: found, run: /** @type {FeedbackRun} */ (await api.analyse("state-feedback/simulate", runRequest(asked.state, found, asked.pushes))) };
    },
    onAnswer(answer, asked) {
      // Who looks at how a run ended sees how the next one ends, while a pole is dragged or the track is taken away.
      const ended = run !== null && clock > 0 && !playing && !awaited && clock >= endOf(run);
      ({ design, run } = answer);
      if (asked.pushes === pushes) awaited = false;
      const anew = answer.key !== designed;
      designed = answer.key;
      error = null;
      clock = ended ? endOf(run) : Math.min(clock, endOf(run));
      tell({ moving, design: anew });
    },
    onError(problem) {
      error = problem;
      playing = awaited = false;
      tell({ moving: false, design: true });
    },
    retryAfter: (problem) => problem.retryAfter ?? null,
  });
  /** Time of the plant in a second of playing. */
  const rate = () => (run && profileOf(state.plant).horizon === null ? run.horizon / PLAYED_IN : 1) * pace;
  const ask = () => transport.push({ state, pushes });

  return {
    get state() {
      return state;
    },
    get profile() {
      return profileOf(state.plant);
    },
    get design() {
      return design;
    },
    get run() {
      return run;
    },
    get error() {
      return error;
    },
    get clock() {
      return clock;
    },
    get end() {
      return run ? endOf(run) : 0;
    },
    get playing() {
      return playing;
    },
    get finished() {
      return run !== null && clock >= endOf(run) && !awaited;
    },
    get pushes() {
      return pushes;
    },
    /** A part of real time, for those who want to see the catch slowly. @param {number} value */
    set pace(value) {
      pace = value;
    },
    get pace() {
      return pace;
    },
    /** @param {Partial<FeedbackState>} patch @param {{moving?: boolean}} [how] */
    set(patch, how = {}) {
      const other = patch.plant !== undefined && patch.plant !== state.plant;
      state = { ...state, ...patch };
      moving = how.moving ?? false;
      pushes = [];
      awaited = false;
      if (other || patch.start) {
        clock = 0;
        playing = false;
      }
      if (other) {
        design = run = null;
        designed = "";
      }
      ask();
      tell({ moving, design: other });
    },
    /** From the start. */
    letGo() {
      if (pushes.length > 0) {
        pushes = [];
        ask();
      }
      clock = 0;
      playing = run !== null;
      tell({ moving: false, design: false });
    },
    play() {
      if (run && clock >= endOf(run)) return this.letGo();
      playing = run !== null;
      tell({ moving: false, design: false });
    },
    pause() {
      playing = false;
      tell({ moving: false, design: false });
    },
    /** A push at this moment: the run is worked out anew with it, and what has been seen stays as it was. @param {number} sign */
    push(sign) {
      const { push } = profileOf(state.plant);
      if (!push || !run || pushes.length >= MOST_PUSHES) return;
      const lost = run.nonlinear !== null && run.nonlinear.outcome !== "caught" && clock >= endOf(run);
      if (lost) return;
      pushes = [...pushes, { size: sign * push.size, start: clock + LEAD * rate(), duration: push.duration }];
      playing = awaited = true;
      ask();
      tell({ moving: false, design: false });
    },
    /** @param {number} t */
    seek(t) {
      playing = false;
      clock = Math.max(0, Math.min(t, this.end));
      tell({ moving: false, design: false });
    },
    /** @param {number} seconds  since the last tick */
    tick(seconds) {
      if (!playing || !run) return;
      clock = Math.min(endOf(run), clock + seconds * rate());
      if (clock >= endOf(run) && !awaited) {
        playing = false;
        tell({ moving: false, design: false });
      }
    },
    /** Every signal at the clock. @returns {Record<string, number>} */
    values() {
      const found = run?.nonlinear ?? run?.linear;
      if (!found) return {};
      const { t } = found;
      let high = t.findIndex((time) => time > clock);
      if (high < 0) high = t.length - 1;
      const low = Math.max(0, high - 1);
      const [a = 0, b = 0] = [t[low], t[high]];
      const share = b > a ? Math.min(1, (clock - a) / (b - a)) : 0;
      /** @type {Record<string, number>} */
      const now = {};
      for (const columns of [found.outputs, found.states, found.inputs]) {
        for (const [name, column] of Object.entries(columns)) now[name] = (column[low] ?? 0) + share * ((column[high] ?? 0) - (column[low] ?? 0));
      }
      return now;
    },
    /** @param {(change: FeedbackChange) => void} listener */
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    ask,
  };
}
