/** Step 4: what the tuning rules make of the model or of the ultimate point, and the one that is tried. */

/** @import {Api} from "../../core/api.js" */
/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {TuneSetting} from "../../core/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { tuneRequest } from "../../core/experiments/requests.js";
import { formatNumber, formatWithUnit, greek, sentence, UNDEFINED } from "../../core/format.js";
import { groupBy } from "../../core/groups.js";
import { patiently } from "../../core/patience.js";
import { unitRatio } from "../../core/units.js";
import { h, setText } from "../../components/dom.js";
import { captioned, headRow } from "../../components/facts.js";
import { showMath } from "../../components/mathml.js";
import "../../components/segmented-control.js";

const TYPES = ["P", "PI", "PID"];

/** @param {Step} step @param {ExperimentBench} bench @param {Api} api */
export function mount(step, bench, api) {
  let asked = "";
  let type = bench.setting.pick && TYPES.includes(bench.setting.pick.type) ? bench.setting.pick.type : "PI";
  const types = h("segmented-control", { label: "Type of controller" });
  types.options = TYPES.map((value) => ({ value, label: value }));
  types.value = type;
  types.addEventListener("value-change", () => {
    type = /** @type {typeof type} */ (types.value);
    list();
  });
  const known = h("p", { class: "field-hint" });
  const chosen = h("div", { class: "rule-chosen" });
  const table = h("div", { class: "rules-table" });
  step.side.append(types, known, chosen, step.message);
  step.stage.append(table);

  async function ask() {
    const request = tuneRequest(bench.found);
    const key = JSON.stringify(request);
    if (key === asked) return;
    asked = key;
    step.say("");
    if (!request) return bench.setRules(null);
    try {
      const answer = await patiently(() => api.tune(/** @type {any} */ (request)));
      if (asked === key) bench.setRules(answer);
    } catch (error) {
      if (asked !== key) return;
      asked = "";
      bench.setRules(null);
      step.complain(error);
    }
  }

  function tellKnown() {
    const { model, ultimate } = bench.found;
    const unit = bench.about?.timeUnit ?? "";
    const parts = [
      model ? `the model (${model.hand ? "your lines" : model.by.toLowerCase()})` : "",
      ultimate ? `the ultimate point by ${ultimate.by}: Ku = ${formatNumber(ultimate.Ku)}, Pu = ${formatWithUnit(ultimate.Pu, unit)}` : "",
    ].filter(Boolean);
    setText(known, parts.length > 0 ? `The rules start from ${parts.join(", and ")}.` : "Nothing is known of the plant yet: identify a model, or find its ultimate point.");
  }

  /** @param {TuneSetting} setting */
  function row(setting) {
    const { rule, name, Kc, tau_I, tau_D } = setting;
    const { pick } = bench.setting;
    const on = pick?.rule === rule && pick.type === setting.type;
    const use = h("button", { type: "button", class: "button small", "aria-pressed": String(on), "aria-label": `Try ${name}, ${setting.type}`, onclick: () => bench.setPick({ rule, type: setting.type }) }, on ? "Tried below" : "Try it");
    return h("tr", { class: on ? "chosen" : null }, h("th", { scope: "row" }, name), ...[Kc, tau_I, tau_D].map((value) => h("td", {}, value === null ? UNDEFINED : formatNumber(value, 4))), h("td", {}, use));
  }

  /** The table holds the focus over a change of what is in it. */
  function list() {
    const { rules } = bench;
    const focused = table.contains(document.activeElement) ? document.activeElement?.getAttribute("aria-label") : null;
    if (!rules) {
      table.replaceChildren(h("p", { class: "empty" }, "The rules appear here once there is a model, or an ultimate point."));
      return;
    }
    const ours = rules.settings.filter((setting) => setting.type === type);
    const valid = ours.filter((setting) => setting.valid);
    const refused = groupBy(ours.filter((setting) => !setting.valid), ({ reason }) => reason ?? "the plant is outside its range");
    const unit = bench.source?.timeUnit || bench.about?.timeUnit || "";
    const time = unit ? ` [${unit}]` : "";
    const { inputUnit = "", outputUnit = "" } = bench.source ?? bench.about ?? {};
    const gain = unitRatio(inputUnit, outputUnit);
    table.replaceChildren(
      valid.length > 0 ? captioned(`${type} by rules, ideal form`, h("table", { class: "values" }, headRow(["Rule", gain ? `Kc [${gain}]` : "Kc", `τI${time}`, `τD${time}`, ""]), h("tbody", {}, ...valid.map(row)))) : h("p", { class: "empty" }, `No rule gives a ${type} controller here. Choose another type.`),
      ...(refused.size > 0 ? [h("details", { class: "step-fold" }, h("summary", {}, ours.length - valid.length === 1 ? "One rule does not apply" : `${ours.length - valid.length} rules do not apply`), ...[...refused].map(([reason, all]) => h("p", { class: "finding" }, h("strong", {}, all.map(({ name }) => name).join(", ")), `: ${greek(sentence(reason))}`)))] : []),
    );
    if (focused) /** @type {HTMLElement | null} */ (table.querySelector(`[aria-label="${CSS.escape(focused)}"]`))?.focus();
  }

  function tellChosen() {
    const { tuned } = bench;
    if (!tuned) return chosen.replaceChildren();
    const math = h("div", { class: "math-display small", tabindex: "0", role: "group", "aria-label": `Formula of ${tuned.name}` });
    showMath(math, tuned.formula?.mathml);
    chosen.replaceChildren(h("h3", {}, `${tuned.name}, ${tuned.type}`), math, h("p", { class: "source" }, `${tuned.source}.`), ...(tuned.note ? [h("p", { class: "field-hint" }, greek(sentence(tuned.note)))] : []));
  }

  bench.on(["found"], () => {
    tellKnown();
    void ask();
  });
  bench.on(["rules", "pick"], () => {
    list();
    tellChosen();
  });
  tellKnown();
  list();
  void ask();
}
