/** Answers of the analysis routes, as far as the pages read them. This file holds types only and runs nothing. */

/** @import {Complex, ControllerType, Numbers} from "../types.js" */

/** @typedef {{text: string, latex: string, mathml: string | null}} Formula */
/** @typedef {Record<string, string>} Reasons */

/**
 * @typedef {object} ResponseAnswer
 * @property {string} time_unit
 * @property {Formula & {order: number, theta: number}} system
 * @property {number} horizon
 * @property {Numbers} t
 * @property {Numbers} u
 * @property {Numbers} y
 * @property {number[]} initial_state
 * @property {{t: number, area: number}[]} impulses
 * @property {number | null} final_value
 * @property {number | null} truncated_at
 * @property {string | null} truncated_reason
 * @property {{terms: {amplitude: number, start: number, y: Numbers}[], free: Numbers, total: Numbers, error: number} | null} superposition
 * @property {{times: Numbers, weights: Numbers, h: Numbers, total: Numbers, exact: Numbers, error: number} | null} convolution
 * @property {Reasons} reasons
 */

/**
 * @typedef {object} LaplaceAnswer
 * @property {string} time_unit
 * @property {Formula} transform
 * @property {{pole: Complex, power: number, coefficient: Complex}[]} partial_fractions
 * @property {number} direct
 * @property {number} theta
 * @property {Formula} expansion
 * @property {string} text
 * @property {string | null} mathml
 * @property {number | null} initial_value
 * @property {number | null} final_value
 * @property {Reasons} reasons
 * @property {{initial_value: number | null, final_value: number | null}} formula
 * @property {Formula | null} forced
 * @property {Formula | null} free
 * @property {{cancelled: Complex[], moved: number, residual: number, simulation_difference: number | null, simulation_reason: string | null}} accuracy
 * @property {number} horizon
 * @property {{t: Numbers, y: Numbers, simulated_t: Numbers, simulated_y: Numbers, truncated_at: number | null, truncated_reason: string | null}} response
 */

/** @typedef {{power: number, label: string, entries: number[], texts: string[], kind: "given" | "computed" | "multiplied" | "auxiliary", computed: number[] | null, note: string | null}} RouthRow */
/** @typedef {{low: number | null, high: number | null, low_omega: number[], high_omega: number[], low_reason: string, high_reason: string}} GainRange */
/** @typedef {{tau_I: number, gain_ranges: GainRange[], reason: string | null}} PiCut */

/**
 * @typedef {object} RouthAnswer
 * @property {string | null} polynomial_text
 * @property {boolean | null} exact
 * @property {RouthRow[] | null} array
 * @property {{degree: number, text: string}[] | null} auxiliary_polynomials
 * @property {number | null} sign_changes
 * @property {number | null} rhp_roots
 * @property {number | null} imaginary_axis_roots
 * @property {number | null} lhp_roots
 * @property {boolean} stable
 * @property {string} because
 * @property {{name: string, value: number, in_range: boolean} | null} gain
 * @property {GainRange[] | null} gain_ranges
 * @property {{cuts: PiCut[]} | null} pi_region
 * @property {Reasons} reasons
 */

/** @typedef {{poles: Complex[], complete: boolean, stable: boolean, because: string}} GangMemberAnswer */

/**
 * @typedef {object} StabilityAnswer
 * @property {Complex[]} poles
 * @property {boolean} complete
 * @property {"stable" | "marginal" | "unstable"} verdict
 * @property {string} because
 * @property {boolean} lyapunov_stable
 * @property {boolean} asymptotically_stable
 * @property {{eigenvalue: Complex, algebraic: number, geometric: number, largest_block: number, singular_values: number[], threshold: number}[] | null} axis_modes
 * @property {{stable: boolean, poles: Complex[], cancelled: Complex[], because: string, unbounded: {name: string, u: string, output: string} | null} | null} bibo
 * @property {{S: GangMemberAnswer, PS: GangMemberAnswer, CS: GangMemberAnswer, T: GangMemberAnswer, cancellations: {text: string, stable: boolean}[], internally_stable: boolean, because: string} | null} internal
 * @property {Reasons} reasons
 */

