/** Shapes of a lab as the server renders it; types only. */

/** @typedef {Record<string, number | null>} Settings  values of the bench's knobs; null is "off" */

/**
 * @typedef {object} LabSlider
 * @property {"Kc" | "tau_I" | "tau_D" | "alpha"} knob
 * @property {string} label
 * @property {string} symbol_mathml
 * @property {string} unit
 * @property {number} min
 * @property {number} max
 * @property {number} step
 * @property {"linear" | "log"} scale
 * @property {boolean} can_be_off
 * @property {number | null} value
 */

/**
 * @typedef {object} LabBench
 * @property {string} time_unit
 * @property {import("../types.js").System} plant
 * @property {string} plant_text
 * @property {string} plant_mathml
 * @property {string | null} actuator  as it is typed
 * @property {string | null} actuator_mathml
 * @property {string | null} sensor
 * @property {string | null} sensor_mathml
 * @property {{type: string, form: "ideal" | "series", Kc: number, tau_I: number | null, tau_D: number | null, alpha: number, action: "reverse" | "direct"}} controller
 * @property {number | null} horizon
 * @property {Partial<import("../types.js").ResponseView> | null} response  how the analysis opens
 * @property {import("../types.js").InputShape | null} laplace
 * @property {string[]} panels
 * @property {LabSlider[]} sliders
 */

/** @typedef {{id: string, label: string, symbol_mathml: string | null, unit: string, tolerance_text: string}} LabField */
/** @typedef {{id: string, html: string}} LabOption */
/** @typedef {{name: string, relation: "<=" | ">=", limit: number, text: string}} LabSpecification */

/**
 * @typedef {object} LabExercise
 * @property {"number" | "choice" | "transfer_function" | "design"} type
 * @property {string} id
 * @property {number} number
 * @property {string} title
 * @property {number} points
 * @property {string} prompt_html
 * @property {string[]} hints_html
 * @property {LabField[]} [fields]
 * @property {boolean} [several]
 * @property {LabOption[]} [options]
 * @property {string | null} [symbol_mathml]
 * @property {string} [tolerance_text]
 * @property {LabSpecification[]} [specifications]
 */

/** @typedef {{type: "text", html: string}} LabText */
/** @typedef {{id: string, title: string, settings: Settings | null, blocks: (LabText | LabExercise)[]}} LabPart */

/**
 * @typedef {object} Lab
 * @property {string} id
 * @property {string} title
 * @property {string} level
 * @property {string} section
 * @property {string} summary
 * @property {number} minutes
 * @property {number} exercises
 * @property {string[]} objectives_html
 * @property {LabBench} bench
 * @property {LabPart[]} parts
 */

/** @typedef {"correct" | "partly" | "wrong" | "blank" | "unreadable" | "revealed"} Status */
/** @typedef {{name: string, passed: boolean, measured: number | null, limit: number | null, text: string, feedback_html: string}} Check */
/** @typedef {{correct: boolean, status: Status, score: number, feedback_html: string, checks: Check[], solution_html: string | null}} Verdict */

export {};
