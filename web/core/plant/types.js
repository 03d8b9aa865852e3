/** Shapes of the plant library's API; this file holds types only and runs nothing. */

/** @import {Complex, Numbers} from "../types.js" */

/** @typedef {{name: string, value: number, unit?: string, min?: number, max?: number, meaning?: string, latex?: string, source?: string}} Quantity  a parameter or an input */
/** @typedef {{name: string, unit?: string, meaning?: string, latex?: string, min?: number, max?: number}} Signal  a state, an output or a variable */
/** @typedef {{name: string, title?: string, inputs?: Values, parameters?: Values, near?: Values}} OperatingPoint */
/** @typedef {Record<string, number>} Values */

/**
 * @typedef {object} PlantDocument
 * @property {string} id
 * @property {string} title
 * @property {string} [summary]
 * @property {string} [notes]
 * @property {string} [time_unit]
 * @property {Quantity[]} [parameters]
 * @property {Quantity[]} [inputs]
 * @property {Signal[]} [variables]
 * @property {Signal[]} states
 * @property {Signal[]} [outputs]
 * @property {OperatingPoint[]} [operating_points]
 */

/** @typedef {{path: string, latex: string, mathml: string}} Equation */
/** @typedef {{K: number, leads: number[], lags: number[], theta: number}} MatrixEntry  K (lead s + 1).../((lag s + 1)...) e^(-theta s) */
/** @typedef {{name: string, unit: string, meaning: string}} MatrixSignal */
/** @typedef {{id: string, time_unit: string, source: string, inputs: MatrixSignal[], outputs: MatrixSignal[], entries: MatrixEntry[][]}} MatrixDocument */
/** @typedef {{kind: "nonlinear" | "transfer-matrix", document: PlantDocument, equations: Equation[], group: string, drawing: object | null, values: Values, time_scale: number | null}} PlantAnswer */
/**
 * @typedef {{id: string, kind: "nonlinear" | "transfer-matrix", title: string, summary: string, group: string, notes: string, time_unit: string, inputs: string[], states: string[],
 *   outputs: string[], operating_points: string[], drawing: object | null, values: Values}} PlantSummary
 */
/** @typedef {{name: string, message: string, t: number}} RunEvent */
/**
 * @typedef {{t: Numbers, states: Record<string, Numbers>, outputs: Record<string, Numbers>, variables: Record<string, Numbers>,
 *   inputs: Record<string, Numbers>, events: RunEvent[], truncated_at: number | null, truncated_reason: string | null}} RunAnswer
 */
/**
 * @typedef {{x: Values, outputs: Values, variables: Values, residual: number, eigenvalues: Complex[], verdict: string, because: string,
 *   kind: string, free: string[], found_by: number}} SteadyState
 */

export {};
