/** Controllers side by side: the present settings, the best ones and the rules', on this plant or on another. */

/** @import {Api} from "../../core/api.js" */
/** @import {ComparedRow, CompareAnswer, RuleEntry, SpreadCase} from "../../core/workbench/analysis-types.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {CompareView, RuleChoice, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { MOST_RULES, MS_LIMIT, SPREAD } from "../../core/workbench/analyses.js";
import { ANALYSIS_HELP, MEANING } from "../../core/explain.js";
import { formatFixed, formatNumber, sentence, UNDEFINED } from "../../core/format.js";
import { groupBy } from "../../core/groups.js";
import { applySetting } from "../../core/workbench/loop.js";
import { compare, compareRequest } from "../../core/workbench/tuning.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { createExpressionField } from "../../components/expression-field.js";
import { captioned, part, valueTable } from "../../components/facts.js";
import { icon } from "../../components/icons.js";
import "../../components/number-field.js";
import "../../components/segmented-control.js";
import { createSelectField } from "../../components/select-field.js";
import { symbol } from "../../components/symbol.js";
import { toast } from "../../components/status-toast.js";
import { valueCell } from "../../components/value-cell.js";
import { comparePlot } from "../../plots/compare.js";
import { createFigure } from "../../plots/figure.js";
import { SIGNALS } from "../../plots/signals.js";

/** @typedef {{of: "margins" | "setpoint" | "load", name: string, head: string, spoken: string}} Column */

/** @type {Column[]} */
const COLUMNS = [
  { of: "margins", name: "GM", head: "GM", spoken: "Gain margin" },
  { of: "margins", name: "PM_deg", head: "PM [°]", spoken: "Phase margin, in degrees" },
  { of: "margins", name: "Ms", head: "Ms", spoken: "Sensitivity peak" },
  { of: "setpoint", name: "overshoot_pct", head: "Overshoot [%]", spoken: "Overshoot of the setpoint step, in per cent" },
  { of: "setpoint", name: "t_settle", head: "Settling", spoken: "Settling time of the setpoint step" },
  { of: "setpoint", name: "IAE", head: "IAE, r", spoken: "IAE of the setpoint step" },
  { of: "load", name: "IAE", head: "IAE, d", spoken: "IAE of the load step" },
  { of: "setpoint", name: "TV", head: "TV of u", spoken: "Total variation of u after the setpoint step" },
];