/** @typedef {{matrix: number[][] | null, singular_values: number[], rank: number, full: boolean, tolerance: number, reason: string | null}} RankAnswer */
/** @typedef {{A: number[][], B: number[][], C: number[][], D: number[][]}} Matrices */

/**
 * @typedef {object} ChannelAnswer
 * @property {Formula | null} system
 * @property {Formula | null} minimal
 * @property {number | null} minimal_order
 * @property {{pole: Complex, zero: Complex, distance: number, stable: boolean}[]} cancelled
 * @property {number | null} closest_kept
 * @property {string | null} reason
 */

/**
 * @typedef {Matrices & {
 *   poles: Complex[], mathml: string,
 *   stability: {verdict: string, because: string, lyapunov_stable: boolean},
 *   controllability: RankAnswer, observability: RankAnswer,
 *   modes: {pole: Complex, stable: boolean, controllable: boolean, observable: boolean, sigma_controllable: number, sigma_observable: number}[],
 *   stabilizable: boolean, detectable: boolean, minimal: boolean,
 *   minimal_realization: Matrices & {order: number, removed: {pole: Complex, hidden_from: "input" | "output", stable: boolean}[], tolerance: number, smallest_kept: number | null, largest_removed: number | null},
 *   gramians: {controllability: number[][] | null, observability: number[][] | null, hankel_singular_values: number[] | null, reason: string | null},
 *   transfer_functions: ChannelAnswer[],
 * }} StateSpaceAnswer
 */

/** @typedef {{classification: string, order: number, reasons: Reasons} & Record<string, any>} Character */

/**
 * @typedef {object} LowOrderModel
 * @property {string} method
 * @property {string} name
 * @property {string} source
 * @property {"FOPDT" | "SOPDT"} type
 * @property {boolean} valid
 * @property {string | null} reason
 * @property {number | null} K
 * @property {number | null} tau
 * @property {number | null} zeta
 * @property {number | null} tau_1
 * @property {number | null} tau_2
 * @property {number | null} theta
 * @property {string | null} mathml
 * @property {string | null} latex
 * @property {number | null} max_deviation_pct
 * @property {Numbers | null} y
 */

/**
 * @typedef {object} ApproximateAnswer
 * @property {string} time_unit
 * @property {Formula & {order: number}} plant
 * @property {Character | null} character
 * @property {string | null} reason
 * @property {Numbers | null} t
 * @property {Numbers | null} y
 * @property {LowOrderModel[]} models
 */

/** @typedef {{id: string, name: string, family: string, types: ControllerType[]}} RuleEntry */
/** @typedef {{Kc: number, tau_I: number | null, tau_D: number | null, alpha: number}} Settings */
/** @typedef {Record<string, any> & {reasons: Reasons}} Figures */
/** @typedef {{t: Numbers, y: Numbers, u: Numbers, truncated_at: number | null, truncated_reason: string | null}} ComparedCurve */
/** @typedef {{K: number, tau: number, theta: number, Ms: number | null, load_IAE: number | null}} SpreadCase  factors of gain, time constants and dead time */

/**
 * @typedef {object} Spread
 * @property {number} spread_pct
 * @property {Numbers} t
 * @property {{low: Numbers, high: Numbers} | null} setpoint
 * @property {{low: Numbers, high: Numbers} | null} load
 * @property {number} cases
 * @property {SpreadCase[]} unstable
 * @property {SpreadCase | null} worst_Ms
 * @property {SpreadCase | null} worst_IAE
 */

/**
 * @typedef {object} ComparedRow
 * @property {string} label
 * @property {string | null} rule
 * @property {ControllerType} type
 * @property {boolean} valid
 * @property {string | null} reason
 * @property {Settings | null} controller
 * @property {boolean | null} closed_loop_stable
 * @property {Figures | null} margins
 * @property {Figures | null} setpoint
 * @property {Figures | null} load
 * @property {{setpoint: ComparedCurve, load: ComparedCurve} | null} responses
 * @property {Spread | null} sensitivity
 */

