/** Which limits bind for this plant, what bandwidth they leave, and what the loop makes of it. */

/** @import {LimitsAnswer, StepShape} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {LimitsView, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatFixed, formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { LIMIT_NAMES, limitsRequest, MODEL_ERROR } from "../../core/workbench/limits.js";
import { formatShort } from "../../core/roots.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { captioned, headRow, part, valueTable, yesNo } from "../../components/facts.js";
import "../../components/number-field.js";
import { createFigure } from "../../plots/figure.js";
import { limitsPlot } from "../../plots/limits.js";

/** A bound below this, in per cent, asks for nothing that could be seen. */
const NOTHING = 0.01;

/** @param {[number, number]} value */
const complexText = ([re, im]) => (im === 0 ? formatShort(re) : `${formatShort(re)} ± ${formatShort(Math.abs(im))}j`);
/** What is zero but for rounding. @param {number} value */
const tidied = (value) => formatShort(Math.abs(value) < 1e-9 ? 0 : value, 5);
/** @param {string} text */
const finding = (text) => h("p", { class: "finding" }, text);

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  const rate = `rad/${unit}`;
  const view = () => store.get().view.analyses.limits;
  /** @param {Partial<LimitsView>} patch */
  const change = (patch) => store.setAnalyses({ limits: { ...view(), ...patch } });

  /** @param {keyof LimitsView} name @param {Record<string, string | number | boolean | undefined>} attributes */
  function numberField(name, attributes) {
    const field = h("number-field", attributes);
    field.addEventListener("value-change", (event) => change({ [name]: /** @type {CustomEvent<{value: number | null}>} */ (event).detail.value }));
    return field;
  }
  const fields = {
    u_limit: numberField("u_limit", { label: "Largest u for r = 1", above: 0, optional: true, placeholder: "10 × final" }),
    noise_omega: numberField("noise_omega", { label: "Noise from ω", unit: rate, above: 0, optional: true, placeholder: "none" }),
    load_error: numberField("load_error", { label: "Error allowed for d = 1", above: 0, optional: true, placeholder: "any" }),
    spread_pct: numberField("spread_pct", { label: "Model off by ±", unit: "%", ...MODEL_ERROR }),
  };
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<LimitsAnswer>} */
  let analysis;

  function render() {
    const answer = /** @type {LimitsAnswer} */ (analysis.answer);
    words.replaceChildren(verdict(answer, rate), ...[listed(answer, rate), costs(answer, unit), alone(answer, unit), corners(answer)].filter((node) => node !== null));
  }

  function showForm() {
    for (const [name, field] of Object.entries(fields)) field.value = view()[/** @type {keyof LimitsView} */ (name)];
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "limits",
      title: "Limits",
      help: ANALYSIS_HELP["limits"] ?? "",
      form: [h("div", { class: "form-fields" }, ...Object.values(fields))],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify([store.get().plant, view()]),
      render,
      draw: (theme, held) => (analysis?.answer ? limitsPlot({ answer: analysis.answer, timeUnit: unit }, theme, held) : null),
      legend: () => [
        { signal: "stable", label: "may", name: "where ωc may lie", glyph: "▬" },
        { signal: "unstable", label: "may not", name: "where ωc may not lie", glyph: "┄" },
        { signal: "sum", label: "ωc now", name: "gain crossover of this loop", glyph: "┆" },
        { signal: "S", label: "S", name: "sensitivity", dash: "solid" },
        { signal: "T", label: "T", name: "complementary sensitivity", dash: "longdash" },
        { signal: "model_error", label: "1/|GΔ|", name: "where T must stay below", dash: "dashdot" },
        ...(analysis?.answer?.curves.ideal_S ? [{ signal: "ideal_S", label: "best S", name: "best possible with this dead time", dash: "dot" }] : []),
      ],
      table: () => (analysis?.answer ? tableOf(analysis.answer, rate) : null),
      describe: () => `Limits of the crossover frequency. ${sentence(analysis?.answer?.window.because)}`,
    },
    (onChange) => [(analysis = createAnalysis(store, { request: limitsRequest, send: (request) => api.analyse("limits", request) }, onChange))],
  );
  const stop = store.subscribe((_, { view: changed }) => {
    if (changed) showForm();
  });
  showForm();
  return () => {
    stop();
    panel.dispose();
  };
}

