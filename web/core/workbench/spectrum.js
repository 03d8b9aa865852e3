/** What the Spectrum analysis shows: a sine of the student's own, or a signal of the loop, and how it is sampled. */

/** @import {SpectrumView, State} from "../types.js" */

import { parseList } from "../lists.js";
import { loopOf } from "./loop.js";

/** Ends of the sliders. */
export const KNOBS = {
  frequency: { min: 0.1, max: 20 },
  rate: { min: 1, max: 40 },
  loop_rate: { min: 0.1, max: 40 },
  samples: { min: 20, max: 512 },
  loop_samples: { min: 20, max: 512 },
  noise: { min: 0, max: 1 },
};
/** @typedef {keyof typeof KNOBS} KnobName */

const SOURCES = new Set(["sine", "y", "u", "e"]);
const WINDOWS = new Set(["rectangular", "hann"]);
/** What the server takes beyond the sliders' ends. */
const TAKEN = { frequency: [1e-6, 1e6], rate: [1e-6, 1e6], loop_rate: [1e-6, 1e6], samples: [20, 512], loop_samples: [20, 512], noise: [0, 1e6] };

/** @returns {SpectrumView} */
export function startingSpectrum() {
  return { of: "sine", frequency: 1.3, rate: 10, loop_rate: 4, samples: 40, loop_samples: 256, noise: 0.1, setpoint: 0, window: "rectangular" };
}

/** @param {URLSearchParams} query @param {SpectrumView} view */
export function spectrumToQuery(query, view) {
  for (const [name, value] of Object.entries(startingSpectrum())) {
    const now = view[/** @type {keyof SpectrumView} */ (name)];
    if (now !== value) query.set(`spectrum.${name}`, String(now));
  }
}

/** @param {URLSearchParams} query @returns {SpectrumView} */
export function spectrumFromQuery(query) {
  const found = startingSpectrum();
  const of = query.get("spectrum.of") ?? "";
  const window = query.get("spectrum.window") ?? "";
  if (SOURCES.has(of)) found.of = /** @type {SpectrumView["of"]} */ (of);
  if (query.get("spectrum.setpoint") === "1") found.setpoint = 1;
  if (WINDOWS.has(window)) found.window = /** @type {SpectrumView["window"]} */ (window);
  for (const [name, [low = 0, high = 0]] of Object.entries(TAKEN)) {
    const [value] = parseList(query.get(`spectrum.${name}`) ?? "") ?? [];
    if (value !== undefined && value >= low && value <= high) found[/** @type {KnobName} */ (name)] = name.endsWith("samples") ? Math.round(value) : value;
  }
  return found;
}

/** @param {State} state */
export function spectrumRequest(state) {
  const { of, frequency, rate, loop_rate, samples, loop_samples, noise, setpoint, window } = state.view.analyses.spectrum;
  const sampling = { samples: of === "sine" ? samples : loop_samples, window, arrays: "f4" };
  if (of === "sine") return { signal: { type: "sines", sines: [{ amplitude: 1, frequency }] }, rate, ...sampling };
  return { signal: { type: "loop", loop: loopOf(state), of, setpoint, noise }, rate: loop_rate, remove_mean: true, ...sampling };
}
