/** The design in numbers: the law, its gains, its poles and what they cost, and the margins at the plant's input. */

/** @import {FeedbackSession} from "../../core/state-feedback/session.js" */

import { polesText, written } from "../../core/state-feedback/feedback.js";
import { formatFixed, formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { h } from "../../components/dom.js";
import { matrixBlock, valueTable } from "../../components/facts.js";

/** @param {HTMLElement} host @param {FeedbackSession} session */
export function mount(host, session) {
  const body = h("div", { class: "feedback-numbers" });
  host.append(h("section", { class: "feedback-card", "aria-label": "The design in numbers" }, h("h2", {}, "The law"), body));

  return {
    refresh() {
      const { design, state } = session;
      if (!design) return;
      const { margins, feedback, observer } = design;
      const x = design.observer ? "x̂" : "x";
      const integral = design.K_I ? [" + K", h("sub", {}, "I"), " ∫(r − y) dt"] : [design.N ? " + N (r − y₀)" : ""];
      const rows = [
        ["Poles of the plant", polesText(design.poles)],
        ["Poles under feedback", polesText(feedback.obtained)],
        ...(observer ? [["Poles of the observer", polesText(observer.obtained)]] : []),
        ...(feedback.error !== null ? [["Poles missed by", formatNumber(feedback.error, 2)]] : []),
        ...(feedback.condition !== null ? [["Condition of the eigenvectors", formatNumber(feedback.condition)]] : []),
      ];
      const robust = margins
        ? [
            ["Phase margin", margins.PM_deg === null ? sentence(margins.reasons["PM_deg"]) : `${formatFixed(margins.PM_deg, 1)}°`],
            ["Gain margin", margins.GM === null ? sentence(margins.reasons["GM"]) : `${formatNumber(margins.GM)}${margins.GM < 1 ? ", downward" : ""}`],
            ["Delay it bears", margins.delay_margin === null ? sentence(margins.reasons["delay_margin"]) : formatWithUnit(margins.delay_margin, design.time_unit)],
            ["Ms", margins.Ms === null ? sentence(margins.reasons["Ms"]) : formatNumber(margins.Ms)],
          ]
        : [["Margins", sentence(design.margins_reason)]];
      const lesson =
        state.method === "lqr" && !state.observer && margins
          ? "A regulator that sees every state keeps at least 60° of phase margin. Measure outputs only, and watch it go."
          : state.observer && margins
            ? "Poles of feedback and observer do not disturb each other, but the margins pay for what is not measured."
            : "Drag the poles left: the catch gets faster, the gains and the force grow.";
      body.replaceChildren(
        h("p", { class: "feedback-law" }, `u = u₀ − K (${x} − x₀)`, ...integral),
        h("p", { class: "field-hint" }, `x = (${design.states.map(({ name }) => written(name)).join(", ")})`),
        h("div", { class: "matrices" }, matrixBlock("K", design.K), ...(design.K_I ? [matrixBlock("K_I", design.K_I)] : []), ...(design.N ? [matrixBlock("N", design.N)] : []), ...(design.L ? [matrixBlock("L", design.L)] : [])),
        ...(design.N_reason ? [h("p", { class: "finding" }, sentence(design.N_reason))] : []),
        h("div", { class: "feedback-tables" }, valueTable(`Where the poles are, in 1/${design.time_unit}`, ["", ""], rows), valueTable("Where the input enters the plant", ["", ""], robust)),
        h("p", { class: "feedback-lesson" }, lesson),
      );
    },
  };
}
