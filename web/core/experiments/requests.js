/** From what is set on the experiment page to what the API takes. */

/** @import {About, ExperimentSetting, Found, PlantSetting, Setting} from "./types.js" */
/** @import {ControllerType, TuneSetting} from "../types.js" */

import { toInput } from "../format.js";
import { round125 } from "../plant/pace.js";

/** Samples of the loop, on the model and on the plant alike. */
export const LOOP_POINTS = 1000;
/** Samples of held noise over a run. */
const NOISE_VALUES = 300;

/** @param {PlantSetting} plant */
export function systemOf({ kind, text, K, tau, theta, id, input, output, point }) {
  if (kind === "expr") return { type: "expr", text };
  if (kind === "fopdt") return { type: "fopdt", K, tau, theta };
  return { type: "plant", id, input, output, operating_point: point || null };
}

/**
 * What is chosen for the plant where nothing is set.
 * @param {ExperimentSetting} experiment @param {PlantSetting} plant @param {About} about
 */
export function filledIn({ size, start, horizon, points, amplitude, hysteresis, Kc, change }, plant, { scale, span, gain, sign, ultimate }) {
  const library = plant.kind === "library";
  const swing = Math.abs(gain || 1) * span;
  const period = ultimate?.Pu ?? scale;
  return {
    size: size ?? round125(library ? 0.1 * span : 1),
    start: start ?? round125(0.3 * scale),
    horizon: horizon ?? null,
    stepHorizon: horizon ?? (library ? round125(6 * scale) : null),
    cycleHorizon: horizon ?? (library ? round125(25 * period) : null),
    points,
    amplitude: amplitude ?? round125(library ? 0.1 * span : 1),
    hysteresis: hysteresis ?? (library ? round125(0.002 * swing) : plant.noise > 0 ? round125(3 * plant.noise) : 0),
    Kc: Kc ?? round125(0.5 / Math.abs(gain || 1)),
    change: change ?? (library ? round125(0.05 * swing) : 1),
    sign,
  };
}

/** @param {Setting} setting @param {About} about */
export function stepRequest({ plant, experiment }, about) {
  const { size, start, stepHorizon, points } = filledIn(experiment, plant, about);
  const { noise, drift, u_min, u_max } = plant;
  return { plant: systemOf(plant), size, start, horizon: stepHorizon, points, noise, drift, u_min, u_max };
}

/** One run with a gain, or the search where there is none. @param {Setting} setting @param {About} about @param {number | null} Kc */
export function cycleRequest({ plant, experiment }, about, Kc) {
  const { cycleHorizon, sign } = filledIn(experiment, plant, about);
  const request = { plant: systemOf(plant), Kc, horizon: cycleHorizon };
  if (plant.kind !== "library") return request;
  return { ...request, start: (sign * 0.1) / Math.abs(about.gain || 1), sensor: sensorOf(plant) };
}

/** @param {Setting} setting @param {About} about */
export function relayRequest({ plant, experiment }, about) {
  const { amplitude, hysteresis, cycleHorizon, sign } = filledIn(experiment, plant, about);
  const request = { plant: systemOf(plant), amplitude, hysteresis };
  return plant.kind === "library" ? { ...request, negative_gain: sign < 0, horizon: cycleHorizon } : request;
}

/** @param {PlantSetting} plant */
export function sensorOf({ sensor_tau, sensor_theta }) {
  return { lag: sensor_tau === null ? null : { tau: sensor_tau }, theta: sensor_theta };
}

/** What the rules are told; null while nothing is known of the plant. @param {Found} found */
export function tuneRequest({ model, ultimate }) {
  const cycle = ultimate && (ultimate.relay ? { relay: ultimate.relay } : { ultimate: { Ku: ultimate.Ku, Pu: ultimate.Pu } });
  if (!model) return cycle;
  const { type, K, tau, theta } = model.system;
  // With a first-order model the rules of the ultimate cycle take what was measured; other models are plants of their own.
  return type === "fopdt" ? { model: { K, tau, theta }, ...cycle } : { plant: model.system };
}

/** @param {TuneSetting} setting */
export function controllerOf({ Kc, tau_I, tau_D, alpha }) {
  return { type: "pid", Kc: Math.abs(Kc ?? 0), tau_I, tau_D, alpha: alpha ?? 0.1, action: (Kc ?? 0) < 0 ? "direct" : "reverse" };
}

/** The loop around a plant of the library, from rest. @param {Setting} setting @param {About} about @param {TuneSetting} tuned @param {number} horizon */
export function controlRequest({ plant, experiment }, about, tuned, horizon) {
  const { change } = filledIn(experiment, plant, about);
  return {
    operating_point: plant.point || null,
    initial: about.rest ?? {},
    horizon,
    points: LOOP_POINTS,
    loops: [
      {
        output: plant.output,
        input: plant.input,
        setpoint: { level: about.level, add: [{ type: "step", amplitude: change, start: 0 }] },
        controller: controllerOf(tuned),
        bias: about.u0,
        u_min: plant.u_min,
        u_max: plant.u_max,
        anti_windup: tuned.tau_I === null ? "none" : "back_calculation",
        sensor: sensorOf(plant),
        noise: plant.noise > 0 ? { std: plant.noise, interval: horizon / NOISE_VALUES } : null,
      },
    ],
  };
}

/** The same model and controller in the workbench. @param {Found} found @param {PlantSetting} plant @param {TuneSetting} tuned @returns {string | null} */
export function workbenchLink({ model }, plant, { type, Kc, tau_I, tau_D }) {
  const query = new URLSearchParams();
  const system = model?.system ?? (plant.kind === "library" ? null : systemOf(plant));
  if (!system) return null;
  if (system.type === "tf") query.set("plant", `${toInput(system.num[0])}/s exp(-${toInput(system.theta)} s)`);
  else if (system.type === "expr") query.set("plant", system.text);
  else {
    query.set("plant", system.type);
    for (const name of ["K", "tau", "zeta", "theta"]) if (system[name] !== undefined) query.set(name, toInput(system[name]));
  }
  query.set("type", /** @type {ControllerType} */ (type));
  query.set("Kc", toInput(Math.abs(Kc ?? 1)));
  if (tau_I !== null) query.set("tau_I", toInput(tau_I));
  if (tau_D !== null) query.set("tau_D", toInput(tau_D));
  if ((Kc ?? 0) < 0) query.set("action", "direct");
  if (model && plant.kind === "expr") query.set("compare.true_plant", plant.text);
  return `/workbench?${query}`;
}
