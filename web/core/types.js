/**
 * Shapes shared by the whole browser side; the names are those of the API.
 * This file holds types only and runs nothing.
 */

/** @typedef {{type: "expr", text: string}} ExprSystem */
/** @typedef {{type: "fopdt", K: number, tau: number, theta: number}} FopdtSystem */
/** @typedef {{type: "sopdt", K: number, tau: number, zeta: number, theta: number}} SopdtSystem */
/** @typedef {{type: "ss", A: number[][], B: number[][], C: number[][], D: number[][], theta: number}} SsSystem */
/** @typedef {ExprSystem | FopdtSystem | SopdtSystem | SsSystem} System */

/** @typedef {"P" | "PI" | "PD" | "PID"} ControllerType */
/** @typedef {"ideal" | "series" | "parallel"} ControllerForm */

/**
 * What the student sets. `tau_I` and `tau_D` keep their values while the type leaves them out,
 * so that switching PI -> P -> PI gives the old loop back.
 * @typedef {object} ControllerState
 * @property {ControllerType} type
 * @property {ControllerForm} form
 * @property {number} Kc
 * @property {number} tau_I
 * @property {number} tau_D
 * @property {number} alpha
 * @property {number} beta  setpoint weight: the proportional part acts on beta r - y
 * @property {"reverse" | "direct"} action
 */

/**
 * The design: everything undo brings back.
 * @typedef {object} Design
 * @property {System} plant
 * @property {ControllerState} controller
 * @property {string} actuator  A(s) as text between controller and plant; empty for none
 * @property {string} sensor  H(s) as text between plant and controller; empty for none
 * @property {number | null} horizon  time axis of the step responses; null lets the server choose
 */

/** @typedef {{type: string} & Record<string, any>} InputShape  an input signal as the API has it */

/**
 * @typedef {object} ResponseView
 * @property {"plant" | "open_loop" | "closed_loop"} of
 * @property {InputShape} input
 * @property {{y?: number[], x?: number[]} | null} initial  null is at rest
 * @property {"superposition" | "convolution" | null} sum
 * @property {number} slices  of the input, in the convolution sum
 */

/** @typedef {{a: number[], b: number[], initial: number[]}} LinearOde */

/** @typedef {{rule: string, type: ControllerType}} RuleChoice */

/**
 * What is compared with the present settings, and on what.
 * @typedef {object} CompareView
 * @property {RuleChoice[]} rules
 * @property {number | null} spread_pct  how wrong the model may be, either way
 * @property {string} true_plant  what the loops are closed around; empty for the plant itself
 */

/**
 * What some tuning rules leave to the user.
 * @typedef {object} RuleOptions
 * @property {number | null} tau_c  closed-loop time constant of IMC, lambda tuning and SIMC; null is each rule's own
 * @property {number} PM_deg  phase margin that the relay rule aims at
 */

/**
 * What the analyses are asked beside the loop.
 * @typedef {object} AnalysesView
 * @property {ResponseView} response
 * @property {{input: InputShape | null, ode: LinearOde | null}} laplace  without ode it is the plant
 * @property {number[] | null} polynomial  of the Routh array; null takes the loop's
 * @property {"FOPDT" | "SOPDT"} model_type  which low-order models are drawn
 * @property {number} cancel_tolerance  up to this distance a zero cancels a pole
 * @property {CompareView} compare
 * @property {number} Ms_limit  what the optimal settings may reach
 * @property {RuleOptions} tune
 * @property {LimitsView} limits
 * @property {SpectrumView} spectrum
 */

/**
 * What is known of the loop's surroundings; null sets no limit.
 * @typedef {object} LimitsView
 * @property {number | null} u_limit  largest |u| for a unit of r
 * @property {number | null} noise_omega  from where on the sensor is noisy
 * @property {number | null} load_error  largest error that a unit of load may leave
 * @property {number} spread_pct  how far gain, time constants and dead time may be off
 */

/** @typedef {{of: "sine" | "y" | "u" | "e", frequency: number, rate: number, loop_rate: number, samples: number, loop_samples: number, noise: number, setpoint: 0 | 1, window: "rectangular" | "hann"}} SpectrumView */

/**
 * How the student looks at it: travels in the URL, but is no step of undo.
 * @typedef {object} View
 * @property {"setpoint" | "load"} signal
 * @property {string[]} show  plots on the stage, in order
 * @property {AnalysesView} analyses
 */

/** @typedef {Design & {view: View}} State */

/** @typedef {Float32Array | Float64Array | number[]} Numbers */
/** @typedef {[number, number]} Complex */

/**
 * @typedef {object} StepSignal
 * @property {Numbers} y
 * @property {Numbers} u
 * @property {Numbers | null} y_m  what the sensor makes of y; null without a sensor
 * @property {number | null} final_y
 * @property {number | null} truncated_at
 * @property {string | null} truncated_reason
 */

