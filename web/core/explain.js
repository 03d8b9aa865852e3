/** What each number means, in a sentence or two: the text behind every chip and table row. */

/**
 * @typedef {object} Meaning
 * @property {string} name
 * @property {string} text
 * @property {string} [unit]  "time" stands for the model's time unit
 * @property {number} [decimals]  fixed decimals; otherwise three significant digits
 */

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
  TV: { name: "Total variation of u", text: "Sum of all moves of the controller output, up and down: wear of the valve." },
};

export const MARGIN_FIELDS = ["GM", "GM_dB", "PM_deg", "delay_margin", "Ms", "Mt", "omega_c", "omega_180"];
export const METRIC_FIELDS = ["final_value", "offset", "overshoot_pct", "t_peak", "peak", "t_rise", "t_settle", "decay_ratio", "IAE", "ISE", "ITAE", "TV"];

/** How to read each plot. @type {Record<string, string>} */
export const PLOT_HELP = {
  step: "Above, what the process does (y); below, what the controller asks for (u). With a sensor, yₘ is what the controller sees of y. A setpoint step asks y to go to 1; a load step pushes on the plant's input and asks the controller to push back.",
  bode: "The open loop L = P·C (with actuator and sensor L = C·A·P·H) against frequency. Where |L| crosses 0 dB, the distance of the phase from −180° is the phase margin; where the phase crosses −180°, the distance of |L| from 0 dB is the gain margin.",
  nyquist: "L(iω) drawn in the complex plane, with its mirror image for negative frequencies. The closed loop has Z = N + P poles in the right half plane: N clockwise turns of the curve about −1, P poles of L in the right half plane.",
  root_locus: "The paths of the closed-loop poles as the controller gain goes from 0 to ∞: from the open-loop poles (×) to the zeros (○). Squares are the poles at the gain set now. Left of the vertical axis is stable.",
  sensitivity: "The gang of four: how the loop passes on setpoint, load, noise and disturbance. Below 0 dB, S says that feedback helps; its peak is Ms.",
  numbers: "The figures behind the plots. A dash means that the figure does not exist for this loop; hover or focus it for the reason.",
};
