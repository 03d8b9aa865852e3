/**
 * The experiment page's state: what is set, what each step has found, and who wants to know. What a step finds is for
 * what was set when it was found: a change takes away all that followed from it.
 */

/** @import {About, ExperimentSetting, Found, IdentifyAnswer, Lines, MethodName, Model, Pick, PlantSetting, Result, Setting, Source, Ultimate} from "./types.js" */
/** @import {TuneAnswer} from "../types.js" */

import { fromQuery, toQuery } from "./url.js";

/** @typedef {ReturnType<typeof createExperimentBench>} ExperimentBench */
/** @typedef {"plant" | "about" | "experiment" | "result" | "watched" | "source" | "identified" | "method" | "lines" | "found" | "rules" | "pick"} Topic */

/** @param {string} search */
export function createExperimentBench(search) {
  const setting = fromQuery(search);
  /** @type {Set<(topics: Set<Topic>) => void>} */
  const listeners = new Set();
  /** @type {About | null} */
  let about = null;
  /** @type {any} */
  let trouble = null;
  /** @type {Result | null} */
  let result = null;
  /** Whether the result has been watched to its end: nothing is said of it before. */
  let watched = false;
  /** @type {Source | null} */
  let source = null;
  /** @type {IdentifyAnswer | null} */
  let identified = null;
  /** @type {Found} */
  let found = { model: null, ultimate: null };
  /** @type {TuneAnswer | null} */
  let rules = null;

  /** @param {Topic[]} topics */
  function tell(...topics) {
    const all = new Set(topics);
    for (const listener of [...listeners]) listener(all);
  }

  return {
    /** @type {Readonly<Setting>} */
    get setting() {
      return setting;
    },
    get about() {
      return about;
    },
    /** Why nothing is known of the plant. */
    get trouble() {
      return trouble;
    },
    get result() {
      return result;
    },
    get watched() {
      return watched;
    },
    get source() {
      return source;
    },
    get identified() {
      return identified;
    },
    get found() {
      return found;
    },
    get rules() {
      return rules;
    },
    /** @param {Partial<PlantSetting>} patch */
    setPlant(patch) {
      const other = Object.keys(patch).some((name) => !["noise", "drift", "u_min", "u_max"].includes(name));
      Object.assign(setting.plant, patch);
      if (!other) return tell("plant");
      Object.assign(setting.experiment, { size: null, start: null, horizon: null, amplitude: null, hysteresis: null, Kc: null, change: null });
      if (source?.from === "experiment") [source, identified] = [null, null];
      [about, trouble, result, rules, setting.moved, setting.pick] = [null, null, null, null, {}, null];
      found = { model: source ? found.model : null, ultimate: null };
      tell("plant", "about", "experiment", "result", "source", "identified", "found", "rules", "pick");
    },
    /** @param {About | null} next @param {any} [error] */
    setAbout(next, error = null) {
      [about, trouble] = [next, error];
      tell("about");
    },
    /** @param {Partial<ExperimentSetting>} patch */
    setExperiment(patch) {
      Object.assign(setting.experiment, patch);
      tell("experiment");
    },
    /** @param {Result | null} next */
    setResult(next) {
      [result, watched] = [next, false];
      tell("result");
    },
    /** What the experiment was for, once it has been watched to its end: the record of a step, or an ultimate point. */
    finish() {
      if (!result || !about) return;
      const { kind, answer } = result;
      watched = true;
      if (kind === "step") {
        const { timeUnit, inputUnit, outputUnit, inputName, outputName } = about;
        this.setSource({ from: "experiment", data: { t: answer.t, u: answer.u, y: answer.y }, csv: null, columns: null, u_before: answer.u0, timeUnit, inputUnit, outputUnit, inputName, outputName }, identified === null);
      } else if (kind === "relay" && answer.relay) this.setUltimate({ Ku: answer.Ku, Pu: answer.Pu, by: "the relay", relay: answer.relay });
      else if (kind === "search") this.setUltimate({ Ku: answer.Ku, Pu: answer.Pu, by: "the search", relay: null });
      tell("watched");
    },
    /** @param {Source | null} next @param {boolean} [keepLines]  they came with the address */
    setSource(next, keepLines = false) {
      [source, identified] = [next, null];
      if (!keepLines) setting.moved = {};
      found = { ...found, model: null };
      tell("source", "identified", "found");
    },
    /** @param {IdentifyAnswer | null} next */
    setIdentified(next) {
      identified = next;
      tell("identified");
    },
    /** @param {MethodName} method */
    setMethod(method) {
      [setting.method, setting.moved] = [method, {}];
      tell("method", "lines");
    },
    /** @param {Lines} moved */
    setLines(moved) {
      setting.moved = moved;
      tell("lines");
    },
    /** @param {Model | null} model */
    setModel(model) {
      found = { ...found, model };
      tell("found");
    },
    /** @param {Ultimate | null} ultimate */
    setUltimate(ultimate) {
      found = { ...found, ultimate };
      tell("found");
    },
    /** @param {TuneAnswer | null} next */
    setRules(next) {
      rules = next;
      tell("rules");
    },
    /** @param {Pick | null} next */
    setPick(next) {
      setting.pick = next;
      tell("pick");
    },
    /** The settings picked, as the rules gave them. */
    get tuned() {
      const { pick } = setting;
      return rules?.settings.find(({ rule, type, valid }) => valid && rule === pick?.rule && type === pick.type) ?? null;
    },
    query: () => toQuery(setting),
    /** @param {Topic[]} topics @param {() => void} listener @returns {() => void} */
    on(topics, listener) {
      const heard = (/** @type {Set<Topic>} */ told) => {
        if (topics.some((topic) => told.has(topic))) listener();
      };
      listeners.add(heard);
      return () => listeners.delete(heard);
    },
  };
}