/** @typedef {{key: string, horizon: number, t: Numbers, setpoint: StepSignal, load: StepSignal}} StepPanel */
/** @typedef {{mag_dB: Numbers, phase_deg: Numbers}} Response */
/** A system that is zero has no curve. @typedef {{key: string, omega: Numbers, L: Response | null, P: Response | null, C: Response | null}} BodePanel */

/**
 * A corner of the straight-line Bode diagram; slopes in units of 20 dB/decade.
 * @typedef {object} Corner
 * @property {number} omega
 * @property {"pole" | "zero"} kind
 * @property {Complex} s
 * @property {number} multiplicity
 * @property {number | null} zeta
 * @property {number} slope_change
 * @property {number} phase_change_deg
 * @property {number} phase_from
 * @property {number} phase_to
 */

/**
 * @typedef {object} AsymptotesPanel
 * @property {string} key
 * @property {number[]} omega
 * @property {number[]} mag_dB
 * @property {number[]} phase_omega
 * @property {number[]} phase_deg
 * @property {Corner[]} corners
 * @property {number} initial_slope
 * @property {number} initial_phase_deg
 */

/**
 * A pole on the imaginary axis, passed on its right, and the arc at infinity that L makes meanwhile.
 * @typedef {object} IndentationArc
 * @property {number} omega
 * @property {number} multiplicity
 * @property {number} start_deg
 * @property {number} end_deg
 * @property {number} turn_deg
 */

/**
 * @typedef {object} BodeCriterion
 * @property {boolean | null} stable
 * @property {boolean} applies
 * @property {string[]} unmet
 * @property {number | null} omega_180
 * @property {number | null} magnitude
 * @property {boolean | null} nyquist_stable
 * @property {boolean | null} agrees
 * @property {string} explanation
 */

/**
 * @typedef {object} NyquistPanel
 * @property {string} key
 * @property {Numbers} omega
 * @property {Numbers} re
 * @property {Numbers} im
 * @property {number | null} N
 * @property {number | null} P
 * @property {number | null} Z
 * @property {boolean} closed_loop_stable
 * @property {string} explanation
 * @property {IndentationArc[]} arcs
 * @property {BodeCriterion} bode_criterion
 */

/** @typedef {{first: number, re: Numbers, im: Numbers, gains?: Numbers | null}} LocusBranch  gains of its own where a window was asked for */

/**
 * @typedef {object} RootLocusPanel
 * @property {string} key
 * @property {boolean} available
 * @property {string | null} reason
 * @property {Numbers | null} gains
 * @property {LocusBranch[]} branches
 * @property {Complex[]} open_loop_poles
 * @property {Complex[]} open_loop_zeros
 * @property {{centroid: number | null, angles_deg: number[], horizontal?: number[]} | null} [asymptotes]  horizontal ones, at these Im s, come with dead time
 * @property {{s: Complex, K: number}[]} breakaways
 * @property {{omega: number, K: number}[]} imaginary_axis_crossings
 * @property {{s: Complex, angle_deg: number}[]} departure_angles
 * @property {{s: Complex, angle_deg: number}[]} arrival_angles
 * @property {{re: Range, im: Range}} view
 */

/** @typedef {{key: string, K: number | null, poles: Complex[], complete: boolean, reason: string | null}} PolesPanel */

/**
 * @typedef {object} MarginsPanel
 * @property {string} key
 * @property {boolean} closed_loop_stable
 * @property {number | null} GM
 * @property {number | null} GM_dB
 * @property {number | null} omega_180
 * @property {number | null} PM_deg
 * @property {number | null} omega_c
 * @property {number | null} delay_margin
 * @property {number | null} Ms
 * @property {number | null} omega_Ms
 * @property {number | null} Mt
 * @property {number | null} omega_Mt
 * @property {{omega: number, PM_deg: number}[]} gain_crossovers
 * @property {{omega: number, GM: number}[]} phase_crossovers
 * @property {Record<string, string>} reasons
 */

/** @typedef {{[field: string]: number | null}} MetricValues */
/** @typedef {{reasons: Record<string, string>}} MetricReasons */
/** @typedef {{key: string, setpoint: Metrics, load: Metrics}} MetricsPanel */

/**
 * @typedef {object} Metrics
 * @property {number | null} final_value
 * @property {number | null} offset
 * @property {number | null} overshoot_pct
 * @property {number | null} t_peak
 * @property {number | null} peak
 * @property {number | null} t_rise
 * @property {number | null} t_settle
 * @property {number | null} decay_ratio
 * @property {number | null} IAE
 * @property {number | null} ISE
 * @property {number | null} ITAE
 * @property {number | null} TV
 * @property {Record<string, string>} reasons
 */

