/** Step 3, the model in numbers: how sure they are, how well they fit, what speaks against them, and all methods side by side. */

/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {MethodFound, MethodName} from "../../core/experiments/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { METHODS } from "../../core/experiments/construction.js";
import { formatFixed, formatNumber, formatWithUnit, greek, sentence, UNDEFINED } from "../../core/format.js";
import { unitRatio } from "../../core/units.js";
import { readOff } from "../../core/experiments/read-off.js";
import { h } from "../../components/dom.js";
import { captioned, headRow } from "../../components/facts.js";
import { symbol } from "../../components/symbol.js";

const REST_MS = 200;
const NAMES = ["K", "tau", "zeta", "theta"];
const TIMES = new Set(["tau", "theta"]);

/** @param {Step} step @param {ExperimentBench} bench @param {{next: () => void}} options */
export function mount(step, bench, { next }) {
  let rest = 0;
  const numbers = h("dl", { class: "model-numbers" });
  const status = h("p", { class: "finding", role: "status" });
  const warnings = h("ul", { class: "model-warnings" });
  const tune = h("button", { type: "button", class: "button primary", onclick: next }, "Tune this model");
  const found = h("div", { class: "model-found" }, numbers, status, warnings, tune);
  const methods = h("div", { class: "model-methods" });
  step.side.append(found);
  step.stage.append(methods);

  /** @param {string} name */
  const unitOf = (name) => {
    const { timeUnit = "", inputUnit = "", outputUnit = "" } = bench.source ?? {};
    if (TIMES.has(name)) return timeUnit;
    return name === "K" ? unitRatio(outputUnit, inputUnit) : "";
  };

  function tell() {
    const { identified, setting } = bench;
    const read = readOff(identified, setting.method, setting.moved);
    found.hidden = !read;
    if (!read) return;
    const { model, fit_pct, reason, hand, found: own } = read;
    const intervals = hand ? null : own.intervals;
    numbers.replaceChildren(
      ...NAMES.filter((name) => model && name in model).flatMap((name) => {
        const ends = intervals?.[name];
        return [h("dt", {}, symbol(name)), h("dd", {}, h("strong", {}, formatWithUnit(model?.[name], unitOf(name), 4)), ends ? h("small", {}, `95 %: ${formatNumber(ends[0])} … ${formatNumber(ends[1])}`) : null)];
      }),
      ...(fit_pct === null ? [] : [h("dt", {}, "fit"), h("dd", {}, h("strong", {}, `${formatFixed(fit_pct, 1)} %`), h("small", {}, hand ? "of your lines" : "of the output's variation"))]),
    );
    status.textContent = reason ? greek(sentence(reason)) : hand ? (model?.["theta"] === 0 ? "The lines are yours; they give no dead time above zero, so θ is taken as 0." : "The lines are yours.") : intervals || setting.method.startsWith("least") ? greek(sentence(own.intervals_note)) : "";
    warnings.replaceChildren(...(hand ? own.warnings.filter((words) => !/interval/.test(words)) : own.warnings).map((words) => h("li", {}, greek(sentence(words)))));
    tune.disabled = !model;
  }

  /** @param {MethodFound} one */
  function row(one) {
    const { model, fit_pct, reason, method } = one;
    const chosen = method === bench.setting.method;
    const use = h("button", { type: "button", class: "button small", "aria-pressed": String(chosen), "aria-label": `Show ${METHODS[method].label}`, onclick: () => bench.setMethod(/** @type {MethodName} */ (method)) }, chosen ? "Shown" : "Show");
    const cells = model ? [...NAMES.map((name) => (name in model ? formatNumber(model[name], 4) : UNDEFINED)), fit_pct === null ? UNDEFINED : `${formatFixed(fit_pct, 1)} %`].map((text) => h("td", {}, text)) : [h("td", { colspan: 5, class: "because" }, greek(sentence(reason)))];
    return h("tr", { class: chosen ? "chosen" : null }, h("th", { scope: "row" }, METHODS[method].label), ...cells, h("td", {}, use));
  }

  function list() {
    const { identified, source } = bench;
    methods.hidden = !identified;
    if (!identified?.methods) return methods.replaceChildren(h("p", { class: "field-hint" }, "Working out the other methods…"));
    const unit = source?.timeUnit ? ` [${source.timeUnit}]` : "";
    methods.replaceChildren(captioned("Methods side by side", h("table", { class: "values" }, headRow(["Method", "K", `τ${unit}`, "ζ", `θ${unit}`, "fit", ""]), h("tbody", {}, ...identified.methods.map(row)))));
  }

  /** The model goes on to the rules once it has come to rest. */
  function pass() {
    const { identified, setting } = bench;
    const read = readOff(identified, setting.method, setting.moved);
    if (!read) return;
    const { system, hand } = read;
    bench.setModel(system ? { system, by: METHODS[setting.method].label, hand } : null);
  }

  bench.on(["identified", "method", "lines"], () => {
    tell();
    clearTimeout(rest);
    rest = window.setTimeout(pass, REST_MS);
  });
  bench.on(["identified", "method"], list);
  tell();
  list();
}
