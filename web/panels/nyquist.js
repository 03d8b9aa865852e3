/** Nyquist plot, with the count Z = N + P written out. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */
/** @import {IndentationArc, NyquistPanel} from "../core/types.js" */

import { PLOT_HELP } from "../core/explain.js";
import { formatNumber, sentence } from "../core/format.js";
import { contourSketch } from "../components/contour-sketch.js";
import { h } from "../components/dom.js";
import { mountPlotPanel } from "../components/plot-panel.js";
import "../components/segmented-control.js";
import { createFigure } from "../plots/figure.js";
import { nyquistPlot } from "../plots/nyquist.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const choice = h("segmented-control", { label: "Part of the curve", class: "small" });
  choice.options = [
    { value: "near", label: "Near −1", title: "The neighbourhood of −1, where stability is decided" },
    { value: "whole", label: "Whole", title: "The whole curve" },
  ];
  choice.value = "near";

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
    note: () => (answers.panels.nyquist ? words(answers.panels.nyquist) : ""),
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

/** The count, Bode's criterion beside it, and the contour where it goes round poles. @param {NyquistPanel} nyquist */
function words(nyquist) {
  const { arcs, bode_criterion: bode } = nyquist;
  const verdict = bode.agrees === false ? "bad" : bode.applies ? "good" : "open";
  return h(
    "div",
    { class: "nyquist-note" },
    arcs.length > 0 ? contourSketch(arcs) : null,
    h(
      "div",
      {},
      h("p", {}, count(nyquist)),
      arcs.length > 0 ? h("p", {}, arcs.map(arcInWords).join(" ")) : null,
      h("p", { class: `bode-criterion ${verdict}` }, bode.explanation.replaceAll("-180 deg", "−180°").replaceAll("omega_180", "ω180").replaceAll("+-", "±")),
    ),
  );
}

/** @param {IndentationArc} arc */
function arcInWords({ omega, multiplicity, turn_deg }) {
  const where = omega === 0 ? `${multiplicity === 1 ? "The pole" : `${multiplicity} poles`} at the origin` : `${multiplicity === 1 ? "The pole" : `${multiplicity} poles`} at ±${formatNumber(omega)}i`;
  const each = omega === 0 ? "" : " each";
  return `${where}, passed on the right: L turns${each} ${turn_deg}° clockwise at infinity, drawn on the rim.`;
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
