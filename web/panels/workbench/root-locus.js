/** Root locus in the controller gain, with the closed-loop poles of now on it; zoomed in, as the server sees it there. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {Ranges, RootLocusPanel} from "../../core/types.js" */
/** @import {CloseUp} from "../../plots/root_locus.js" */

import { PLOT_HELP } from "../../core/explain.js";
import { formatNumber, sentence } from "../../core/format.js";
import { locusTable } from "../../core/workbench/locus-table.js";
import { loopOf } from "../../core/workbench/loop.js";
import { createTransport } from "../../core/transport.js";
import { mountPlotPanel } from "../../components/plot-panel.js";
import { createFigure } from "../../plots/figure.js";
import { rootLocusPlot } from "../../plots/root_locus.js";

/** A window this much smaller than the whole picture is worth the server's closer look. */
const CLOSER = 0.8;
/** Beyond what is shown, in widths of it, so that a little panning shows no end. */
const AROUND = 0.25;

/** @typedef {{re: [number, number], im: [number, number]}} View */
/** @typedef {{key: string, view: View, positive: CloseUp | null, negative: CloseUp | null}} Seen */

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const { answers } = store;
  /** Gives the locus for K < 0 back; null while it is off. @type {(() => void) | null} */
  let negating = null;
  /** What the student has zoomed in to. @type {View | null} */
  let zoom = null;
  /** What the server has shown of it. @type {Seen | null} */
  let seen = null;
  /** What was asked for last. */
  let asked = "";

  /** @param {RootLocusPanel | undefined} locus */
  const drawable = (locus) => (locus?.available ? locus : null);
  const positive = () => drawable(answers.panels.root_locus);
  const negative = () => (negating ? drawable(answers.panels.root_locus_negative) : null);
  const keyNow = () => `${positive()?.key} ${negative()?.key}`;

  const closer = createTransport({
    /** @param {{key: string, view: View, loop: object, both: boolean}} wish @returns {Promise<Seen>} */
    async send({ key, view, loop, both }) {
      // The gain of the controller sets the sign of K: with a negative one, K > 0 is the other locus of L.
      const ask = (/** @type {"positive" | "negative"} */ gains) => api.rootLocus({ loop, gains, view });
      const direct = store.get().controller.action === "direct";
      const [one, other] = await Promise.all([ask(direct ? "negative" : "positive"), both ? ask(direct ? "positive" : "negative") : null]);
      return { key, view, positive: one, negative: other };
    },
    onAnswer(answer) {
      seen = answer;
      panel.redraw();
    },
    // What cannot be looked at closely is seen from afar.
    onError: () => {},
    retryAfter: (error) => error?.retryAfter ?? null,
  });

  /** Asks for what is zoomed in to, unless that is what is shown already. */
  function lookCloser() {
    if (!zoom || !positive()) {
      seen = null;
      asked = "";
      return;
    }
    const wish = { key: keyNow(), view: widened(zoom), loop: loopOf(store.get()), both: negative() !== null };
    if (asked === JSON.stringify([wish.key, wish.view])) return;
    asked = JSON.stringify([wish.key, wish.view]);
    closer.push(wish);
  }

  const panel = mountPlotPanel(host, store, {
    id: "root_locus",
    title: "Root locus",
    help: /** @type {string} */ (PLOT_HELP["root_locus"]),
    wants: ["root_locus", "poles"],
    figure(element) {
      const figure = createFigure(element);
      figure.onZoom(zoomed);
      return figure;
    },
    draw(theme, held) {
      const { poles } = answers.panels;
      if (!poles) return null;
      if (!held.moving) lookCloser();
      const close = seen?.key === keyNow() ? seen : null;
      return rootLocusPlot({ locus: positive(), negative: negative(), closeUp: close?.positive ?? null, negativeCloseUp: close?.negative ?? null, poles }, theme, held);
    },
    legend: () => [
      { signal: "pole", glyph: "■", label: "now", name: "closed-loop poles at the gain set" },
      { signal: "r", glyph: "×", label: "poles", name: "open-loop poles, where the branches begin" },
      { signal: "r", glyph: "○", label: "zeros", name: "open-loop zeros, where branches end" },
      { signal: "locus-negative", label: "K < 0", name: "the locus for gains of the other sign", dash: "dash", on: negating !== null, toggle: toggleNegative },
    ],
    note() {
      const { root_locus: locus, root_locus_negative: other, poles } = answers.panels;
      const notes = [];
      if (locus && !locus.available && locus.reason) notes.push(sentence(locus.reason));
      if (negating && other && !other.available && other.reason) notes.push(sentence(other.reason));
      if (poles && !poles.complete && poles.reason) notes.push(sentence(poles.reason));
      return notes.join(" ");
    },
    table: () => (answers.panels.poles ? locusTable(answers.panels.poles, positive(), negative()) : null),
    describe() {
      const poles = answers.panels.poles?.poles ?? [];
      const places = poles.slice(0, 6).map(([re, im]) => `${formatNumber(re)}${im === 0 ? "" : ` ${im < 0 ? "−" : "+"} ${formatNumber(Math.abs(im))}i`}`);
      return `Root locus. Closed-loop poles now: ${places.join(", ")}.`;
    },
  });

  /** @param {Ranges} ranges */
  function zoomed({ xaxis, yaxis }) {
    const whole = positive()?.view;
    if (!xaxis || !yaxis || !whole) return;
    const small = xaxis[1] - xaxis[0] < CLOSER * (whole.re[1] - whole.re[0]) || yaxis[1] - yaxis[0] < CLOSER * (whole.im[1] - whole.im[0]);
    const next = small ? { re: xaxis, im: yaxis } : null;
    if (JSON.stringify(next) === JSON.stringify(zoom)) return;
    zoom = next;
    panel.redraw();
  }

  function toggleNegative() {
    negating?.();
    negating = negating ? null : answers.want(["root_locus_negative"]);
    panel.redraw();
  }

  return () => {
    closer.close();
    negating?.();
    panel.dispose();
  };
}

/** @param {View} view @returns {View} */
function widened({ re, im }) {
  const wider = (/** @type {[number, number]} */ [low, high]) => /** @type {[number, number]} */ ([low - AROUND * (high - low), high + AROUND * (high - low)]);
  return { re: wider(re), im: wider(im) };
}
