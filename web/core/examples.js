/** Responses worth a look: a plant, an input, and what they show together. */

/** @import {ResponseView, System} from "./types.js" */

/** @typedef {{name: string, teaches: string, plant: System, response: Partial<ResponseView>}} ResponseExample */

/** @param {string} text @returns {System} */
const expr = (text) => ({ type: "expr", text });
const STEP = { type: "step", amplitude: 1, start: 0 };
/** @param {number} omega */
const sine = (omega) => ({ type: "sine", amplitude: 1, omega, phase_deg: 0, start: 0 });

/** @type {ResponseExample[]} */
export const RESPONSE_EXAMPLES = [
  { name: "Resonance", teaches: "1/(s² + 4) under sin 2t: bounded in, unbounded out", plant: expr("1/(s^2+4)"), response: { input: sine(2) } },
  { name: "Off resonance", teaches: "The same under sin 3t: bounded, yet not BIBO stable", plant: expr("1/(s^2+4)"), response: { input: sine(3) } },
  { name: "Integrator", teaches: "1/s under a step: a ramp without end", plant: expr("1/s"), response: { input: STEP } },
  { name: "Unstable pole", teaches: "1/(s − 1): the response is cut where it leaves all bounds", plant: expr("1/(s-1)"), response: { input: STEP } },
  { name: "BIBO stable", teaches: "1/(s² + 0.6 s + 1) under sin t: large, but bounded", plant: expr("1/(s^2+0.6s+1)"), response: { input: sine(1) } },
  {
    name: "Superposition",
    teaches: "A staircase as a sum of shifted steps",
    plant: { type: "sopdt", K: 1, tau: 1, zeta: 0.3, theta: 0.5 },
    response: { input: { type: "sampled", times: [0, 3, 6], values: [1, 3, 2], hold: "zero" }, sum: "superposition" },
  },
  { name: "Convolution", teaches: "A pulse as a row of impulses", plant: expr("1/(s+1)^2"), response: { input: { type: "pulse", amplitude: 1, width: 3, start: 0 }, sum: "convolution", slices: 30 } },
  { name: "Free response", teaches: "No input, only y(0) = 1", plant: expr("1/(s^2+0.6s+1)"), response: { input: { ...STEP, amplitude: 0 }, initial: { y: [1, 0] } } },
];
