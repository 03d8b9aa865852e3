/** What each number means, in a sentence or two: the text behind every chip and table row. */

/**
 * @typedef {object} Meaning
 * @property {string} name
 * @property {string} text
 * @property {string} [unit]  "time" stands for the model's time unit
 * @property {number} [decimals]  fixed decimals; otherwise three significant digits
 */

/** Where L is zero there is no curve. */
export const CUT_LOOP = "L = 0: the loop is cut, and zero has neither decibels nor phase. Give plant and controller a gain.";

/** @type {Record<string, Meaning>} */
export const MEANING = {
  verdict: { name: "Stability", text: "The closed loop is stable when all its poles lie left of the imaginary axis. Margins alone do not prove it." },
  GM: { name: "Gain margin", text: "How many times the loop gain may grow before the loop oscillates for ever: 1/|L| where the phase of L is −180°. Usual: at least 2." },
  GM_dB: { name: "Gain margin in dB", text: "The same in decibels: 20 log10 GM.", unit: "dB", decimals: 2 },
  PM_deg: { name: "Phase margin", text: "How much more phase lag the loop stands at the frequency where |L| = 1. Usual: 30° to 60°.", unit: "°", decimals: 1 },
  delay_margin: { name: "Delay margin", text: "How much extra dead time the loop stands: phase margin in radians over the crossover frequency.", unit: "time" },
  Ms: { name: "Sensitivity peak", text: "The largest |S| = |1/(1+L)|; its reciprocal is the shortest distance from the Nyquist curve to −1. Usual: 1.4 to 2." },
  Mt: { name: "Peak of T", text: "The largest |T| = |L/(1+L)|: how much the loop amplifies the setpoint at its worst frequency." },
  omega_c: { name: "Gain crossover", text: "The frequency where |L| = 1.", unit: "rad/time" },
  omega_180: { name: "Phase crossover", text: "The frequency where the phase of L is −180°.", unit: "rad/time" },
  final_value: { name: "Final value", text: "Where y comes to rest." },
  offset: { name: "Offset", text: "What remains between the setpoint and y at the end. Integral action makes it zero." },
  overshoot_pct: { name: "Overshoot", text: "How far y shoots past its final value, in per cent of it.", unit: "%", decimals: 1 },
  t_peak: { name: "Peak time", text: "When y is farthest out.", unit: "time" },
  peak: { name: "Peak", text: "The value of y farthest out." },
  t_rise: { name: "Rise time", text: "From 10 % to 90 % of the final value.", unit: "time" },
  t_settle: { name: "Settling time", text: "After it, y stays within 2 % of its final value.", unit: "time" },
  decay_ratio: { name: "Decay ratio", text: "Second peak over first. Ziegler and Nichols aimed at ¼." },
  IAE: { name: "IAE", text: "Integral of |e|: every error counts as it is." },
  ISE: { name: "ISE", text: "Integral of e²: large errors count most." },
  ITAE: { name: "ITAE", text: "Integral of t·|e|: errors that last count most." },
  K: { name: "Steady-state gain", text: "The final value of y after a unit step of u." },
  tau: { name: "Time constant τ", text: "First order: after it, the step response has covered 63.2 % of its way. Second order: 1/ωn, which sets the speed while ζ sets the shape.", unit: "time" },
  tau_1: { name: "Slow lag τ1", text: "Time constant of the slower of two real poles.", unit: "time" },
  tau_2: { name: "Fast lag τ2", text: "Time constant of the faster of two real poles.", unit: "time" },
  zeta: { name: "Damping ratio ζ", text: "Above 1 two real poles (overdamped), at 1 critically damped, between 0 and 1 a pair that oscillates and decays, at 0 one that never decays." },
  omega_n: { name: "Natural frequency ωn", text: "The frequency of the pair without damping: 1/τ.", unit: "rad/time" },
  omega_d: { name: "Damped frequency ωd", text: "The frequency at which it does oscillate: ωn √(1 − ζ²).", unit: "rad/time" },
  period: { name: "Period", text: "From peak to peak: 2πτ/√(1 − ζ²). It is not τ.", unit: "time" },
  t_63: { name: "63.2 % reached at", text: "When the step response first reaches 1 − 1/e of its final value; dead time counts.", unit: "time" },
  initial_slope: { name: "Initial slope", text: "Slope of the step response when it starts: K/τ for a first-order lag.", unit: "1/time" },
  TV: { name: "Total variation of u", text: "Sum of all moves of the controller output, up and down: wear of the valve." },
};

export const MARGIN_FIELDS = ["GM", "GM_dB", "PM_deg", "delay_margin", "Ms", "Mt", "omega_c", "omega_180"];
export const METRIC_FIELDS = ["final_value", "offset", "overshoot_pct", "t_peak", "peak", "t_rise", "t_settle", "decay_ratio", "IAE", "ISE", "ITAE", "TV"];

/** What a first- or second-order system is told by. */
export const CHARACTER_FIELDS = ["K", "tau", "tau_1", "tau_2", "zeta", "omega_n", "omega_d", "period", "t_63", "t_peak", "overshoot_pct", "decay_ratio", "initial_slope"];

