/** The spectrum of a sampled sine, or of y, u or e of the loop with a noisy sensor. */

/** @import {SpectrumAnswer} from "../../core/workbench/analysis-types.js" */
/** @import {Api} from "../../core/api.js" */
/** @import {KnobName} from "../../core/workbench/spectrum.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {SpectrumView, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatFixed, formatNumber } from "../../core/format.js";
import { formatShort } from "../../core/roots.js";
import { KNOBS, spectrumRequest } from "../../core/workbench/spectrum.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h, setText } from "../../components/dom.js";
import { valueTable } from "../../components/facts.js";
import "../../components/gain-slider.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";
import { spectrumPlot } from "../../plots/spectrum.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  const view = () => store.get().view.analyses.spectrum;
  const ofSine = () => view().of === "sine";
  /** @param {Partial<SpectrumView>} patch */
  const change = (patch) => store.setAnalyses({ spectrum: { ...view(), ...patch } });

  const of = h("segmented-control", { label: "Spectrum of", class: "small" });
  of.options = [
    { value: "sine", label: "Sine", title: "A sine of your own" },
    { value: "y", label: "y", title: "y of the loop with a noisy sensor" },
    { value: "u", label: "u", title: "u of the loop with a noisy sensor" },
    { value: "e", label: "e", title: "The error r − y of the loop" },
  ];
  of.addEventListener("value-change", () => change({ of: /** @type {SpectrumView["of"]} */ (of.value) }));
  const setpoint = h("segmented-control", { label: "Setpoint r", class: "small" });
  setpoint.options = [
    { value: "0", label: "r stays", title: "Only the noise of the sensor moves the loop" },
    { value: "1", label: "r steps", title: "The setpoint steps to 1 as well" },
  ];
  setpoint.addEventListener("value-change", () => change({ setpoint: setpoint.value === "1" ? 1 : 0 }));
  const window = h("segmented-control", { label: "Window", class: "small" });
  window.options = [
    { value: "rectangular", label: "Rectangular", title: "No window: the record as it is" },
    { value: "hann", label: "Hann", title: "Fades in and out: less leakage, wider peaks" },
  ];
  window.addEventListener("value-change", () => change({ window: /** @type {SpectrumView["window"]} */ (window.value) }));

  /** @param {KnobName} name @param {string} label @param {Record<string, string | number | boolean>} more */
  function knob(name, label, more) {
    const slider = h("gain-slider", { label, ...KNOBS[name], ...more });
    const take = (/** @type {Event} */ event) => {
      const { value } = /** @type {CustomEvent<{value: number}>} */ (event).detail;
      change({ [name]: name.endsWith("samples") ? Math.round(value) : value });
    };
    slider.addEventListener("value-input", take);
    slider.addEventListener("value-change", take);
    return slider;
  }
  const knobs = {
    frequency: knob("frequency", "Frequency f", { unit: `1/${unit}`, above: 0, linear: true }),
    rate: knob("rate", "Sampling rate fs", { unit: `1/${unit}`, above: 0, linear: true }),
    loop_rate: knob("loop_rate", "Sampling rate fs", { unit: `1/${unit}`, above: 0 }),
    noise: knob("noise", "Noise of the sensor", { linear: true, hard: true }),
    samples: knob("samples", "Samples N", { hard: true, linear: true, step: 1 }),
    loop_samples: knob("loop_samples", "Samples N", { hard: true, linear: true, step: 1 }),
  };
  const says = h("p", { class: "finding" });
  const leaks = h("p", { class: "finding" });
  const facts = h("div");
  /** @type {import("../../core/workbench/analysis.js").Analysis<SpectrumAnswer>} */
  let analysis;

  function showForm() {
    of.value = view().of;
    window.value = view().window;
    setpoint.value = String(view().setpoint);
    setpoint.hidden = ofSine();
    for (const [name, slider] of Object.entries(knobs)) slider.value = view()[/** @type {KnobName} */ (name)];
    knobs.frequency.hidden = knobs.rate.hidden = knobs.samples.hidden = !ofSine();
    knobs.noise.hidden = knobs.loop_rate.hidden = knobs.loop_samples.hidden = ofSine();
  }

  function render() {
    const answer = /** @type {SpectrumAnswer} */ (analysis.answer);
    const { lines, rate, samples, resolution, highest, parseval, leakage_pct } = answer;
    const per = `per ${unit}`;
    const [line] = lines ?? [];
    setText(
      says,
      line === undefined
        ? `The mean is taken out. The line is what the noise alone gives: it has the shape of ${view().of === "u" ? "|CS|, so a larger gain wears the valve more" : "|T|, so the loop keeps fast noise out of y"}.${view().setpoint ? " What stands above it is the step of r, which the record cuts off: try the Hann window." : ""}`
        : line.aliased
          ? `Aliased: ${formatShort(line.frequency)} ${per} is seen at |f − ${line.k} fs| = ${formatShort(line.seen_at)} ${per}, for both sines go through the same samples. Sample faster than 2 f = ${formatShort(2 * line.frequency)} ${per}, or filter before sampling.`
          : `${formatShort(line.frequency)} ${per} is below fs/2 = ${formatShort(highest)} ${per}: the sine is seen where it is.`,
    );
    const periods = line === undefined ? 0 : line.seen_at / resolution;
    setText(
      leaks,
      leakage_pct === null
        ? ""
        : leakage_pct < 0.005
          ? `No leakage: ${formatShort(periods)} periods fit into the record.`
          : `Leakage: ${formatFixed(leakage_pct, 1)} % of the energy lies at other frequencies, for ${formatShort(periods, 4)} periods are no whole number. ${view().window === "hann" ? "Choose N or fs so that they are." : "Try the Hann window, or another N."}`,
    );
    facts.replaceChildren(
      valueTable("In numbers", ["", "Value", ""], [
        ["Samples N", String(samples), line === undefined && samples !== view().loop_samples ? "more than asked: the dead time must be a whole number of them" : ""],
        ["Rate fs", formatNumber(rate, 4), `per ${unit}`],
        ["Record N/fs", formatNumber(samples / rate, 4), unit],
        ["Finest step fs/N", formatNumber(resolution, 4), `per ${unit}`],
        ["Σ u² of the samples", formatNumber(parseval.energy, 6), ""],
        ["Σ |U|² of the spectrum", formatNumber(parseval.spectral_energy, 6), "Parseval: the same, with 1/√N before the sum"],
        ["Error of the inverse", formatNumber(parseval.inverse_error, 2), "the samples come back"],
      ]),
    );
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "spectrum",
      title: "Spectrum",
      help: ANALYSIS_HELP["spectrum"] ?? "",
      controls: [of],
      form: [h("div", { class: "knob-grid" }, ...Object.values(knobs)), setpoint, window],
      words: [h("div", { class: "analysis-parts" }, says, leaks, facts)],
      figure: createFigure,
      subject: () => view().of,
      render,
      draw: (theme, held) => (analysis?.answer ? spectrumPlot({ answer: analysis.answer, signal: ofSine() ? "samples" : view().of, timeUnit: unit }, theme, held) : null),
      legend: () =>
        (ofSine() ? ["signal", "samples", "seen", "spectrum", "half_rate"] : [view().of, "expected", "half_rate"]).map((name) => {
          const { label, name: meaning, dash } = /** @type {import("../../plots/signals.js").Signal} */ (SIGNALS[name]);
          return name === "samples" ? { signal: name, label, name: meaning, glyph: "●" } : { signal: name, label, name: meaning, dash };
        }),
      table: () => (analysis?.answer ? tableOf(analysis.answer, unit) : null),
      describe: () => `Signal and spectrum. ${says.textContent} ${leaks.textContent}`,
    },
    (onChange) => [(analysis = createAnalysis(store, { request: spectrumRequest, send: (request) => api.analyse("spectrum", request) }, onChange))],
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

/** @param {SpectrumAnswer} answer @param {string} unit @returns {Table} */
function tableOf({ frequency, omega, amplitude, magnitude, phase_deg }, unit) {
  return {
    header: [`frequency [1/${unit}]`, `omega [rad/${unit}]`, "amplitude", "|U| (1/sqrt(N))", "phase [deg]"],
    rows: Array.from(frequency, (f, k) => [f, omega[k] ?? null, amplitude[k] ?? null, magnitude[k] ?? null, phase_deg[k] ?? null]),
  };
}
