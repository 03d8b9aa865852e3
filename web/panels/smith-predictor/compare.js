/** The three loops in numbers, how the predictor was tuned, and what it cannot do. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {SmithAnswer, SmithRow, SmithState} from "../../core/design/smith.js" */

import { formatAbsent, formatFixed, formatNumber, greek, sentence, UNDEFINED } from "../../core/format.js";
import { LOOPS, pctOf } from "../../core/design/smith.js";
import { mountDesignPanel } from "../../components/design-panel.js";
import { h } from "../../components/dom.js";
import { captioned, headRow, yesNo } from "../../components/facts.js";

const HELP =
  "All three loops have the same Ms where the model is right: that is what makes them comparable. PI and PID have the smallest IAE after a load within that Ms; the predictor's PI is SIMC's for the model without its dead time, as fast as the same Ms allows. The tolerances tell how far gain or dead time alone may move from here.";

/** @typedef {{label: string, of: (row: SmithRow) => Node | string}} Line */

/** @param {number | null | undefined} value @param {string | undefined} reason @param {(value: number) => string} [write] */
const figure = (value, reason, write = (v) => formatNumber(v)) => (value == null ? formatAbsent(reason) : write(value));

/** A stretch of factors in per cent. @param {SmithRow} row @param {"K" | "theta"} axis */
function stretchText({ closed_loop_stable: stable, tolerates }, axis) {
  const stretch = tolerates?.[axis];
  if (!stretch) return stable ? UNDEFINED : "none";
  const [low, high] = stretch;
  const pct = (/** @type {number} */ factor) => `${pctOf(factor) >= 0 ? "+" : ""}${formatFixed(pctOf(factor), 0)}`;
  if (high >= FARTHEST) return low <= LOWEST ? "any" : `>\u202f${pct(low)}`;
  return low <= LOWEST ? `<\u202f${pct(high)}` : `${pct(low)} … ${pct(high)}`;
}
/** The ends of what the server looks at. */
const FARTHEST = 10;
const LOWEST = 2e-3;

/** @type {Line[]} */
const LINES = [
  { label: "Stable", of: ({ closed_loop_stable: stable }) => yesNo(stable) },
  { label: "Kc", of: ({ controller }) => formatNumber(controller?.Kc) },
  { label: "τI [s]", of: ({ controller }) => formatNumber(controller?.tau_I) },
  { label: "τD [s]", of: ({ controller }) => formatNumber(controller?.tau_D || null) },
  { label: "Ms, no mismatch", of: ({ Ms_nominal }) => formatNumber(Ms_nominal) },
  { label: "Ms on this plant", of: ({ margins }) => figure(margins?.["Ms"], margins?.reasons["Ms"]) },
  { label: "Gain margin", of: ({ margins }) => figure(margins?.["GM"], margins?.reasons["GM"]) },
  { label: "Phase margin", of: ({ margins }) => figure(margins?.["PM_deg"], margins?.reasons["PM_deg"], (v) => `${formatFixed(v, 1)}°`) },
  { label: "Delay margin [s]", of: ({ margins }) => figure(margins?.["delay_margin"], margins?.reasons["delay_margin"]) },
  { label: "IAE, setpoint", of: ({ setpoint }) => figure(setpoint?.["IAE"], setpoint?.reasons["IAE"]) },
  { label: "IAE, load", of: ({ load }) => figure(load?.["IAE"], load?.reasons["IAE"]) },
  { label: "Gain may be [%]", of: (row) => stretchText(row, "K") },
  { label: "Dead time may be [%]", of: (row) => stretchText(row, "theta") },
];

/** @param {HTMLElement} host @param {DesignBench<SmithState, SmithAnswer>} bench */
export function mount(host, bench) {
  /** @param {HTMLElement} words */
  function show(words) {
    const { answer } = bench;
    if (!answer) return;
    const { rows, notes, tuning } = answer;
    const valid = rows.filter((row) => row.valid);
    const table = h(
      "table",
      { class: "values smith-table" },
      headRow(["", ...valid.map(({ name }) => LOOPS[name].label)]),
      h("tbody", {}, ...LINES.map(({ label, of }) => h("tr", {}, h("th", { scope: "row" }, label), ...valid.map((row) => h("td", {}, of(row)))))),
    );
    words.replaceChildren(
      ...notes.map((text) => h("p", { class: "design-note" }, greek(text))),
      captioned("On the plant as it is", table),
      ...rows.filter(({ reason }) => reason).map(({ name, reason }) => h("p", { class: "finding" }, `${LOOPS[name].label}: ${sentence(reason)}`)),
      h("p", { class: "finding" }, h("b", {}, "Inside the predictor: "), greek(sentence(tuning.how))),
    );
  }
  mountDesignPanel(host, bench, {
    id: "smith-compare",
    title: "Three loops",
    help: HELP,
    figure: null,
    words: show,
    table() {
      if (!bench.answer) return null;
      const { rows } = bench.answer;
      const written = (/** @type {Node | string} */ cell) => (typeof cell === "string" ? cell : (cell.textContent ?? ""));
      return { header: ["", ...rows.map(({ name }) => LOOPS[name].label)], rows: LINES.map(({ label, of }) => [label].concat(rows.map((row) => written(of(row))))) };
    },
  });
}
