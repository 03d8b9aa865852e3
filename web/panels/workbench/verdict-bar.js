/** The slim bar that stays in sight: stable or not, and the few numbers that say how well. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { MEANING } from "../../core/explain.js";
import { formatAbsent, formatFixed, formatNumber, sentence, UNDEFINED } from "../../core/format.js";
import { h, setText } from "../../components/dom.js";
import { attachHint } from "../../components/hint.js";
import { icon } from "../../components/icons.js";

/**
 * @typedef {object} Chip
 * @property {string} field
 * @property {string} label
 * @property {() => string} value
 * @property {() => string | null} reason
 */

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const margins = () => answers.panels.margins;
  const signal = () => store.get().view.signal;
  const metrics = () => answers.panels.metrics?.[signal()];

  /** @type {Chip[]} */
  const chips = [
    {
      field: "GM",
      label: "GM",
      value: () => (margins()?.GM == null ? formatAbsent(margins()?.reasons["GM"]) : `${formatNumber(margins()?.GM)} (${formatFixed(margins()?.GM_dB, 1)} dB)`),
      reason: () => margins()?.reasons["GM"] ?? null,
    },
    { field: "PM_deg", label: "PM", value: () => (margins()?.PM_deg == null ? formatAbsent(margins()?.reasons["PM_deg"]) : unit(formatFixed(margins()?.PM_deg, 1), "°", "")), reason: () => margins()?.reasons["PM_deg"] ?? null },
    { field: "Ms", label: "Ms", value: () => formatNumber(margins()?.Ms), reason: () => margins()?.reasons["Ms"] ?? null },
    {
      field: "overshoot_pct",
      label: "overshoot",
      value: () => unit(formatFixed(metrics()?.overshoot_pct, 1), "%"),
      reason: () => metrics()?.reasons["overshoot_pct"] ?? null,
    },
    {
      field: "t_settle",
      label: "settles in",
      value: () => unit(formatNumber(metrics()?.t_settle), answers.time_unit),
      reason: () => metrics()?.reasons["t_settle"] ?? null,
    },
    { field: "IAE", label: "IAE", value: () => formatNumber(metrics()?.IAE), reason: () => metrics()?.reasons["IAE"] ?? null },
  ];

  const mark = h("span", { class: "verdict-mark" });
  const word = h("strong", {}, "…");
  const because = h("span", { class: "verdict-because" });
  const verdict = h("button", { type: "button", class: "verdict" }, mark, word, because);
  const spoken = h("p", { class: "visually-hidden", role: "status" });
  const row = h("div", { class: "chips" }, h("span", { class: "chip-holder" }, verdict));
  const root = h("section", { class: "verdict-bar", "aria-label": "Verdict" }, row, spoken);
  host.append(root);
  attachHint(verdict, () => ({ title: answers.panels.verdict?.verdict ?? "…", text: MEANING["verdict"]?.text ?? "", more: sentence(answers.panels.verdict?.because) }));

  const views = chips.map((chip) => {
    const value = h("span", { class: "chip-value" });
    const button = h("button", { type: "button", class: `chip chip-${chip.field}` }, h("span", { class: "chip-label" }, chip.label), value);
    row.append(h("span", { class: "chip-holder" }, button));
    const hint = attachHint(button, () => {
      const { name = chip.label, text = "" } = MEANING[chip.field] ?? {};
      const of = ["overshoot_pct", "t_settle", "IAE"].includes(chip.field) ? ` (${signal()} step)` : "";
      return { title: name + of, text, more: noteOn(chip) };
    });
    return { chip, value, button, hint };
  });

  /** @param {Chip} chip */
  function noteOn({ field, value, reason }) {
    if (reason()) return sentence(reason());
    if (value() === UNDEFINED) return "It does not exist for this loop.";
    const { GM = null, closed_loop_stable = false } = margins() ?? {};
    return field === "GM" && GM !== null && GM < 1 && closed_loop_stable ? "Below 1 it is a lower limit: so far the gain may fall before the loop is lost." : null;
  }

  let shown = "";
  /** @param {boolean} moving */
  function show(moving) {
    const now = answers.panels.verdict;
    root.classList.toggle("stale", answers.error !== null);
    for (const { chip, value, button } of views) {
      const text = chip.value();
      setText(value, text);
      button.classList.toggle("undefined", text === UNDEFINED);
    }
    if (!now) return;
    if (shown !== now.verdict) {
      shown = now.verdict;
      mark.replaceChildren(icon(now.verdict));
      setText(word, now.verdict);
      verdict.dataset["verdict"] = now.verdict;
      verdict.classList.remove("stable", "unstable", "marginal");
      verdict.classList.add(now.verdict);
    }
    setText(because, sentence(now.because));
    if (moving) return;
    for (const { hint } of views) hint.describe();
    const summary = views.slice(0, 4).map(({ chip }) => `${MEANING[chip.field]?.name ?? chip.label} ${chip.value()}`);
    setText(spoken, `${now.verdict}. ${summary.join(", ")}.`);
  }

  const release = answers.want(["verdict", "margins", "metrics"]);
  const stopAnswers = answers.subscribe(({ moving }) => show(moving));
  const stopView = store.subscribe((_, change) => {
    if (change.view) show(false);
  });
  show(false);
  return () => {
    release();
    stopAnswers();
    stopView();
    root.remove();
  };
}

/** @param {string} text @param {string} name @param {string} [gap] */
function unit(text, name, gap = "\u202f") {
  return text === UNDEFINED ? text : `${text}${gap}${name}`;
}
