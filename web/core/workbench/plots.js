/** What a bench can show, in the order it is offered: plots of the loop, and analyses with words and tables beside a plot. */

/** @typedef {{id: string, label: string}} ViewItem */

export const PLOTS = [
  { id: "step", label: "Step" },
  { id: "bode", label: "Bode" },
  { id: "nyquist", label: "Nyquist" },
  { id: "nichols", label: "Nichols" },
  { id: "root_locus", label: "Root locus" },
  { id: "sensitivity", label: "Sensitivity" },
  { id: "numbers", label: "Numbers" },
];

export const ANALYSES = [
  { id: "response", label: "Response" },
  { id: "laplace", label: "Laplace" },
  { id: "routh", label: "Routh" },
  { id: "stability", label: "Stability" },
  { id: "state_space", label: "State space" },
  { id: "low_order", label: "Low order" },
  { id: "compare", label: "Compare" },
  { id: "gain_map", label: "Gain map" },
  { id: "limits", label: "Limits" },
  { id: "bode_integral", label: "Bode integral" },
  { id: "spectrum", label: "Spectrum" },
];

export const VIEW_IDS = [...PLOTS, ...ANALYSES].map(({ id }) => id);
export const SHOWN_WIDE = ["step", "bode", "nyquist", "root_locus", "numbers"];
export const SHOWN_NARROW = ["step"];

/** Tables and analyses are as tall as they need to be and take a row of their own. @param {string} id */
export function takesRow(id) {
  return id === "numbers" || ANALYSES.some((analysis) => analysis.id === id);
}