/** @param {LimitsAnswer} answer @param {string} rate */
function verdict({ window, omega_c, limits }, rate) {
  const now = omega_c === null ? "This loop has no crossover." : `Now it is ${formatNumber(omega_c)} ${rate}.`;
  const broken = limits.filter(({ met }) => met === false).map(({ id }) => LIMIT_NAMES[id]?.replace(/^[A-Z](?=[a-z])/, (letter) => letter.toLowerCase()));
  const judged = broken.length > 0 ? ` That is past the limit of: ${broken.join(", ")}.` : omega_c !== null && limits.some(({ met }) => met) ? " All limits are kept." : "";
  return h("p", { class: "finding" }, h("strong", {}, sentence(window.because)), ` ${now}${judged}`);
}

/** @param {LimitsAnswer} answer @param {string} rate */
function listed({ limits }, rate) {
  const order = Object.keys(LIMIT_NAMES);
  const rows = limits.toSorted((a, b) => Number(a.omega === null) - Number(b.omega === null) || order.indexOf(a.id) - order.indexOf(b.id)).map(({ id, side, omega, binding, met, because }) =>
    h(
      "tr",
      { class: binding ? "binding" : omega === null ? "absent" : null },
      h("th", { scope: "row" }, LIMIT_NAMES[id] ?? id, binding ? h("span", { class: "binds" }, "binds") : ""),
      h("td", {}, omega === null ? "" : `${side === "lower" ? ">" : "<"} ${formatNumber(omega)}`, omega === null || met === null ? "" : yesNo(met, { yes: "kept", no: "broken" })),
      h("td", { class: "because" }, sentence(because)),
    ),
  );
  return captioned("Limits of the crossover frequency", h("table", { class: "values limits" }, headRow(["Limit", `ωc [${rate}]`, "Why"]), h("tbody", {}, ...rows)));
}

/** One plain sentence for each thing that bandwidth costs. @param {LimitsAnswer} answer @param {string} unit */
function costs({ closed_loop_stable, actuator, noise_passed, load_left, mismatch, peaks, step }, unit) {
  if (!closed_loop_stable) return part("What this loop makes of it", finding("The loop is not stable: lower the gain, or for an unstable plant raise it, to read what it costs."));
  const at = (/** @type {number | null} */ omega) => (omega === null ? "at ever higher frequencies" : `at ω = ${formatNumber(omega)} rad/${unit}`);
  /** @type {string[]} */
  const said = [];
  if (actuator) {
    const { initial, final, ratio, peak, plant_bandwidth, loop_bandwidth } = actuator;
    const wide = plant_bandwidth.omega !== null && loop_bandwidth.omega !== null ? ` The loop is ${formatNumber(loop_bandwidth.omega / plant_bandwidth.omega)} times as fast as the plant (bandwidths ${formatNumber(loop_bandwidth.omega)} and ${formatNumber(plant_bandwidth.omega)} rad/${unit}).` : "";
    said.push(`Actuator: a step of r takes u = ${formatNumber(initial)} at once${final === null ? "" : ` and ${formatNumber(final)} in the end`}${ratio === null ? "" : `, ${formatNumber(ratio)} times as much`}; |T/P| is at most ${formatNumber(peak.value)}, ${at(peak.omega)}.${wide}`);
  }
  if (load_left) said.push(`Load: a sine of size 1 in d moves y by at most ${formatNumber(load_left.value)}, ${at(load_left.omega)}.`);
  if (noise_passed !== null) said.push(`Noise: up to ${formatFixed(100 * noise_passed, 1)} % of it reaches y.`);
  if (mismatch) {
    const { peak, robustly_stable, worst_S } = mismatch;
    said.push(
      robustly_stable
        ? `Model error: safe, |T GΔ| is at most ${formatNumber(peak)} < 1; the error of the loop may become ${formatNumber(worst_S)} times what the model says.`
        : `Model error: not safe, |T GΔ| reaches ${formatNumber(peak)} ≥ 1; some plant within the spread may be unstable. Retune for a lower peak of T.`,
    );
  }
  if (peaks.Ms_bound > 1 + 1e-9) said.push(`Peaks: no controller gets Ms below ${formatNumber(peaks.Ms_bound)}; here it is ${formatNumber(peaks.Ms)}.`);
  if (peaks.Mt_bound > 1 + 1e-9) said.push(`Peaks: no controller gets Mt below ${formatNumber(peaks.Mt_bound)}; here it is ${formatNumber(peaks.Mt)}.`);
  if (step) said.push(...zerosText(step, unit));
  return part("What this loop makes of it", h("ul", { class: "said" }, ...said.map((text) => h("li", {}, text))));
}