/** @param {number} index  of the row */
function signalOf(index) {
  return index === 0 ? "now" : index === 1 ? "optimal" : `case_${index - 1}`;
}

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  const view = () => store.get().view.analyses.compare;
  const choose = (/** @type {Partial<CompareView>} */ patch) => store.setAnalyses({ compare: { ...view(), ...patch } });
  /** @type {RuleEntry[] | null} */
  let known = null;
  /** @type {import("../../core/workbench/analysis.js").Analysis<CompareAnswer>} */
  let analysis;

  const step = h("segmented-control", { label: "Step in", class: "small" });
  step.options = [
    { value: "setpoint", label: "Setpoint", title: "Unit step of the setpoint r" },
    { value: "load", label: "Load", title: "Unit step of the load d at the plant's input" },
  ];
  step.addEventListener("value-change", () => store.setView({ signal: step.value === "load" ? "load" : "setpoint" }));

  const rulePlace = h("div", { class: "compare-add" });
  const spread = h("number-field", { label: "Model error ±", unit: "%", min: SPREAD.min, max: SPREAD.max, optional: true, placeholder: "none" });
  spread.addEventListener("value-change", () => choose({ spread_pct: spread.value }));
  const limit = h("number-field", { label: "Optimal with Ms up to", min: MS_LIMIT.min, max: MS_LIMIT.max });
  limit.addEventListener("value-change", () => limit.value !== null && store.setAnalyses({ Ms_limit: limit.value }));
  const truth = createExpressionField({
    id: "true-plant-text",
    symbol: "True P",
    hint: "What the loops are closed around. Empty: the plant itself.",
    commit: (text) => choose({ true_plant: text }),
  });

  const words = h("div", { class: "analysis-parts" });

  const sameRule = (/** @type {RuleChoice} */ a, /** @type {RuleChoice} */ b) => a.rule === b.rule && a.type === b.type;
  /** The chosen rules that the server has. */
  const rules = () => view().rules.filter(({ rule, type }) => known?.some(({ id, types }) => id === rule && types.includes(type)));

  /** @param {RuleEntry[]} entries */
  function offer(entries) {
    const families = [...groupBy(entries, ({ family }) => family)].map(([label, all]) => ({
      label,
      choices: all.flatMap(({ id, name, types }) => types.map((type) => ({ value: `${id}.${type}`, label: `${name}, ${type}` }))),
    }));
    const field = createSelectField({
      label: "Add a rule",
      groups: [{ label: null, choices: [{ value: "", label: "Choose…" }] }, ...families],
      onChoice(value) {
        field.show("");
        const [rule = "", type] = value.split(".");
        const choice = { rule, type: /** @type {RuleChoice["type"]} */ (type) };
        if (!type || rules().some((other) => sameRule(other, choice))) return;
        if (rules().length >= MOST_RULES) toast().say(`At most ${MOST_RULES} rules: remove one first.`);
        else choose({ rules: [...rules(), choice] });
      },
    });
    rulePlace.replaceChildren(field.root);
  }

  /** @param {ComparedRow} row */
  function use({ type, controller, label }) {
    if (!controller) return;
    store.set({ controller: applySetting({ ...controller, type }, store.get().controller) });
    toast().say(`${label}: gains are set.`, { action: { label: "Undo", run: () => store.undo() } });
  }

  /** @param {ComparedRow} found @param {number} index */
  function row(found, index) {
    const { label, type, controller, reason, valid, closed_loop_stable: stable } = found;
    const { dash } = SIGNALS[signalOf(index)] ?? {};
    const swatch = h("span", { class: `swatch ${dash ?? "solid"}`, "aria-hidden": "true" });
    swatch.style.setProperty("--swatch", `var(--signal-${signalOf(index)})`);
    const name = index === 0 ? `Now (${type})` : label;
    const remove =
      index < 2
        ? null
        : h("button", { type: "button", class: "icon-button", "aria-label": `Remove ${label}`, title: "Remove", onclick: () => choose({ rules: rules().filter((_, k) => k !== index - 2) }) }, icon("close"));
    const head = h("th", { scope: "row" }, h("span", { class: "compare-name" }, swatch, name));
    const figures = valid
      ? COLUMNS.map(({ of, name: field }) => {
          const cell = valueCell();
          const value = found[of]?.[field] ?? null;
          const { decimals } = MEANING[field] ?? {};
          cell.show(decimals === undefined ? formatNumber(value) : formatFixed(value, decimals), found[of]?.reasons[field] ?? null);
          return cell.root;
        })
      : [h("td", { class: "because", colspan: COLUMNS.length }, sentence(reason))];
    const gains = [controller?.Kc, controller?.tau_I, controller?.tau_D].map((gain) => h("td", {}, formatNumber(gain)));
    const usable = valid && index > 0;
    const button = usable ? h("button", { type: "button", class: "button use", "aria-label": `Use ${label}`, onclick: () => use(found) }, "Use") : null;
    const line = h("tr", { class: usable ? "usable" : null, title: usable ? "Use these settings" : null }, head, ...gains, ...figures, h("td", { class: "compare-buttons" }, button, remove));
    line.classList.toggle("unstable", valid && stable === false);
    if (usable) line.addEventListener("click", (event) => !(/** @type {Element} */ (event.target).closest("button")) && use(found));
    return line;
  }

  /** @param {CompareAnswer} answer */
  function table({ rows }) {
    const gains = ["Kc", "tau_I", "tau_D"].map((name) => h("th", { scope: "col" }, symbol(name)));
    const heads = COLUMNS.map(({ head, spoken }) => h("th", { scope: "col", title: spoken }, head === "Settling" ? `Settling [${unit}]` : head));
    return captioned(
      `Times in ${unit}; IAE after a unit step of the setpoint r and of the load d`,
      h("table", { class: "values compare" }, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Settings"), ...gains, ...heads, h("td"))), h("tbody", {}, ...rows.map(row))),
    );
  }

  /** @param {CompareAnswer} answer */
  function worst({ rows }) {
    const spreads = rows.flatMap(({ label, sensitivity }, index) => (sensitivity ? [{ label: index === 0 ? "Now" : label, ...sensitivity }] : []));
    const [first] = spreads;
    if (!first) return null;
    const plant = (/** @type {SpreadCase | null} */ found) => {
      if (!found) return UNDEFINED;
      const changed = [["K", found.K], ["τ", found.tau], ["θ", found.theta]].filter(([, factor]) => factor !== 1);
      return changed.length > 0 ? changed.map(([name, factor]) => `${name} × ${factor}`).join(", ") : "no error";
    };
    return part(
      `With a model error of ±${first.spread_pct} %`,
      valueTable(
        `The worst of ${first.cases} plants for each of the settings`,
        ["Settings", "Stable on", "Worst Ms", "on the plant with", "Worst IAE, d", "on the plant with"],
        spreads.map(({ label, cases, unstable, worst_Ms, worst_IAE }) => [
          label,
          `${cases - unstable.length} of ${cases}`,
          formatNumber(worst_Ms?.Ms),
          plant(worst_Ms),
          formatNumber(worst_IAE?.load_IAE),
          plant(worst_IAE),
        ]),
      ),
    );
  }

  function render() {
    const answer = /** @type {CompareAnswer} */ (analysis.answer);
    const { actuator, sensor } = store.get();
    const bare = actuator.trim() || sensor.trim() ? h("p", { class: "finding" }, "Actuator and sensor are left out here: rules and loops see the plant alone.") : null;
    words.replaceChildren(...[bare, table(answer), worst(answer)].filter((item) => item !== null));
    showForm();
  }

  function showForm() {
    step.value = store.get().view.signal;
    spread.value = view().spread_pct;
    limit.value = store.get().view.analyses.Ms_limit;
    truth.show(view().true_plant);
    const wrong = analysis?.error;
    truth.complain(String(wrong?.path ?? "").includes("true_plant") ? wrong : null);
  }

  const cases = () => (analysis?.answer?.rows ?? []).map((found, index) => Object.assign({}, found, { signal: signalOf(index) }));
  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "compare",
      title: "Compare",
      help: ANALYSIS_HELP["compare"] ?? "",
      controls: [step],
      form: [h("div", { class: "form-fields" }, rulePlace, limit, spread), truth.root],
      words: [words],
      figure: createFigure,
      subject: () => JSON.stringify([store.get().plant, view().true_plant, store.get().view.signal]),
      render,
      draw: (theme, held) => (analysis?.answer ? comparePlot({ cases: cases(), horizon: analysis.answer.horizon, step: store.get().view.signal, timeUnit: unit }, theme, held) : null),
      table: () => (analysis?.answer ? tableOf(analysis.answer) : null),
      describe: () => `Responses of y to a ${store.get().view.signal} step with ${cases().filter(({ responses }) => responses).length} controllers.`,
    },
    (onChange) => [
      (analysis = createAnalysis(
        store,
        { request: (state) => (known ? compareRequest(state, rules()) : null), send: (request) => compare(api, request) },
        () => {
          showForm();
          onChange();
        },
      )),
    ],
  );
  const stop = store.subscribe((_, change) => {
    if (change.view) panel.redraw();
  });
  showForm();
  async function learnRules() {
    try {
      known = (await api.rules()).rules;
      offer(known);
    } catch (error) {
      // Without them the present and the best settings can still be compared.
      known = [];
      toast().say(error instanceof Error ? error.message : "The rules could not be asked.");
    }
    // Now there is something to ask.
    choose({});
  }
  void learnRules();
  return () => {
    stop();
    truth.dispose();
    panel.dispose();
  };
}

/** @param {CompareAnswer} answer @returns {Table} */
function tableOf({ rows }) {
  return {
    header: ["settings", "type", "Kc", "tau_I", "tau_D", ...COLUMNS.map(({ of, name }) => `${name}, ${of}`)],
    rows: rows.map(({ label, type, controller, ...found }) => [label, type, controller?.Kc ?? null, controller?.tau_I ?? null, controller?.tau_D ?? null, ...COLUMNS.map(({ of, name }) => found[of]?.[name] ?? null)]),
  };
}
