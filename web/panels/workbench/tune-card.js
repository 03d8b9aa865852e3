/** Tuning rules: which gains each gives for this plant, by which formula, and why one refuses. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {RuleOptions, TuneAnswer, TuneBasis, TuneSetting} from "../../core/types.js" */

import { PM_DEG, TAU_C } from "../../core/workbench/analyses.js";
import { formatNumber, formatWithUnit, greek, sentence } from "../../core/format.js";
import { applySetting } from "../../core/workbench/loop.js";
import { groupBy } from "../../core/groups.js";
import { createCard } from "../../components/card.js";
import { h } from "../../components/dom.js";
import { showMath } from "../../components/mathml.js";
import "../../components/number-field.js";
import { symbol } from "../../components/symbol.js";
import { toast } from "../../components/status-toast.js";

/** What is shown of the data that a rule started from, and whether it is a time. @type {Array<[name: string, time: boolean]>} */
const BASIS = [["Ku", false], ["Pu", true], ["K", false], ["tau", true], ["tau_1", true], ["tau_2", true], ["zeta", false], ["theta", true]];

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const { answers } = store;
  const out = h("div", { class: "rules" });
  /** The plant and the choices that the rules shown are for. */
  let shownFor = "";
  /** Rules that the student opened; before that, the first that applies. @type {Set<string> | null} */
  let opened = null;
  const card = createCard(host, { id: "card-tune", title: "Tune", open: false, onToggle: (open) => open && void ask() });
  const tau_c = h("number-field", { name: "tau_c", unit: answers.time_unit, min: TAU_C.min, max: TAU_C.max, optional: true, placeholder: "each rule's own" });
  const PM_deg = h("number-field", { label: "Phase margin", unit: "°", min: PM_DEG.min, max: PM_DEG.max });
  tau_c.addEventListener("value-change", () => choose({ tau_c: tau_c.value }));
  PM_deg.addEventListener("value-change", () => PM_deg.value !== null && choose({ PM_deg: PM_deg.value }));
  card.body.append(
    h(
      "div",
      { class: "rule-options" },
      tau_c,
      h("p", { class: "field-hint" }, "IMC, lambda and SIMC: how fast the closed loop is to be."),
      PM_deg,
      h("p", { class: "field-hint" }, "Åström–Hägglund relay: what it aims at."),
    ),
    out,
  );
  card.summarise("fill the gains from a rule");

  /** @param {Partial<RuleOptions>} patch */
  function choose(patch) {
    store.setAnalyses({ tune: { ...store.get().view.analyses.tune, ...patch } });
  }

  async function ask() {
    const { plant, view } = store.get();
    const request = { plant, ...view.analyses.tune };
    const key = JSON.stringify(request);
    if (key === shownFor || answers.error) return;
    shownFor = key;
    out.classList.add("stale");
    try {
      const answer = await api.tune(request);
      // A newer plant has been asked for meanwhile.
      if (shownFor !== key) return;
      out.replaceChildren(...families(answer));
      showInForce();
    } catch (error) {
      if (shownFor !== key) return;
      shownFor = "";
      out.replaceChildren(h("p", { class: "empty" }, error instanceof Error ? error.message : "The rules could not be asked.", " ", h("button", { type: "button", class: "link", onclick: () => void ask() }, "Try again")));
    } finally {
      out.classList.remove("stale");
    }
  }

  /** @param {TuneAnswer} answer */
  function families({ settings }) {
    const first = settings.find(({ valid }) => valid)?.rule;
    return [...groupBy(settings, ({ family }) => family)].map(([family, all]) => {
      const rules = [...groupBy(all, ({ rule }) => rule).values()];
      const applies = (/** @type {TuneSetting[]} */ group) => group.some(({ valid }) => valid);
      const refused = groupBy(rules.filter((group) => !applies(group)), (group) => group[0]?.reason ?? "the plant is outside its range");
      return h(
        "section",
        { class: "rule-family", "aria-label": family },
        h("h3", {}, family),
        ...rules.filter(applies).map((group) => ruleBlock(group, first)),
        refused.size === 0 ? null : h("div", { class: "refused-rules" }, ...[...refused].map(([reason, groups]) => refusal(reason, groups))),
      );
    });
  }

  /** @param {string} reason @param {TuneSetting[][]} groups */
  function refusal(reason, groups) {
    const names = groups.map((group) => group[0]?.name ?? "").join(", ");
    return h("p", { class: "refused" }, h("strong", {}, names), groups.length > 1 ? " do not apply. " : " does not apply. ", greek(sentence(reason)));
  }

  /** @param {TuneSetting[]} group @param {string | undefined} first */
  function ruleBlock(group, first) {
    const [{ rule, name, source, validity }] = /** @type {[TuneSetting, ...TuneSetting[]]} */ (group);
    const types = group.filter(({ valid }) => valid).map(({ type }) => type);
    const body = h("div", { class: "rule-body" });
    let shown = "";
    for (const setting of group) {
      const basis = JSON.stringify(setting.basis);
      if (setting.basis && basis !== shown) body.append(basisLine(setting.basis));
      shown = basis;
      body.append(settingRow(setting));
    }
    body.append(h("p", { class: "source" }, `${greek(sentence(`range: ${validity}`))} ${source}.`));
    const details = h("details", { class: "rule" }, h("summary", {}, h("h4", {}, name), h("span", { class: "types" }, types.join(" · "))), body);
    details.open = opened ? opened.has(rule) : rule === first;
    details.addEventListener("toggle", () => {
      opened ??= new Set(first ? [first] : []);
      if (details.open) opened.add(rule);
      else opened.delete(rule);
    });
    return details;
  }

  /** What a rule read off the plant. @param {TuneBasis} basis */
  function basisLine({ values, how }) {
    const unit = answers.time_unit;
    const lags = values["tau_1"] !== undefined;
    const parts = BASIS.filter(([name]) => values[name] !== undefined && !(lags && (name === "tau" || name === "zeta"))).flatMap(([name, time], i) => {
      const value = values[name];
      return [i ? ", " : "", symbol(name), ` = ${time ? formatWithUnit(value, unit, 4) : formatNumber(value, 4)}`];
    });
    return h("p", { class: "basis" }, ...parts, `. ${sentence(how)}`);
  }

  /** @param {TuneSetting} setting */
  function settingRow(setting) {
    const { type, valid, reason, Kc, tau_I, tau_D, formula, note, published } = setting;
    const math = h("div", { class: "math-display small", tabindex: "0", role: "group", "aria-label": `Formula of ${setting.name}, ${type}` });
    showMath(math, formula?.mathml);
    const values = h(
      "span",
      { class: "setting-values" },
      h("span", {}, symbol("Kc"), ` ${formatNumber(Kc, 4)}`),
      tau_I === null ? null : h("span", {}, symbol("tau_I"), ` ${formatNumber(tau_I, 4)}`),
      tau_D === null ? null : h("span", {}, symbol("tau_D"), ` ${formatNumber(tau_D, 4)}`),
    );
    const use = h("button", { type: "button", class: "button use", "aria-label": `Use ${setting.name}, ${type}` }, "Use");
    use.addEventListener("click", () => {
      store.set({ controller: applySetting(setting, store.get().controller) });
      toast().say(`${setting.name}, ${type}: gains are set.`, { action: { label: "Undo", run: () => store.undo() } });
    });
    const remarks = [
      note ? greek(sentence(note)) : "",
      published ? `The source gives the series form: ${formatNumber(published.Kc, 4)}, ${formatNumber(published.tau_I, 4)}, ${formatNumber(published.tau_D, 4)}; converted to the ideal form.` : "",
    ].filter(Boolean);
    const row = h(
      "div",
      { class: "setting" },
      h("div", { class: "setting-head" }, h("strong", {}, type), valid ? values : h("span", { class: "refused" }, greek(sentence(reason ?? "does not apply"))), valid ? use : null),
      math,
      remarks.length ? h("p", { class: "basis" }, remarks.join(" ")) : null,
    );
    if (valid) row.dataset["setting"] = JSON.stringify([type, Kc, tau_I, tau_D]);
    return row;
  }

  /** Marks the settings whose gains are the ones in force. */
  function showInForce() {
    const { type, form, Kc, tau_I, tau_D } = store.get().controller;
    const near = (/** @type {number | null} */ a, /** @type {number} */ b) => a === null || Math.abs(a - b) <= 1e-6 * Math.abs(b);
    for (const row of out.querySelectorAll(".setting")) {
      const text = /** @type {HTMLElement} */ (row).dataset["setting"];
      const [t, k, i, d] = text ? JSON.parse(text) : [];
      row.classList.toggle("in-force", form === "ideal" && t === type && near(k === undefined ? null : Math.abs(k), Kc) && near(i ?? null, tau_I) && near(d ?? null, tau_D));
    }
    for (const rule of out.querySelectorAll(".rule")) rule.classList.toggle("in-force", rule.querySelector(".setting.in-force") !== null);
  }

  function showOptions() {
    const chosen = store.get().view.analyses.tune;
    tau_c.value = chosen.tau_c;
    PM_deg.value = chosen.PM_deg;
  }

  const stopStore = store.subscribe((_, change) => {
    if (change.moving) return;
    if (change.design) showInForce();
    if (change.view) {
      showOptions();
      if (!card.body.hidden) void ask();
    }
  });
  showOptions();
  // The rules follow the plant once the server has accepted it.
  const stopAnswers = answers.subscribe(({ moving }) => {
    if (!moving && !card.body.hidden) void ask();
  });
  return () => {
    stopStore();
    stopAnswers();
    card.root.remove();
  };
}