/** How to read each analysis. @type {Record<string, string>} */
export const ANALYSIS_HELP = {
  response: "The exact answer y(t) of the plant, the open loop L or the closed loop T to any input u(t), from rest or from an initial state. A system is BIBO stable if every bounded input gives a bounded output; one bounded input whose answer grows disproves it. A linear system answers a sum of inputs with the sum of its answers: superposition takes steps apart, convolution takes the input apart into impulses.",
  laplace: "Y(s) = G(s) U(s) is split into partial fractions, and each of them is turned back into a function of time. The initial-value theorem reads y(0+) off s Y(s) for s → ∞, the final-value theorem reads y(∞) off s Y(s) for s → 0; the second holds only if y comes to rest, that is if every pole of s Y(s) lies in the left half plane. Circles are a simulation that knows nothing of the formula.",
  routh: "The closed loop is stable if and only if the first column of the Routh array of its characteristic polynomial does not change sign; each change is a root in the right half plane. Where a first entry is zero the row is multiplied by 1 − s², where a whole row is zero the derivative of the auxiliary polynomial above takes its place. The same count, done for every gain, gives the stable ranges of the gain.",
  stability: "Lyapunov stable: the state stays bounded. Asymptotically stable: it also goes to rest. Marginal: bounded, but some of it never dies out; on the imaginary axis the Jordan structure decides, for a repeated eigenvalue with too few eigenvectors grows. BIBO looks at input and output only and does not see modes that cancel. A loop is internally stable only if all of S, PS, CS and T are.",
  state_space: "x′ = A x + B u, y = C x + D u. The eigenvalues of A are the modes. A mode is controllable if u can move it, observable if y shows it; what is not both is hidden from the transfer function. A rank is decided by how many singular values are not zero: look at how far the smallest is from the next.",
  low_order: "First- and second-order models with dead time in place of the plant, over its true step response. The half rule gives half of the largest neglected lag to the lag that is kept and half to the dead time; Taylor turns neglected lags wholly into dead time; least squares fits the response itself.",
  compare: "The present settings, the best settings within the limit of Ms, and those of the rules you add, all on the same plant. Select a row to use its settings. With a model error each loop also meets plants whose gain, time constants and dead time are larger or smaller by so much: the band holds their responses, the second table the worst of them. The rules only ever see the plant on the left; with a true plant the loops are closed around that one instead.",
  gain_map: "Every point is a PI controller: gain across, integral time upwards, both logarithmic. The thick line is the exact limit of stability. Along one dashed line Ms is constant, along one thin line the IAE. The line with dots joins the best settings for each limit of Ms: going along it, robustness is paid for with error. Drag the square, or move it with the arrow keys, Shift for large steps, and the other plots follow.",
  limits: "Each row is a limit on the crossover frequency ωc: thick where it may lie, dotted where it may not. An unstable pole and a load ask for speed; a zero in the right half plane, dead time, actuator, model error and noise forbid it. What all of them leave is the top row; the vertical line is ωc now. Below, |S| and |T| of this loop: |T| must stay below the line 1/|GΔ| to be safe from the model error. Fill in the fields to add the limits that only you can know.",
  bode_integral: "ln |S| over an even frequency axis. Where it is below zero feedback helps, where it is above feedback hurts. Bode's theorem fixes the sum of both areas, whatever the controller: pushing the curve down somewhere lifts it elsewhere, like a waterbed. Neither end is cut off: near 0 and beyond the last corner the integral is done by formula.",
  spectrum: "The discrete Fourier transform tells which sines a sampled signal is made of. N samples at rate fs tell apart frequencies fs/N, up to half the sampling rate. A sine faster than that gives the same samples as a slower one, its alias at |f − k fs|. A sine that does not fit a whole number of times into the record leaks into its neighbours; the Hann window keeps that near, for a wider peak.",
};

/** How to read each plot. @type {Record<string, string>} */
export const PLOT_HELP = {
  step: "Above, what the process does (y); below, what the controller asks for (u). With a sensor, yₘ is what the controller sees of y. A setpoint step asks y to go to 1; a load step pushes on the plant's input and asks the controller to push back.",
  bode: "The open loop L = P·C (with actuator and sensor L = C·A·P·H) against frequency. Where |L| crosses 0 dB, the distance of the phase from −180° is the phase margin; where the phase crosses −180°, the distance of |L| from 0 dB is the gain margin. “Asymptotes” lays the straight lines over it that one draws by hand: each pole bends them down, each zero up, at its own frequency.",
  nyquist: "L(iω) drawn in the complex plane, with its mirror image for negative frequencies. The closed loop has Z = N + P poles in the right half plane: N clockwise turns of the curve about −1, P poles of L in the right half plane. The dotted rim stands for what lies outside the picture; where L has poles on the imaginary axis, the contour passes them on the right and L runs along an arc at infinity, drawn on the rim.",
  nichols: "The open loop L: phase across, magnitude upwards, frequency along the curve. Changing the gain moves it up or down as it is. The grid is the closed loop: along one line |T| is constant, along the other arg T. The thick contour is |T| = Mt, which the curve just touches. Distances from (−180°, 0 dB) are the margins.",
  root_locus: "The paths of the closed-loop poles as the controller gain goes from 0 to ∞: from the open-loop poles (×) to the zeros (○). Squares are the poles at the gain set now. Left of the vertical axis is stable. “K < 0” adds the paths for gains of the other sign. Drag a rectangle to look closer; the server then follows the branches at that scale.",
  sensitivity: "The gang of six: how the loop passes on setpoint, load, noise and disturbance. Below 0 dB, S says that feedback helps; its peak is Ms. With a setpoint weight β the setpoint goes to u by CFS = (C + F)S and to y by TF = P(C + F)S, with F = Kc(β − 1); with β = 1 they are CS and T.",
  numbers: "The figures behind the plots. A dash means that the figure does not exist for this loop; hover or focus it for the reason.",
};
