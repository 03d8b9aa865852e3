/**
 * A simulation that goes on: the server is asked for the next stretch of time from where the last one ended, one
 * request in flight, and a clock plays back what is there. A changed input takes away what lies ahead of the clock.
 */

/** @import {PlantBench} from "./bench.js" */
/** @import {RunAnswer, RunEvent, Values} from "./types.js" */

/** Seconds of playback in one stretch, and what must lie ahead before the next one is asked for. */
const STRETCH = 1.2;
const AHEAD = 0.7;
/** What stays ahead of the clock when an input changes: the time an answer takes. */
const KEPT = 0.1;
const POINTS = 49;
const LONGEST = 30_000;
const KINDS = /** @type {const} */ (["variables", "outputs", "inputs", "states"]);

/** @typedef {ReturnType<typeof createPlantRun>} PlantRun */
/** @typedef {{t: number[], columns: Record<string, number[]>}} History  columns by "states.T", "inputs.Fi" ... */

/**
 * @param {PlantBench} bench
 * @param {{simulate: (request: object) => Promise<RunAnswer>, speed: number, onChange?: () => void, wait?: (f: () => void, ms: number) => unknown}} options
 *   speed: simulated time in a second
 */
export function createPlantRun(bench, { simulate, speed, onChange = () => {}, wait = (f, ms) => setTimeout(f, ms) }) {
  /** @type {History} */
  let history = { t: [], columns: {} };
  /** @type {RunEvent[]} */
  let events = [];
  /** @type {{t: number, reason: string} | null} */
  let ended = null;
  /** @type {any} */
  let error = null;
  let clock = 0;
  let playing = false;
  let busy = false;
  let whole = false;
  let revision = 0;

  const last = () => history.t.length - 1;
  const end = () => history.t[last()] ?? 0;

  function clear() {
    history = { t: [], columns: {} };
    events = [];
    ended = null;
    error = null;
    clock = 0;
    whole = false;
    revision += 1;
  }

  /** @param {RunAnswer} answer */
  function append(answer) {
    const going = last() >= 0;
    const n = last();
    const jumps = going && Object.entries(answer.inputs).some(([name, values]) => values[0] !== history.columns[`inputs.${name}`]?.[n]);
    const from = going && !jumps ? 1 : 0;
    history.t.push(...answer.t.slice(from));
    for (const kind of KINDS) {
      for (const [name, values] of Object.entries(answer[kind])) (history.columns[`${kind}.${name}`] ??= []).push(...values.slice(from));
    }
    events.push(...answer.events);
    if (answer.truncated_at !== null) ended = { t: answer.truncated_at, reason: answer.truncated_reason ?? "the simulation ends" };
    if (history.t.length > LONGEST) drop(history.t.length - LONGEST);
  }

  /** @param {number} count */
  function drop(count) {
    history.t.splice(0, count);
    for (const column of Object.values(history.columns)) column.splice(0, count);
  }

  /** Takes away what lies ahead of the clock, but for what plays while the server answers. */
  function cut() {
    const until = clock + (playing ? KEPT * speed : 0);
    const keep = history.t.findIndex((t) => t >= until) + 1;
    if (keep === 0 || keep > last()) return;
    history.t.length = keep;
    for (const column of Object.values(history.columns)) column.length = keep;
    events = events.filter(({ t }) => t <= end());
    ended = null;
  }

  async function ask() {
    if (busy || ended || whole || error) return;
    busy = true;
    const asked = revision;
    const at = last();
    const initial = at < 0 ? bench.setting.start : Object.fromEntries(bench.model.states.map(({ name }) => [name, history.columns[`states.${name}`]?.[at] ?? 0]));
    try {
      const answer = await simulate({ ...bench.request(), initial, start: end(), horizon: STRETCH * speed, points: POINTS });
      busy = false;
      // A run that began anew meanwhile has no use for it; one whose inputs moved keeps what is about to be played.
      if (asked === revision || (history.t[at] === answer.t[0] && last() === at && at >= 0)) {
        append(answer);
        if (asked !== revision) cut();
      }
    } catch (problem) {
      busy = false;
      const { retryAfter } = /** @type {any} */ (problem);
      if (retryAfter) {
        wait(() => void ask(), retryAfter * 1000);
        return;
      }
      if (asked === revision) {
        error = problem;
        playing = false;
      }
    }
    onChange();
    if (asked !== revision || last() < 0) void ask();
  }

  /** Where the clock stands among the samples: the one before, and the share of the way to the next. */
  function place() {
    const { t } = history;
    let low = 0;
    let high = t.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if ((t[middle] ?? 0) <= clock) low = middle;
      else high = middle;
    }
    const [a = 0, b = 0] = [t[low], t[high]];
    return { low, high: Math.max(low, high), share: b > a ? Math.min(1, Math.max(0, (clock - a) / (b - a))) : 0 };
  }

  return {
    get clock() {
      return clock;
    },
    get end() {
      return end();
    },
    get start() {
      return history.t[0] ?? 0;
    },
    get playing() {
      return playing;
    },
    get speed() {
      return speed;
    },
    /** True where the curves are those of an experiment, known to their end. */
    get whole() {
      return whole;
    },
    get error() {
      return error;
    },
    get history() {
      return history;
    },
    /** What has happened up to the clock, and the end of the run where the clock has come to it. */
    get told() {
      return { events: events.filter(({ t }) => t <= clock || whole), ended: ended && (whole || clock >= ended.t - 1e-12 * Math.abs(ended.t)) ? ended : null };
    },
    /** @param {number} value */
    setSpeed(value) {
      speed = value;
      if (!whole) cut();
      revision += 1;
    },
    play() {
      if (error) this.reset();
      if (clock >= end() && (ended || whole)) {
        if (whole) clock = this.start;
        else this.reset();
      }
      playing = true;
      void ask();
      onChange();
    },
    pause() {
      playing = false;
      onChange();
    },
    /** Back to the start, at rest. */
    reset() {
      clear();
      playing = false;
      void ask();
      onChange();
    },
    /** An input or a parameter has changed. */
    changed() {
      if (clock === 0 || whole) {
        const going = playing && !whole;
        clear();
        playing = going;
      } else {
        error = null;
        revision += 1;
        cut();
      }
      void ask();
      onChange();
    },
    /** Shows the complete curves of an experiment. @param {RunAnswer} answer */
    show(answer) {
      clear();
      append(answer);
      whole = true;
      playing = true;
      onChange();
    },
    /** @param {number} t */
    seek(t) {
      playing = false;
      clock = Math.min(end(), Math.max(this.start, t));
      onChange();
    },
    /** @param {number} seconds  since the last tick @param {number} [rate]  simulated time in a second */
    tick(seconds, rate = speed) {
      if (!playing) return;
      clock = Math.min(end(), clock + seconds * rate);
      if (end() - clock < AHEAD * speed) void ask();
      if (clock >= end() && (ended || whole)) {
        playing = false;
        onChange();
      }
    },
    /** Every signal at the clock. @returns {Values} */
    values() {
      const { low, high, share } = place();
      /** @type {Values} */
      const now = { ...bench.setting.parameters };
      for (const kind of KINDS) {
        for (const [name, column] of Object.entries(history.columns)) {
          if (!name.startsWith(kind)) continue;
          const [a, b] = [column[low] ?? NaN, column[high] ?? NaN];
          now[name.slice(kind.length + 1)] = kind === "inputs" ? a : a + share * (b - a);
        }
      }
      return now;
    },
    /** The states at the clock, as a start for something else. @returns {Values} */
    stateNow() {
      const now = this.values();
      return Object.fromEntries(bench.model.states.map(({ name }) => [name, now[name] ?? 0]));
    },
  };
}
