/**
 * A drawing being shown: which signal moves what. Shapes are built once and hand over what follows a signal; new
 * values then touch only the attributes that change.
 */

/** @typedef {Record<string, any>} Shape  a shape of the drawing; the server's schema says what it may hold */
/** @typedef {{path: string, message: string}} Problem */
/** @typedef {{signal: string, apply: (value: number | undefined) => void}} Watcher */
/** @typedef {{describe: () => string}} Spoken */

import { colourAt, colourOf } from "./colours.js";

/** What is wrong with one property of a shape; the rest is drawn. */
export class ShapeError extends Error {
  /** @param {string} property @param {string} message */
  constructor(property, message) {
    super(message);
    this.property = property;
  }
}

export class Scene {
  /** @type {Map<string, ((value: number | undefined) => void)[]>} */
  #watchers = new Map();
  /** @type {Map<string, number>} */
  #values = new Map();
  /** @type {{animation: Animation, rate: number}[]} */
  #running = [];
  #still = false;
  /** @type {Problem[]} */
  problems = [];
  /** @type {Spoken[]} */
  readouts = [];
  /** Called when the size of the text, in units of the view, has changed. @type {((size: number) => void)[]} */
  onTextSize = [];
  /** Called when the units of the signals are known. @type {((units: Record<string, string>) => void)[]} */
  onUnits = [];
  /** Where the shape being built stands, for problems. */
  path = "";
  /** Index of the shape being built among its repetitions. */
  index = 0;

  /** Signals that the drawing names, each with the first place that does. @type {Map<string, string>} */
  named = new Map();

  /** A finite size above 0. @param {Shape} shape @param {string} property @param {number} [fallback] */
  size(shape, property, fallback) {
    const value = shape[property] ?? fallback;
    if (typeof value !== "number" || !Number.isFinite(value) || value <= 0) throw new ShapeError(property, "must be a number above 0");
    return value;
  }

  /** A list of [x, y]. @param {Shape} shape @returns {[number, number][]} */
  points(shape) {
    const points = shape["points"];
    const good = Array.isArray(points) && points.length > 1 && points.every((p) => Array.isArray(p) && p.length === 2 && p.every(Number.isFinite));
    if (!good) throw new ShapeError("points", "must be a list of at least two [x, y]");
    return points;
  }

  /**
   * Calls `apply` with the number that a property has, now and whenever it changes.
   * @param {Shape} shape @param {string} property @param {number} fallback @param {(value: number) => void} apply
   */
  number(shape, property, fallback, apply) {
    const value = shape[property] ?? fallback;
    if (typeof value === "number" && Number.isFinite(value)) {
      apply(value);
      return;
    }
    const { from, to, clamp } = this.#binding(value, property);
    let last = Number.NaN;
    this.watch(value.signal, `${property}.signal`, (signal) => {
      const part = signal === undefined ? 0.5 : (signal - from[0]) / (from[1] - from[0]);
      const held = clamp ? Math.min(1, Math.max(0, part)) : part;
      const now = to[0] + held * (to[1] - to[0]);
      // a hundredth of a unit is below what a screen shows
      if (Math.abs(now - last) < 1e-4 * Math.abs(to[1] - to[0])) return;
      last = now;
      apply(now);
    });
  }

  /**
   * Calls `apply` with the CSS colour that a property has, now and whenever it changes; "none" is a colour.
   * @param {Shape} shape @param {string} property @param {string} fallback @param {(colour: string) => void} apply
   */
  colour(shape, property, fallback, apply) {
    const value = shape[property] ?? fallback;
    if (typeof value === "string") {
      const colour = colourOf(value);
      if (colour === undefined) throw new ShapeError(property, `no colour is called "${value}"`);
      apply(colour);
      return;
    }
    const { from } = this.#binding(value, property);
    let last = "";
    this.watch(value.signal, `${property}.signal`, (signal) => {
      const part = signal === undefined ? 0.5 : (signal - from[0]) / (from[1] - from[0]);
      const now = colourAt(value.scale, Math.min(1, Math.max(0, part)));
      if (now === undefined) throw new ShapeError(`${property}.scale`, `no scale is called "${value.scale}"`);
      if (now === last) return;
      last = now;
      apply(now);
    });
  }

  /** @param {any} value @param {string} property */
  #binding(value, property) {
    if (typeof value?.signal !== "string") throw new ShapeError(property, "must be a finite number or a binding to a signal");
    const { from = [0, 1], to = [0, 1], clamp = true } = value;
    for (const [name, pair] of Object.entries({ from, to })) {
      if (!Array.isArray(pair) || pair.length !== 2 || !pair.every(Number.isFinite)) throw new ShapeError(`${property}.${name}`, "must be two finite numbers");
    }
    if (from[0] === from[1]) throw new ShapeError(`${property}.from`, "must span a range");
    return { from, to, clamp };
  }

  /**
   * Calls `apply` with the value of a signal, now and whenever it changes; undefined while there is none.
   * @param {string} signal @param {string} place  of its name within the shape @param {(value: number | undefined) => void} apply
   */
  watch(signal, place, apply) {
    apply(this.#values.get(signal));
    if (!this.named.has(signal)) this.named.set(signal, `${this.path}.${place}`);
    const watchers = this.#watchers.get(signal);
    if (watchers) watchers.push(apply);
    else this.#watchers.set(signal, [apply]);
  }

  /** @param {Record<string, number>} values */
  show(values) {
    for (const [signal, value] of Object.entries(values)) {
      const shown = Number.isFinite(value) ? value : undefined;
      if (this.#values.has(signal) && this.#values.get(signal) === shown) continue;
      if (shown === undefined) this.#values.delete(signal);
      else this.#values.set(signal, shown);
      for (const apply of this.#watchers.get(signal) ?? []) apply(shown);
    }
  }

  /**
   * Lets an element turn, or its dashes run, at a speed; backwards where it is negative.
   * @param {SVGElement} element @param {PropertyIndexedKeyframes} keyframes @param {number} duration  ms of one turn at speed 1
   * @returns {(speed: number) => void}
   */
  motion(element, keyframes, duration) {
    const animation = element.animate(keyframes, { duration, iterations: Infinity });
    // from far on, so that it can run backwards for days before it meets its beginning
    animation.currentTime = duration * 1e6;
    animation.pause();
    const entry = { animation, rate: 0 };
    this.#running.push(entry);
    return (speed) => {
      // a new rate costs a restart of the animation: not for what no eye sees
      if (speed !== 0 && Math.abs(speed - entry.rate) < 0.02 * Math.abs(speed)) return;
      entry.rate = speed;
      this.#drive(entry);
    };
  }

  /** @param {{animation: Animation, rate: number}} entry */
  #drive({ animation, rate }) {
    const moves = !this.#still && rate !== 0;
    if (moves) {
      animation.playbackRate = rate;
      if (animation.playState !== "running") animation.play();
    } else if (animation.playState === "running") {
      animation.pause();
    }
  }

  set still(still) {
    if (still === this.#still) return;
    this.#still = still;
    this.#running.forEach((entry) => this.#drive(entry));
  }
  get still() {
    return this.#still;
  }

  dispose() {
    for (const { animation } of this.#running) animation.cancel();
    this.#running = [];
    this.#watchers.clear();
  }

  /** @param {string} property @param {string} message */
  complain(property, message) {
    this.problems.push({ path: property ? `${this.path}.${property}` : this.path, message });
  }
}
