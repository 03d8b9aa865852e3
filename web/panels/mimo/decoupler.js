/** The decoupler: none, gains, or transfer functions; what it is, and what of it cannot be built. */

/** @import {Api} from "../../core/api.js" */
/** @import {MimoStore} from "../../core/mimo/mimo.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { pairedRequest } from "../../core/mimo/mimo.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { formulaBlock } from "../../components/facts.js";
import "../../components/segmented-control.js";

/** @param {HTMLElement} host @param {MimoStore} store @param {Api} api */
export function mount(host, store, api) {
  const kind = h("segmented-control", { label: "Decoupler" });
  let offered = 0;
  kind.addEventListener("value-change", () => store.set({ decoupler: /** @type {import("../../core/mimo/mimo.js").MimoState["decoupler"]} */ (kind.value) }));
  const prediction = h("segmented-control", { label: "Where it would have to predict" });
  prediction.options = [
    { value: "drop", label: "do without", title: "do without: leave the prediction out" },
    { value: "wait", label: "wait", title: "wait: delay the other loop instead" },
  ];
  prediction.addEventListener("value-change", () => store.set({ prediction: prediction.value === "wait" ? "wait" : "drop" }));
  const predicting = h("div", { class: "row" }, h("span", { class: "field-label" }, "A prediction:"), prediction);
  const words = h("div", { class: "analysis-parts" });
  /** @type {import("../../core/workbench/analysis.js").Analysis<any> | null} */
  let analysis = null;

  function render() {
    const answer = analysis?.answer;
    if (!answer || answer.kind === "none") {
      words.replaceChildren(h("p", { class: "finding" }, "Every controller moves its own input only. Switch a decoupler on to let it move the other ones too, so that its loop leaves their outputs alone."));
      return;
    }
    const head = answer.kind === "static" ? "Right at rest: after a step the other outputs come back to where they were by the process itself; on the way there they still move." : answer.exact ? "Exact: nothing of one loop is left in the other." : "As near to exact as it can be built.";
    const matrix = answer.matrix.map((/** @type {any[]} */ row, /** @type {number} */ i) => h("div", { class: "mimo-decoupler-row" }, ...row.map((entry, k) => formulaBlock(`to the input of loop ${i + 1}, from controller ${k + 1}`, entry))));
    const problems = answer.elements.flatMap((/** @type {any} */ { name, ideal, problems: faults }) => (faults.length > 0 ? [h("div", {}, formulaBlock(`${name} as it should be`, ideal), h("p", { class: "finding warn" }, `It cannot be built: ${faults.join("; ")}.`))] : []));
    words.replaceChildren(h("p", { class: "finding" }, head), ...matrix, ...problems);
  }

  function show() {
    const state = store.get();
    if (offered !== state.loops.length) {
      offered = state.loops.length;
      kind.options = [
        { value: "none", label: "none" },
        { value: "static", label: "static", title: "static: gains, right at rest" },
        ...(offered === 2 ? [{ value: "dynamic", label: "dynamic", title: "dynamic: transfer functions, for two loops" }] : []),
      ];
    }
    kind.value = state.decoupler;
    prediction.value = state.prediction;
    predicting.hidden = state.decoupler !== "dynamic";
  }
  mountAnalysisPanel(
    host,
    /** @type {any} */ (store),
    {
      id: "mimo-decoupler",
      title: "Decoupler",
      help: "A decoupler moves the other inputs along with a controller, so that what they do to each other cancels. The loops then see other processes than before, and may want other settings. It needs a good model.",
      form: [kind, predicting],
      words: [words],
      render,
      table: () => (analysis?.answer?.matrix ? { header: ["to the input of loop", ...analysis.answer.matrix.map((/** @type {any} */ _, /** @type {number} */ k) => `from controller ${k + 1}`)], rows: analysis.answer.matrix.map((/** @type {any[]} */ row, /** @type {number} */ i) => [i + 1, ...row.map(({ text }) => text)]) } : null),
    },
    (onChange) => {
      analysis = createAnalysis(
        /** @type {any} */ (store),
        {
          request: () => {
            const { decoupler, prediction: how } = store.get();
            return decoupler === "none" ? { kind: "none" } : { ...pairedRequest(store.get()), kind: decoupler, prediction: how };
          },
          send: (/** @type {{kind: string}} */ request) => (request.kind === "none" ? Promise.resolve({ kind: "none" }) : api.analyse("mimo/decoupler", request)),
        },
        onChange,
      );
      return [analysis];
    },
  );
  store.subscribe(show);
  show();
}
