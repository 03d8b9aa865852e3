/** The plots a bench can show, in the order they are offered. */

export const PLOTS = [
  { id: "step", label: "Step" },
  { id: "bode", label: "Bode" },
  { id: "nyquist", label: "Nyquist" },
  { id: "nichols", label: "Nichols" },
  { id: "root_locus", label: "Root locus" },
  { id: "sensitivity", label: "Sensitivity" },
  { id: "numbers", label: "Numbers" },
];

export const PLOT_IDS = PLOTS.map(({ id }) => id);
export const SHOWN_WIDE = ["step", "bode", "nyquist", "root_locus", "numbers"];
export const SHOWN_NARROW = ["step"];
