/** The steady states of the plant as it is set: where they are, whether they hold, and a start from each. */

/** @import {Api} from "../../core/api.js" */
/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {SteadyState} from "../../core/plant/types.js" */

import { formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { formatComplex } from "../../core/roots.js";
import { h } from "../../components/dom.js";
import { captioned, headRow, yesNo } from "../../components/facts.js";
import { mountPlantAnalysis } from "../../components/plant-analysis.js";

/** More states than this are no table: a column's profile is shown elsewhere. */
const MOST = 8;

/** @param {HTMLElement} host @param {PlantBench} bench @param {Api} api */
export function mount(host, bench, api) {
  const states = bench.model.states.slice(0, MOST);
  return mountPlantAnalysis(host, bench, {
    id: "plant-steady",
    title: "Steady states",
    help: "Where nothing changes: f(x, u) = 0 for the inputs and parameters as they are set. Newton's method starts from many places; the eigenvalues of the linear model there say whether the plant returns after a push.",
    action: "Find the steady states",
    figure: null,
    send: (request) => api.workOut(bench.model.id, "steady-states", request),
    request: () => ({}),
    words: (answer) => [answer.steady_states.length > 0 ? steadyTable(answer.steady_states) : h("p", {}, "There is no steady state in this range."), h("p", { class: "field-hint" }, sentence(answer.remark))],
    table: (answer) => ({
      header: [...states.map(({ name }) => name), "verdict", "kind", "eigenvalues"],
      rows: answer.steady_states.map((/** @type {SteadyState} */ { x, verdict, kind, eigenvalues }) => [...states.map(({ name }) => x[name] ?? null), verdict, kind, eigenvalues.map(([re, im]) => formatComplex([re, im])).join("; ")]),
    }),
    describe: (answer) => `${answer.steady_states.length} steady states.`,
  });

  /** @param {SteadyState[]} found */
  function steadyTable(found) {
    const rows = found.map(({ x, verdict, because, kind, eigenvalues, free }, i) =>
      h(
        "tr",
        {},
        ...states.map(({ name }) => h("td", {}, free.includes(name) ? "any" : formatWithUnit(x[name], bench.unit(name), 4))),
        h("td", {}, yesNo(verdict === "stable" ? true : verdict === "unstable" ? false : null, { yes: "stable", no: "unstable" }), " ", h("span", { title: because }, kind)),
        h("td", { class: "eigenvalues" }, eigenvalues.slice(0, MOST).map((value) => formatComplex(value)).join(", "), eigenvalues.length > MOST ? " …" : ""),
        h("td", {}, h("button", { type: "button", class: "button small", "aria-label": `Start the run from steady state ${i + 1}`, onclick: () => bench.startFrom(x) }, "Start here")),
      ),
    );
    return captioned(`At ${bench.inputs.map(({ name }) => `${name} = ${formatNumber(bench.setting.inputs[name])}`).join(", ")}; eigenvalues in 1/${bench.timeUnit}`, h("table", { class: "values" }, headRow([...states.map(({ name }) => name), "verdict", "eigenvalues", "run"]), h("tbody", {}, ...rows)));
  }
}
