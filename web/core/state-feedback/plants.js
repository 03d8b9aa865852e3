/** The plants that the state feedback page offers, and how each is shown: what is tilted, held, limited and pushed. */

/** @import {Complex} from "../types.js" */

/** @typedef {{state: string, label: string, factor: number, unit: string, min: number, max: number, step: number}} Tilt  shown value = factor times the deviation of the state */
/** @typedef {{state: string, low: number, high: number}} MapAxis  deviations from the steady state */

/**
 * @typedef {object} FeedbackProfile
 * @property {string} id  of the library, or "matrices"
 * @property {string} label
 * @property {string | null} point  operating point
 * @property {string[] | null} actuators
 * @property {string} controlled  the output with a setpoint
 * @property {Tilt[]} tilts  the first is the one that is let go
 * @property {{min: number, max: number, unit: string, label: string}} setpoint  a deviation
 * @property {{min: number, max: number, value: number, unit: string} | null} limit  of the input, either way; null takes the plant's own range
 * @property {{size: number, duration: number, label: string} | null} push
 * @property {string | null} endless  the parameter that is set very large to take the track away
 * @property {Complex[] | null} poles  null: those of the regulator
 * @property {Record<string, number>} sizes  deviations that count as one in the regulator's weights
 * @property {number} effort  the same for the input
 * @property {[MapAxis, MapAxis] | null} map
 * @property {number | null} horizon  null goes by the slowest pole
 */

export const ENDLESS = 10_000;

/** @type {FeedbackProfile[]} */
export const PROFILES = [
  {
    id: "cart-pendulum",
    label: "Inverted pendulum on a cart",
    point: "upright",
    actuators: ["F"],
    controlled: "x",
    tilts: [
      { state: "phi", label: "Tilt", factor: 180 / Math.PI, unit: "°", min: -90, max: 90, step: 1 },
      { state: "omega", label: "Turning speed", factor: 1, unit: "rad/s", min: -8, max: 8, step: 0.1 },
    ],
    setpoint: { min: -0.8, max: 0.8, unit: "m", label: "Cart goes to" },
    limit: { min: 2, max: 50, value: 20, unit: "N" },
    push: { size: 6, duration: 0.1, label: "Push the cart" },
    endless: "x_end",
    poles: [[-2, 1], [-2, -1], [-5, 0], [-6, 0]],
    sizes: { x: 0.3, v: 1, phi: 0.3, omega: 1 },
    effort: 3,
    map: [{ state: "phi", low: -1.4, high: 1.4 }, { state: "omega", low: -8, high: 8 }],
    horizon: 6,
  },
  {
    id: "cstr",
    label: "Stirred tank reactor, held where it is unstable",
    point: "middle",
    actuators: ["Q"],
    controlled: "T",
    tilts: [{ state: "T", label: "Too hot by", factor: 1, unit: "K", min: -80, max: 80, step: 1 }, { state: "cA", label: "More feed left by", factor: 1, unit: "", min: -0.4, max: 0.4, step: 0.01 }],
    setpoint: { min: -20, max: 20, unit: "K", label: "Temperature up by" },
    limit: null,
    push: { size: 5e6, duration: 0.1, label: "Heat pulse" },
    endless: null,
    poles: null,
    sizes: { cA: 0.2, T: 10 },
    effort: 2e6,
    map: [{ state: "T", low: -80, high: 80 }, { state: "cA", low: -0.4, high: 0.4 }],
    horizon: null,
  },
  {
    id: "two-tanks-interacting",
    label: "Two tanks that interact",
    point: "half-full",
    actuators: ["Fi"],
    controlled: "h2",
    tilts: [{ state: "h1", label: "First tank higher by", factor: 1, unit: "m", min: -0.45, max: 0.6, step: 0.01 }, { state: "h2", label: "Second tank higher by", factor: 1, unit: "m", min: -0.45, max: 0.6, step: 0.01 }],
    setpoint: { min: -0.2, max: 0.4, unit: "m", label: "Level up by" },
    limit: null,
    push: { size: 3, duration: 0.3, label: "Pour in" },
    endless: null,
    poles: null,
    sizes: { h1: 0.3, h2: 0.1 },
    effort: 1,
    map: [{ state: "h1", low: -0.45, high: 0.6 }, { state: "h2", low: -0.45, high: 0.6 }],
    horizon: null,
  },
  {
    id: "matrices",
    label: "My own A, B, C, D",
    point: null,
    actuators: null,
    controlled: "y1",
    tilts: [],
    setpoint: { min: -2, max: 2, unit: "", label: "Setpoint" },
    limit: null,
    push: { size: 1, duration: 0.5, label: "Push the input" },
    endless: null,
    poles: null,
    sizes: {},
    effort: 1,
    map: null,
    horizon: null,
  },
];

/** @param {string} id @returns {FeedbackProfile} */
export function profileOf(id) {
  const found = PROFILES.find((profile) => profile.id === id) ?? PROFILES[0];
  if (!found) throw new Error("there is no plant");
  return found;
}
