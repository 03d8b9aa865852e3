/** Shapes of an experiment, from the plant to the controller; this file holds types only and runs nothing. */

/** @import {ControllerType, TuneSetting} from "../types.js" */

/** @typedef {"step" | "hand" | "search" | "relay"} ExperimentKind */
/** @typedef {"expr" | "fopdt" | "library"} PlantKind */
/** @typedef {"tangent" | "tangent_63" | "two_point" | "sundaresan_krishnaswamy" | "area" | "least_squares" | "least_squares_sopdt" | "least_squares_ipdt"} MethodName */

/**
 * @typedef {object} PlantSetting
 * @property {PlantKind} kind
 * @property {string} text  of an expression
 * @property {number} K
 * @property {number} tau
 * @property {number} theta
 * @property {string} id  of a plant of the library
 * @property {string} input
 * @property {string} output
 * @property {string} point  operating point; "" is the nominal one
 * @property {number} noise  standard deviation
 * @property {number} drift  slope
 * @property {number | null} u_min
 * @property {number | null} u_max
 * @property {number | null} sensor_tau
 * @property {number} sensor_theta
 */

/**
 * @typedef {object} ExperimentSetting  null: chosen for the plant
 * @property {ExperimentKind} kind
 * @property {number | null} size
 * @property {number | null} start
 * @property {number | null} horizon
 * @property {number} points
 * @property {number | null} amplitude
 * @property {number | null} hysteresis
 * @property {number | null} Kc  size of the gain, by hand
 * @property {number | null} change  step of the setpoint in the run of the controller
 */

/** @typedef {{rule: string, type: ControllerType}} Pick */
/** @typedef {Partial<Record<LineName, number>>} Lines */
/** @typedef {"t0" | "t1" | "t2" | "t_ar" | "y0" | "y_final"} LineName */

/**
 * @typedef {object} Setting
 * @property {PlantSetting} plant
 * @property {ExperimentSetting} experiment
 * @property {MethodName} method
 * @property {Lines} moved  construction lines that the student has moved
 * @property {Pick | null} pick
 */

/**
 * What is known of the plant before any experiment: how large and how fast, for fields and clocks, and the ultimate
 * point by frequency analysis to hold an experiment against.
 * @typedef {object} About
 * @property {string} timeUnit
 * @property {string} inputUnit
 * @property {string} outputUnit
 * @property {string} inputName
 * @property {string} outputName
 * @property {number} sign  of the gain that a controller needs
 * @property {number | null} gain  at rest
 * @property {number} scale  about the time in which it answers
 * @property {number} span  of the input, for the size of a step
 * @property {number} level  of the output at rest
 * @property {{Ku: number, Pu: number} | null} ultimate
 * @property {string | null} reason  why there is none
 * @property {Record<string, number> | null} rest  states of a plant of the library at rest
 * @property {number} u0
 */

/** @typedef {{t: number[], u: (number | null)[], y: (number | null)[]}} Columns */
/** @typedef {{from: "experiment" | "text", data: Columns | null, csv: string | null, columns: {t: string, u: string, y: string} | null, u_before: number | null, timeUnit: string, inputUnit: string, outputUnit: string, inputName: string, outputName: string}} Source  what is identified */
/** @typedef {{t: number[], u: number[], y: (number | null)[], hold: string, u_before: number, time_unit: string | null, names: Record<string, string>, units: Record<string, string>, notes: string[]}} Recorded */
/**
 * @typedef {{method: MethodName, name: string, source: string, model: Record<string, number> | null, system: any, fit_pct: number | null, intervals: Record<string, [number, number]> | null,
 *   intervals_note: string, estimated: Record<string, number>, construction: Record<string, number>, y_hat: number[] | null, residuals: (number | null)[] | null, warnings: string[], reason: string | null}} MethodFound
 */
/** @typedef {MethodFound & {record: Recorded, methods: MethodFound[] | null}} IdentifyAnswer */
/** @typedef {{system: any, by: string, hand: boolean}} Model  hand: lines of it were moved */
/** @typedef {{Ku: number, Pu: number, by: string, relay: object | null}} Ultimate  relay: as /tune takes it */
/** @typedef {{t: number[], y: number[]}} Points */
/** @typedef {{kind: ExperimentKind, answer: any}} Result */
/** @typedef {{model: Model | null, ultimate: Ultimate | null}} Found */
/** @typedef {TuneSetting} Settings */

export {};
