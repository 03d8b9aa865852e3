/** What a student has done in a lab, kept in this browser. A storage that fails is no more than a short memory. */

/** @import {LabExercise, Settings, Status} from "./types.js" */

/** @typedef {{status: Status, score: number, attempts: number, answer: any}} Record */
/** @typedef {{exercises: {[id: string]: Record}, settings: Settings | null}} Saved */
/** @typedef {ReturnType<typeof createProgress>} Progress */
/** @typedef {Pick<Storage, "getItem" | "setItem" | "removeItem">} Store */

const STATUSES = new Set(["correct", "partly", "wrong", "revealed"]);

/** The browser's storage, or null where it is forbidden. @returns {Store | null} */
export function localStore() {
  try {
    return globalThis.localStorage ?? null;
  } catch {
    return null;
  }
}

/** @param {string} labId */
const keyOf = (labId) => `looplab-lab:${labId}`;

/** @returns {Saved} */
const nothing = () => ({ exercises: {}, settings: null });

/**
 * What is stored for a lab; anything that does not look like it counts as nothing.
 * @param {string} labId
 * @param {Store | null} storage
 * @returns {Saved}
 */
export function readProgress(labId, storage) {
  try {
    const saved = JSON.parse(storage?.getItem(keyOf(labId)) ?? "null");
    if (typeof saved?.exercises !== "object" || saved.exercises === null) return nothing();
    const exercises = Object.entries(saved.exercises).filter(([, record]) => STATUSES.has(/** @type {any} */ (record)?.status));
    const settings = saved.settings !== null && typeof saved.settings === "object" ? saved.settings : null;
    return { exercises: Object.fromEntries(exercises), settings };
  } catch {
    return nothing();
  }
}

/** @param {Saved} saved */
export function solvedIn(saved) {
  return Object.values(saved.exercises).filter(({ status }) => status === "correct").length;
}

/** @param {string} labId @param {Store | null} storage */
export function createProgress(labId, storage) {
  let saved = readProgress(labId, storage);
  /** @type {Set<() => void>} */
  const listeners = new Set();

  /** @param {Saved} next */
  function keep(next) {
    saved = next;
    try {
      storage?.setItem(keyOf(labId), JSON.stringify(saved));
    } catch {
      // Full or forbidden: the page still knows it.
    }
    for (const listener of [...listeners]) listener();
  }

  return {
    get saved() {
      return saved;
    },
    /** @param {string} exerciseId @returns {Record | null} */
    of: (exerciseId) => saved.exercises[exerciseId] ?? null,

    /**
     * Notes an attempt. What was solved once stays solved; what was shown earns nothing any more.
     * @param {string} exerciseId
     * @param {Status} status
     * @param {number} score
     * @param {any} answer
     */
    record(exerciseId, status, score, answer) {
      if (!STATUSES.has(status)) return;
      const before = saved.exercises[exerciseId];
      const final = before?.status === "correct" || before?.status === "revealed";
      const attempts = (before?.attempts ?? 0) + (status === "revealed" ? 0 : 1);
      const record = final ? { ...before, attempts } : { status, score, attempts, answer };
      keep({ ...saved, exercises: { ...saved.exercises, [exerciseId]: record } });
    },
    /** @param {Settings} settings */
    keepSettings(settings) {
      if (JSON.stringify(settings) !== JSON.stringify(saved.settings)) keep({ ...saved, settings });
    },
    /** @param {() => void} listener @returns {() => void} */
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    /** Forgets everything. @returns {() => void} takes it back */
    clear() {
      const before = saved;
      keep(nothing());
      return () => keep(before);
    },

    /** @param {LabExercise[]} exercises */
    sum(exercises) {
      const points = exercises.reduce((total, { id, points: worth }) => total + worth * (saved.exercises[id]?.score ?? 0), 0);
      const solved = exercises.filter(({ id }) => saved.exercises[id]?.status === "correct").length;
      return { solved, of: exercises.length, points, ofPoints: exercises.reduce((total, { points: worth }) => total + worth, 0) };
    },
  };
}