/** @typedef {{horizon: number, rows: ComparedRow[]}} CompareAnswer */
/** @typedef {{controller: Settings, value: number | null, Ms: number, active: string[]}} Optimum */
/** @typedef {{Ms_limit: number, optimum: Optimum | null, reason: string | null}} TradeOffPoint */

/**
 * @typedef {object} GainMapAnswer
 * @property {number[]} Kc
 * @property {number[]} tau_I
 * @property {(number | null)[][]} Ms  one list per tau_I; null where the loop is not stable
 * @property {(number | null)[][]} value
 * @property {{Kc: (number | null)[], tau_I: (number | null)[]}} boundary
 */

/** @typedef {{id: string, side: "lower" | "upper", omega: number | null, binding: boolean, met: boolean | null, because: string}} LimitAnswer */
/** @typedef {{value: number, omega: number | null}} PeakAnswer */
/** @typedef {{omega: number | null, reason: string | null}} BandwidthAnswer */

/** @typedef {{t_settle: number | null, undershoot_pct: number | null, overshoot_pct: number | null, t_undershoot: number | null, starts_up: boolean | null, effects: {c: number, effect: "undershoot" | "overshoot", bound_pct: number}[]}} StepShape */

/**
 * @typedef {object} LimitsAnswer
 * @property {boolean} closed_loop_stable
 * @property {number | null} omega_c
 * @property {BandwidthAnswer} bandwidth
 * @property {{low: number | null, high: number | null, open: boolean, because: string}} window
 * @property {LimitAnswer[]} limits
 * @property {{initial: number, final: number | null, ratio: number | null, peak: PeakAnswer, plant_bandwidth: BandwidthAnswer, loop_bandwidth: BandwidthAnswer} | null} actuator
 * @property {number | null} noise_passed
 * @property {PeakAnswer | null} load_left
 * @property {{peak: number, omega_peak: number, robustly_stable: boolean, worst_S: number | null} | null} mismatch
 * @property {{Ms: number | null, Mt: number | null, Ms_bound: number, Mt_bound: number}} peaks
 * @property {{root: Complex, kind: "zero" | "pole", S: Complex, T: Complex, peak_bound: number}[] | null} constraints
 * @property {{root: number, kind: "zero" | "pole", signal: "y" | "e", step: "setpoint" | "load", value: number, theorem: number}[] | null} integrals
 * @property {StepShape | null} step
 * @property {StepShape} plant_step
 * @property {{omega: Numbers, S: Numbers, T: Numbers, model_error: Numbers, ideal_S: Numbers | null}} curves
 * @property {Reasons} reasons
 */

/**
 * @typedef {object} BodeIntegralAnswer
 * @property {number | null} value
 * @property {number | null} theorem
 * @property {number | null} difference
 * @property {number | null} error
 * @property {{name: "origin" | "middle" | "tail", omega_from: number, omega_to: number | null, value: number, how: string}[] | null} pieces
 * @property {number | null} area_below
 * @property {number | null} area_above
 * @property {number | null} limit_sL
 * @property {number} theta
 * @property {Complex[]} unstable_poles
 * @property {boolean} closed_loop_stable
 * @property {Numbers} omega
 * @property {Numbers} ln_S
 * @property {Reasons} reasons
 */

/**
 * @typedef {object} SpectrumAnswer
 * @property {string} time_unit
 * @property {number} rate
 * @property {number} samples
 * @property {Numbers} t
 * @property {Numbers} values
 * @property {Numbers} frequency
 * @property {Numbers} omega
 * @property {Numbers} amplitude
 * @property {Numbers} magnitude
 * @property {Numbers} phase_deg
 * @property {number} resolution
 * @property {number} highest
 * @property {{energy: number, spectral_energy: number, residual: number, inverse_error: number}} parseval
 * @property {{amplitude: number, frequency: number, seen_at: number, k: number, aliased: boolean}[] | null} lines
 * @property {number | null} leakage_pct
 * @property {{t: Numbers, signal: Numbers, seen: Numbers} | null} curves
 * @property {Numbers | null} expected  amplitudes of the noise alone
 * @property {Reasons} reasons
 */

export {};