/** What each real zero of a step response costs. @param {StepShape} step @param {string} unit */
function zerosText({ t_settle, undershoot_pct, overshoot_pct, effects }, unit) {
  return effects.map(({ c, effect, bound_pct }) => {
    const found = effect === "undershoot" ? undershoot_pct : overshoot_pct;
    const settling = `Zero at ${formatShort(c)}: settling in ${formatWithUnit(t_settle, unit)}`;
    return bound_pct < NOTHING ? `${settling} is so slow that it need cost no ${effect}; here it is ${formatFixed(found, 1)} %.` : `${settling} costs at least ${formatNumber(bound_pct)} % ${effect}; here it is ${formatNumber(found)} %.`;
  });
}

/** The plant without feedback, where a zero on the right sends it the wrong way. @param {LimitsAnswer} answer @param {string} unit */
function alone({ plant_step }, unit) {
  const { undershoot_pct, t_undershoot, t_settle, starts_up } = plant_step;
  if (!undershoot_pct || t_undershoot === null) return null;
  const start = starts_up ? "It first moves the right way, then turns: an even number of zeros on the right." : "It first moves the wrong way.";
  const end = t_settle === null ? "" : ` It settles in ${formatWithUnit(t_settle, unit)}.`;
  return part("The plant alone", finding(`After a step of u it goes ${formatNumber(undershoot_pct)} % below where it was, at t = ${formatWithUnit(t_undershoot, unit)}. ${start}${end} No controller takes that away; a fast one makes it deeper.`));
}

/** Roots on the right: what they fix, and that it is so. @param {LimitsAnswer} answer */
function corners({ constraints, integrals, reasons }) {
  if (!constraints || constraints.length === 0) return null;
  const roots = valueTable(
    "S and T at zeros and poles in the right half plane, and the least peak they cost",
    ["Root", "S", "T", "Least peak"],
    constraints.map(({ root, kind, S, T, peak_bound }) => [`${kind} ${complexText(root)}`, tidied(S[0]), tidied(T[0]), `${kind === "zero" ? "Ms" : "Mt"} ≥ ${formatShort(peak_bound)}`]),
  );
  const sums = !integrals
    ? finding(sentence(reasons["integrals"]))
    : integrals.length > 0
      ? valueTable(
          "Integrals over this loop's own step response, fixed whatever the controller",
          ["Integral", "Step in", "Here", "Must be"],
          integrals.map(({ root, signal, step, value, theorem }) => [`∫ ${signal} e^(−${formatShort(root)} t) dt`, step, tidied(value), tidied(theorem)]),
        )
      : "";
  return part("Roots on the right", roots, sums);
}

/** @param {LimitsAnswer} answer @param {string} rate @returns {Table} */
function tableOf({ limits }, rate) {
  return { header: ["limit", "side", `omega [${rate}]`, "binding", "why"], rows: limits.map(({ id, side, omega, binding, because }) => [LIMIT_NAMES[id] ?? id, side, omega, binding ? "yes" : "no", because]) };
}
