/** Root locus in the controller gain, with the closed-loop poles of now on it. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */
/** @import {Complex} from "../core/types.js" */

import { PLOT_HELP } from "../core/explain.js";
import { formatNumber, sentence } from "../core/format.js";
import { mountPlotPanel } from "../components/plot-panel.js";
import { createFigure } from "../plots/figure.js";
import { rootLocusPlot } from "../plots/root_locus.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  const panel = mountPlotPanel(host, store, {
    id: "root_locus",
    title: "Root locus",
    help: /** @type {string} */ (PLOT_HELP["root_locus"]),
    wants: ["root_locus", "poles"],
    figure: createFigure,
    draw(theme, held) {
      const { root_locus: locus, poles } = answers.panels;
      if (!poles) return null;
      return rootLocusPlot({ locus: locus?.available ? locus : null, poles }, theme, held);
    },
    legend: () => [
      { signal: "pole", glyph: "■", label: "now", name: "closed-loop poles at the gain set" },
      { signal: "r", glyph: "×", label: "poles", name: "open-loop poles, where the branches begin" },
      { signal: "r", glyph: "○", label: "zeros", name: "open-loop zeros, where branches end" },
    ],
    note() {
      const { root_locus: locus, poles } = answers.panels;
      const notes = [];
      if (locus && !locus.available && locus.reason) notes.push(sentence(locus.reason));
      if (poles && !poles.complete && poles.reason) notes.push(sentence(poles.reason));
      return notes.join(" ");
    },
    table() {
      const { root_locus: locus, poles } = answers.panels;
      if (!poles) return null;
      const now = poles.poles.map(([re, im]) => ["closed-loop pole", re, im, null]);
      const fixed = /** @type {[string, Complex[]][]} */ ([
        ["open-loop pole", locus?.open_loop_poles ?? []],
        ["open-loop zero", locus?.open_loop_zeros ?? []],
      ]).flatMap(([name, points]) => points.map(([re, im]) => [name, re, im, null]));
      const branches = (locus?.branches ?? []).flatMap(({ first, re, im }, n) =>
        Array.from(re, (value, i) => [`branch ${n + 1}`, value, im[i] ?? null, locus?.gains[first + i] ?? null]),
      );
      return { header: ["what", "Re s", "Im s", "Kc"], rows: [...now, ...fixed, ...branches] };
    },
    describe() {
      const poles = answers.panels.poles?.poles ?? [];
      const places = poles.slice(0, 6).map(([re, im]) => `${formatNumber(re)}${im === 0 ? "" : ` ${im < 0 ? "−" : "+"} ${formatNumber(Math.abs(im))}i`}`);
      return `Root locus. Closed-loop poles now: ${places.join(", ")}.`;
    },
  });
  return panel.dispose;
}
