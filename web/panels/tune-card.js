/** Tuning rules: which gains each gives for this plant, by which formula, and why one refuses. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */
/** @import {TuneAnswer, TuneSetting} from "../core/types.js" */

import { formatNumber, formatWithUnit, sentence } from "../core/format.js";
import { applySetting } from "../core/loop.js";
import { createCard } from "../components/card.js";
import { h } from "../components/dom.js";
import { showMath } from "../components/mathml.js";
import { symbol } from "../components/symbol.js";
import { toast } from "../components/status-toast.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const { answers } = store;
  const out = h("div", { class: "rules" });
  /** The plant that the rules shown are for. */
  let shownFor = "";
  const card = createCard(host, { id: "card-tune", title: "Tune", open: false, onToggle: (open) => open && void ask() });
  card.body.append(out);
  card.summarise("fill the gains from a rule");

  async function ask() {
    const { plant } = store.get();
    const key = JSON.stringify(plant);
    if (key === shownFor || answers.error) return;
    shownFor = key;
    out.classList.add("stale");
    try {
      const answer = await api.tune({ plant });
      // A newer plant has been asked for meanwhile.
      if (shownFor !== key) return;
      out.replaceChildren(...rules(answer));
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
  function rules({ settings, ultimate, model }) {
    const byRule = [...new Set(settings.map(({ rule }) => rule))].map((rule) => settings.filter((setting) => setting.rule === rule));
    return byRule.map((group) => ruleBlock(group, basis(group[0]?.rule ?? "", ultimate, model)));
  }

  /** What a rule reads off the plant. @param {string} rule @param {TuneAnswer["ultimate"]} ultimate @param {TuneAnswer["model"]} model */
  function basis(rule, ultimate, model) {
    const unit = answers.time_unit;
    if (rule.includes("ziegler") && ultimate?.Ku != null) {
      return h("p", { class: "basis" }, symbol("Ku"), ` = ${formatNumber(ultimate.Ku, 4)}, `, symbol("Pu"), ` = ${formatWithUnit(ultimate.Pu, unit, 4)}`);
    }
    if (rule.includes("cohen") && model) {
      return h("p", { class: "basis", title: model.how }, symbol("K"), ` = ${formatNumber(model.K)}, `, symbol("tau"), ` = ${formatWithUnit(model.tau, unit)}, `, symbol("theta"), ` = ${formatWithUnit(model.theta, unit)}. ${sentence(model.how)}`);
    }
    return null;
  }

  /** @param {TuneSetting[]} group @param {HTMLElement | null} readings */
  function ruleBlock(group, readings) {
    const [first] = group;
    const refused = group.every(({ valid }) => !valid);
    const reason = group.find(({ reason: why }) => why)?.reason ?? null;
    const body = refused
      ? h("p", { class: "refused" }, "Does not apply. ", sentence(reason ?? "the plant is outside its range"))
      : h("div", { class: "rule-settings" }, ...group.map(settingRow));
    return h("section", { class: "rule", "aria-label": first?.name ?? "" }, h("h3", {}, first?.name ?? ""), refused ? null : readings, body, h("p", { class: "source" }, first?.source ?? ""));
  }

  /** @param {TuneSetting} setting */
  function settingRow(setting) {
    const { type, valid, reason, Kc, tau_I, tau_D, formula } = setting;
    const math = h("div", { class: "math-display small" });
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
    const row = h("div", { class: "setting" }, h("div", { class: "setting-head" }, h("strong", {}, type), valid ? values : h("span", { class: "refused" }, sentence(reason ?? "does not apply")), valid ? use : null), math);
    if (valid) row.dataset["setting"] = JSON.stringify([type, Kc, tau_I, tau_D]);
    return row;
  }

  /** Marks the setting whose gains are the ones in force. */
  function showInForce() {
    const { type, form, Kc, tau_I, tau_D } = store.get().controller;
    const near = (/** @type {number | null} */ a, /** @type {number} */ b) => a === null || Math.abs(a - b) <= 1e-6 * Math.abs(b);
    for (const row of out.querySelectorAll(".setting")) {
      const text = /** @type {HTMLElement} */ (row).dataset["setting"];
      const [t, k, i, d] = text ? JSON.parse(text) : [];
      row.classList.toggle("in-force", form === "ideal" && t === type && near(k === undefined ? null : Math.abs(k), Kc) && near(i ?? null, tau_I) && near(d ?? null, tau_D));
    }
  }

  const stopStore = store.subscribe((_, change) => {
    if (!change.design || change.moving) return;
    showInForce();
  });
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
