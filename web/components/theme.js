/** The page's theme: the student's choice, and the colours that plots are drawn with. */

/** @import {Theme} from "../core/types.js" */

/** @typedef {"auto" | "light" | "dark"} ThemeChoice */

const STORAGE_KEY = "looplab-theme";
const SIGNALS = [
  "r", "y", "y_m", "u", "d", "n", "e", "L", "P", "C", "S", "PS", "CS", "T", "CFS", "TF", "margin", "pole", "locus",
  "locus-negative", "sketch", "infinity", "term", "sum", "simulated", "half_rule", "taylor", "two_point",
  "least_squares", "contour", "rule", "now", "optimal", "case_1", "case_2", "case_3", "case_4", "case_5", "case_6",
  "ideal_S", "model_error", "samples", "signal", "seen", "spectrum", "half_rate", "expected",
  "model", "construction",
];
const systemDark = matchMedia("(prefers-color-scheme: dark)");

/** @returns {ThemeChoice} */
export function themeChoice() {
  try {
    const stored = localStorage.getItem(STORAGE_KEY);
    return stored === "light" || stored === "dark" ? stored : "auto";
  } catch {
    return "auto";
  }
}

function apply() {
  const choice = themeChoice();
  const dark = choice === "dark" || (choice === "auto" && systemDark.matches);
  const theme = dark ? "dark" : "light";
  if (document.documentElement.dataset["theme"] === theme) return;
  document.documentElement.dataset["theme"] = theme;
  document.dispatchEvent(new CustomEvent("theme-changed"));
}

systemDark.addEventListener("change", apply);

/** @param {ThemeChoice} choice */
export function chooseTheme(choice) {
  try {
    if (choice === "auto") localStorage.removeItem(STORAGE_KEY);
    else localStorage.setItem(STORAGE_KEY, choice);
  } catch {
    // Without storage the choice holds for this page only.
    document.documentElement.dataset["theme"] = choice === "dark" ? "dark" : "light";
  }
  apply();
}

/** @param {() => void} listener @returns {() => void} */
export function onThemeChange(listener) {
  document.addEventListener("theme-changed", listener);
  return () => document.removeEventListener("theme-changed", listener);
}

/** The style tokens as plots need them. @returns {Theme} */
export function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const token = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
  return {
    ink: token("ink"),
    muted: token("ink-muted"),
    grid: token("plot-grid"),
    axis: token("plot-axis"),
    paper: token("paper"),
    good: token("good"),
    bad: token("bad"),
    font: token("font-sans"),
    fontSize: Number.parseFloat(token("plot-font-size")) || 12,
    signal: Object.fromEntries(SIGNALS.map((name) => [name, token(`signal-${name}`)])),
  };
}
