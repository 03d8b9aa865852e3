/** The experiment page's setting <-> query string. Names are those of the API, so that a link can be written by hand. */

/** @import {ExperimentKind, LineName, MethodName, PlantKind, Setting} from "./types.js" */

import { LINE_NAMES, METHODS } from "./construction.js";
import { toInput } from "../format.js";

export const KINDS = /** @type {ExperimentKind[]} */ (["step", "hand", "search", "relay"]);
const MAX_TEXT = 500;
const NAME = /^[\w-]{0,64}$/;
const PICK = /^([a-z_0-9]+)\.(P|PI|PD|PID)$/;
const PLANT_KINDS = /** @type {PlantKind[]} */ (["expr", "fopdt", "library"]);
const NUMBERS = { plant: /** @type {const} */ (["K", "tau", "theta", "noise", "drift", "u_min", "u_max", "sensor_tau", "sensor_theta"]), experiment: /** @type {const} */ (["size", "start", "horizon", "points", "amplitude", "hysteresis", "Kc", "change"]) };
const NAMES = /** @type {const} */ (["id", "input", "output", "point"]);
const POSITIVE = new Set(["tau", "sensor_tau", "horizon", "amplitude", "Kc"]);
const NOT_NEGATIVE = new Set(["theta", "noise", "sensor_theta", "start", "hysteresis"]);

/** @returns {Setting} */
export function startingSetting() {
  return {
    plant: { kind: "expr", text: "2 exp(-3s)/((10s+1)(3s+1))", K: 2, tau: 10, theta: 3, id: "tanks-in-series", input: "", output: "", point: "", noise: 0, drift: 0, u_min: null, u_max: null, sensor_tau: null, sensor_theta: 0 },
    experiment: { kind: "step", size: null, start: null, horizon: null, points: 200, amplitude: null, hysteresis: null, Kc: null, change: null },
    method: "two_point",
    moved: {},
    pick: null,
  };
}

/** @param {string} name @param {number} value */
function allowed(name, value) {
  if (!Number.isFinite(value)) return false;
  if (name === "points") return Number.isInteger(value) && value >= 20 && value <= 5000;
  return POSITIVE.has(name) ? value > 0 : NOT_NEGATIVE.has(name) ? value >= 0 : true;
}

/** Only what is not as it starts. @param {Setting} setting @returns {string} */
export function toQuery({ plant, experiment, method, moved, pick }) {
  const start = startingSetting();
  const query = new URLSearchParams();
  if (plant.kind === "expr") {
    if (plant.text !== start.plant.text) query.set("plant", plant.text);
  } else query.set("plant", plant.kind);
  if (plant.kind === "library") for (const name of NAMES) if (plant[name]) query.set(name, plant[name]);
  for (const part of /** @type {const} */ (["plant", "experiment"])) {
    for (const name of NUMBERS[part]) {
      const own = plant.kind === "fopdt" || !["K", "tau", "theta"].includes(name);
      const value = /** @type {any} */ (part === "plant" ? plant : experiment)[name];
      if (own && value !== null && value !== /** @type {any} */ (start[part])[name]) query.set(name, toInput(value));
    }
  }
  if (experiment.kind !== "step") query.set("experiment", experiment.kind);
  if (method !== start.method) query.set("method", method);
  for (const [name, value] of Object.entries(moved)) query.set(`line.${name}`, toInput(value));
  if (pick) query.set("pick", `${pick.rule}.${pick.type}`);
  return query.toString().replace(/%2C/g, ",").replace(/%2F/g, "/").replace(/%28/g, "(").replace(/%29/g, ")").replace(/%5E/g, "^");
}

/** Anything that the query does not say well is as it starts. @param {string} search @returns {Setting} */
export function fromQuery(search) {
  const query = new URLSearchParams(search);
  const setting = startingSetting();
  const { plant, experiment } = setting;
  const text = query.get("plant") ?? "";
  const kind = PLANT_KINDS.find((each) => each === text && each !== "expr");
  if (kind) plant.kind = kind;
  else if (text.trim() !== "" && text.length <= MAX_TEXT) plant.text = text;
  for (const name of NAMES) if (NAME.test(query.get(name) ?? "")) plant[name] = query.get(name) ?? plant[name];
  for (const part of /** @type {const} */ (["plant", "experiment"])) {
    for (const name of NUMBERS[part]) {
      const raw = query.get(name);
      if (raw !== null && raw.trim() !== "" && allowed(name, Number(raw))) /** @type {any} */ (setting[part])[name] = Number(raw);
    }
  }
  experiment.kind = KINDS.find((each) => each === query.get("experiment")) ?? experiment.kind;
  setting.method = /** @type {MethodName[]} */ (Object.keys(METHODS)).find((each) => each === query.get("method")) ?? setting.method;
  for (const name of LINE_NAMES) {
    const raw = query.get(`line.${name}`);
    if (raw !== null && raw.trim() !== "" && Number.isFinite(Number(raw))) setting.moved[/** @type {LineName} */ (name)] = Number(raw);
  }
  const [, rule, type] = PICK.exec(query.get("pick") ?? "") ?? [];
  if (rule) setting.pick = { rule, type: /** @type {any} */ (type) };
  return setting;
}