/**
 * @typedef {object} VerdictPanel
 * @property {string} key
 * @property {"stable" | "marginal" | "unstable"} verdict
 * @property {boolean} closed_loop_stable
 * @property {string} because
 * @property {number} rhp_poles
 */

/** What is zero has no curve. @typedef {{key: string, omega: Numbers, S_dB: Numbers | null, PS_dB: Numbers | null, CS_dB: Numbers | null, T_dB: Numbers | null, CFS_dB: Numbers | null, TF_dB: Numbers | null, feedforward: number}} SensitivityPanel */
/** @typedef {{key: string, t: Numbers, S: Numbers, PS: Numbers, CS: Numbers, T: Numbers, CFS: Numbers, TF: Numbers, truncated_reason: string | null, feedforward: number}} GangStepsPanel */

/**
 * @typedef {object} Panels
 * @property {VerdictPanel} [verdict]
 * @property {StepPanel} [step]
 * @property {BodePanel} [bode]
 * @property {NyquistPanel} [nyquist]
 * @property {RootLocusPanel} [root_locus]
 * @property {PolesPanel} [poles]
 * @property {MarginsPanel} [margins]
 * @property {MetricsPanel} [metrics]
 * @property {SensitivityPanel} [sensitivity]
 * @property {AsymptotesPanel} [asymptotes]
 * @property {GangStepsPanel} [gang_steps]
 * @property {RootLocusPanel} [root_locus_negative]
 */

/** @typedef {keyof Panels} PanelName */

/** @typedef {{text: string, latex: string, mathml: string, order?: number, theta?: number}} SystemText */

/**
 * @typedef {object} LoopAnswer
 * @property {string} time_unit
 * @property {SystemText} plant
 * @property {SystemText} controller
 * @property {SystemText | null} actuator
 * @property {SystemText | null} sensor
 * @property {PanelName[]} unchanged
 * @property {Panels} panels
 */

/** @typedef {{kind: string, values: Record<string, number>, how: string}} TuneBasis */

/**
 * @typedef {object} TuneSetting
 * @property {string} rule
 * @property {string} name
 * @property {string} family
 * @property {ControllerType} type
 * @property {number | null} Kc
 * @property {number | null} tau_I
 * @property {number | null} tau_D
 * @property {number | null} alpha
 * @property {boolean} valid
 * @property {string | null} reason
 * @property {{latex: string, mathml: string} | null} formula
 * @property {string} source
 * @property {string} validity
 * @property {string | null} note
 * @property {{form: string, Kc: number, tau_I: number | null, tau_D: number | null} | null} published
 * @property {TuneBasis | null} basis
 */

/**
 * @typedef {object} TuneAnswer
 * @property {TuneSetting[]} settings
 * @property {{Ku: number | null, Pu: number | null, omega_180: number | null, reason: string | null} | null} ultimate
 * @property {{K: number, tau: number, theta: number, how: string} | null} model
 */

/** @typedef {{id: string, title: string, level: string, section: string, summary: string, minutes: number, exercises: number}} LabSummary */

/**
 * Colours and type a plot is drawn with, read from the style tokens by the page.
 * @typedef {object} Theme
 * @property {string} ink
 * @property {string} muted
 * @property {string} grid
 * @property {string} axis
 * @property {string} paper
 * @property {string} good
 * @property {string} bad
 * @property {string} font
 * @property {number} fontSize
 * @property {Record<string, string>} signal
 */

/**
 * One Plotly trace; only the fields that plots/ uses.
 * @typedef {object} Trace
 * @property {string} type
 * @property {"lines" | "markers" | "lines+markers"} mode
 * @property {string} name
 * @property {Numbers | (number | null)[]} x
 * @property {Numbers | (number | null)[]} y
 * @property {string} [xaxis]
 * @property {string} [yaxis]
 * @property {object} [line]
 * @property {object} [marker]
 * @property {string} [hovertemplate]
 * @property {"skip" | "all"} [hoverinfo]
 * @property {boolean} [showlegend]
 * @property {(string | null)[]} [text]  one a point, for the hover
 * @property {Numbers | (number | null)[]} [customdata]
 * @property {number} [opacity]
 * @property {string} [fill]
 * @property {string} [fillcolor]
 * @property {boolean} [cliponaxis]
 */

/** @typedef {[number, number]} Range */
/** @typedef {Record<string, Range>} Ranges  axis ranges by axis name; log axes in powers of ten, as Plotly has them */
/** @typedef {{traces: Trace[], layout: Record<string, any>, ranges: Ranges}} Figure */

/** @typedef {{header: string[], rows: (string | number | null)[][], lead?: number}} Table  the first `lead` rows are never thinned out */

export {};
