/** Nyquist plot, with the count Z = N + P written out. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {BodeCriterion, IndentationArc, NyquistPanel} from "../../core/types.js" */

import { PLOT_HELP } from "../../core/explain.js";
import { formatNumber, sentence } from "../../core/format.js";
import { contourSketch } from "../../components/contour-sketch.js";
import { h, setText } from "../../components/dom.js";
import { attachHint } from "../../components/hint.js";
import { mountPlotPanel } from "../../components/plot-panel.js";
import "../../components/segmented-control.js";
import { createFigure } from "../../plots/figure.js";
import { nyquistPlot } from "../../plots/nyquist.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const choice = h("segmented-control", { label: "Part of the curve", class: "small" });
  choice.options = [
    { value: "near", label: "Near −1", title: "The neighbourhood of −1, where stability is decided" },
    { value: "whole", label: "Whole", title: "The whole curve" },
  ];
  choice.value = "near";
  const note = createNote();

  const panel = mountPlotPanel(host, store, {
    id: "nyquist",
    title: "Nyquist",
    help: /** @type {string} */ (PLOT_HELP["nyquist"]),
    wants: ["nyquist", "margins"],
    figure: createFigure,
    controls: [choice],
    draw(theme, held) {
      const { nyquist, margins } = answers.panels;
      if (!nyquist) return null;
      const ghosts = store.snapshots.flatMap(({ panels }) => panels.nyquist ?? []);
      return nyquistPlot({ nyquist, margins: margins ?? null, whole: choice.value === "whole", ghosts }, theme, held);
    },
    note() {
      if (!answers.panels.nyquist) return "";
      note.show(answers.panels.nyquist);
      return note.root;
    },
    table() {
      const nyquist = answers.panels.nyquist;
      if (!nyquist) return null;
      return {
        header: [`ω [rad/${answers.time_unit}]`, "Re L", "Im L"],
        rows: Array.from(nyquist.omega, (w, i) => [w, nyquist.re[i] ?? null, nyquist.im[i] ?? null]),
      };
    },
    describe: () => `Nyquist curve of the open loop: ${answers.panels.nyquist?.explanation ?? ""} Gain margin ${formatNumber(answers.panels.margins?.GM)}.`,
  });
  choice.addEventListener("value-change", () => panel.redraw({ refit: true }));
  return panel.dispose;
}

/** The count, the arcs at infinity, and what Bode's criterion says: elements that stay, so that the focus stays too. */
function createNote() {
  const picture = h("span", { class: "contour" });
  const turns = h("p");
  const arcs = h("p", { class: "arcs" });
  const says = h("span");
  const reason = h("span", { class: "reason" });
  const criterion = h("button", { type: "button", class: "bode-criterion" }, says, reason);
  let explanation = "";
  const line = h("p", {}, criterion);
  const hint = attachHint(criterion, () => ({ title: "Bode’s criterion, and Nyquist’s", text: explanation }));
  const root = h("div", { class: "nyquist-note" }, picture, h("div", {}, turns, arcs, line));
  let drawn = "";
  return {
    root,
    /** @param {NyquistPanel} nyquist */
    show(nyquist) {
      const { bode_criterion: bode } = nyquist;
      const now = JSON.stringify(nyquist.arcs);
      if (now !== drawn) {
        picture.replaceChildren(nyquist.arcs.length > 0 ? contourSketch(nyquist.arcs) : "");
        setText(arcs, arcsInWords(nyquist.arcs));
        drawn = now;
      }
      turns.replaceChildren(count(nyquist));
      const [both, because] = verdicts(bode);
      setText(says, both);
      setText(reason, because);
      criterion.dataset["agrees"] = String(bode.agrees !== false);
      explanation = plain(bode.explanation).replaceAll("omega_180", "ω180");
      hint.describe();
    },
  };
}

const SAYS = { true: "stable", false: "unstable", null: "no verdict" };

/** Both verdicts, and after them why they differ, or why Bode's is no proof. @param {BodeCriterion} criterion @returns {[string, string]} */
function verdicts({ stable, nyquist_stable, applies, agrees, unmet }) {
  const both = `Bode: ${SAYS[`${stable}`]}, ${agrees === false ? "but " : ""}Nyquist: ${SAYS[`${nyquist_stable}`]}`;
  if (applies) return [both, "; Bode’s conditions are met"];
  return [both, `; Bode’s criterion does not apply: ${plain(unmet[0] ?? "")}`];
}

/** @param {string} text */
function plain(text) {
  return text.replaceAll("-180 deg", "−180°").replaceAll("+-", "±");
}

/** @param {IndentationArc[]} arcs */
function arcsInWords(arcs) {
  if (arcs.length === 0) return "";
  const each = arcs.map(({ omega, multiplicity, turn_deg }) => {
    const poles = multiplicity === 1 ? "pole" : `${multiplicity} poles`;
    return omega === 0 ? `${turn_deg}° ↻ for the ${poles} at 0` : `${turn_deg}° ↻ for the ${poles} at each of ±${formatNumber(omega)}i`;
  });
  return `Dashed on the rim, at infinity: ${each.join(", ")}.`;
}

/** Z = N + P with this loop's numbers, and what they count. @param {NyquistPanel} nyquist @returns {Node | string} */
function count({ N, P, Z, explanation }) {
  if (N === null || P === null || Z === null) return sentence(explanation);
  const turns = N === 0 ? "no turn" : `${Math.abs(N)} ${Math.abs(N) === 1 ? "turn" : "turns"} ${N > 0 ? "clockwise" : "counter-clockwise"}`;
  const poles = P === 0 ? "no pole" : `${P} ${P === 1 ? "pole" : "poles"}`;
  const line = h("span", {}, h("b", {}, `Z = N + P = ${formatInteger(N)} + ${P} = ${Z}`), `: ${turns} about −1, ${poles} of L in the right half plane`);
  return line;
}

/** @param {number} n */
function formatInteger(n) {
  return String(n).replace("-", "−");
}
