/** What is known of a plant before an experiment: how large and how fast it is, and its ultimate point by frequency analysis. */

/** @import {Api} from "../api.js" */
/** @import {About, PlantSetting} from "./types.js" */
/** @import {PlantAnswer} from "../plant/types.js" */

import { systemOf } from "./requests.js";
import { firstMove } from "../first-move.js";
import { usualRange } from "../plant/bench.js";

/** The rules are not wanted here, only what they start from. */
const LEAST = { rules: ["ziegler_nichols"], types: ["P"] };

/**
 * The plant's system, ultimate point and reaction curve; raises what the server refuses.
 * @param {Api} api @param {object} plant
 */
async function known(api, plant) {
  const { ultimate, model } = await api.tune({ plant: /** @type {any} */ (plant), ...LEAST });
  return { ultimate: ultimate?.Ku != null && ultimate.Pu != null ? { Ku: ultimate.Ku, Pu: ultimate.Pu } : null, reason: ultimate?.reason ?? null, model };
}

/** @param {Api} api @param {PlantSetting} plant @param {PlantAnswer | null} library  of the plant, where it is one of the library @returns {Promise<About>} */
export async function aboutPlant(api, plant, library) {
  if (plant.kind === "library" && library) return aboutLibrary(api, plant, library);
  const { ultimate, reason, model } = await known(api, systemOf(plant));
  const gain = model?.K ?? null;
  const times = model?.tau != null ? model.tau + model.theta : null;
  const sign = Math.sign(ultimate?.Ku ?? gain ?? 1) || 1;
  return { timeUnit: "s", inputUnit: "", outputUnit: "", inputName: "u", outputName: "y", sign, gain, scale: times ?? ultimate?.Pu ?? 1, span: 1, level: 0, ultimate, reason, rest: null, u0: 0 };
}

/** @param {Api} api @param {PlantSetting} plant @param {PlantAnswer} answer @returns {Promise<About>} */
async function aboutLibrary(api, { id, input, output, point, ...rest }, answer) {
  const { inputs = [], outputs = [], time_unit: timeUnit = "s" } = answer.document;
  const linear = await api.workOut(id, "linearize", { operating_point: point || null, input, output });
  const { gain, plant, ss } = linear.channel;
  const u = inputs.find(({ name }) => name === input);
  const y = outputs.find(({ name }) => name === output);
  const level = linear.output_signals.find((/** @type {any} */ each) => each.name === output)?.value ?? 0;
  const unstable = linear.verdict === "unstable";
  const found = await known(api, plant).catch((error) => ({ ultimate: null, reason: /** @type {string} */ (error.message), model: null }));
  // A sensor belongs to the loop that rings: the plant's own ultimate point is then another one.
  const bare = rest.sensor_tau === null && rest.sensor_theta === 0;
  const times = found.model?.tau != null ? found.model.tau + found.model.theta : null;
  const direction = firstMove(ss.A, ss.B, ss.C) || Math.sign(gain || 1);
  return {
    timeUnit,
    inputUnit: u?.unit ?? "",
    outputUnit: y?.unit ?? "",
    inputName: input,
    outputName: output,
    sign: Math.sign(found.ultimate?.Ku ?? (unstable ? direction : gain || direction)) || 1,
    gain,
    scale: times ?? (Math.max(...(linear.time_constants ?? []), 0) || answer.time_scale || 1),
    span: u ? Math.min(usualRange(u).max - usualRange(u).min, 2 * Math.abs(u.value) || Infinity) : 1,
    level,
    ultimate: bare ? found.ultimate : null,
    reason: bare ? found.reason : "frequency analysis here leaves the sensor out, so there is nothing to hold the loop with a sensor against",
    rest: linear.x,
    u0: linear.inputs[input],
  };
}
