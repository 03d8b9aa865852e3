/**
 * An analysis on the stage: its form, what it found in words and tables, and beside that a plot where there is one.
 * Tied to the analyses it shows, not to the answers about the loop. What went wrong, and what to do, stands in it.
 */

/** @import {Analysis} from "../core/workbench/analysis.js" */
/** @import {Store} from "../core/store.js" */
/** @import {Figure, Ranges, Table, Theme} from "../core/types.js" */
/** @import {FigureLike, LegendItem} from "./panel-frame.js" */

import { sentence } from "../core/format.js";
import { h, setText } from "./dom.js";
import { createPanelFrame } from "./panel-frame.js";
import { onThemeChange, readTheme } from "./theme.js";

/**
 * @typedef {object} AnalysisPanelOptions
 * @property {string} id
 * @property {string} title
 * @property {string} help
 * @property {HTMLElement[]} [controls]
 * @property {Node[]} form
 * @property {Node[]} words
 * @property {((element: HTMLElement) => FigureLike) | null} [figure]
 * @property {() => string} [subject]  what the axes belong to: another one has axes of its own
 * @property {() => void} render  puts what was found into the words
 * @property {(theme: Theme, held: {ranges: Ranges, moving: boolean}) => Figure | null} [draw]
 * @property {() => boolean} [awaited]  the plot is still to come: its room is kept
 * @property {() => Table | null} table
 * @property {() => string} [describe]
 * @property {() => LegendItem[]} [legend]
 * @property {() => (Node | string)} [note]
 * @property {boolean} [live]  the plot shows settings of the loop: drawn again, from what is known, while they move
 */

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {AnalysisPanelOptions} options
 * @param {(onChange: () => void) => Analysis<any>[]} start  asks; the first analysis is the one that the panel is about
 */
export function mountAnalysisPanel(host, store, options, start) {
  const message = h("p", { class: "analysis-message", role: "status" }, "Computing…");
  const plotPlace = h("div", { class: "analysis-plot" });
  const content = h("div", { class: "analysis-content", hidden: true }, h("div", { class: "analysis-words" }, ...options.words));
  const frame = createPanelFrame(host, {
    ...options,
    figure: options.figure ?? null,
    arrange({ header, body, note }) {
      if (!options.figure) return [header, h("div", { class: "analysis-form" }, ...options.form), message, content, note];
      plotPlace.append(body, note);
      content.append(plotPlace);
      return [header, h("div", { class: "analysis-form" }, ...options.form), message, content];
    },
  });
  frame.root.classList.add("analysis");
  /** @type {Ranges} */
  let ranges = {};
  let theme = readTheme();
  let drawnFor = "";

  /** @param {boolean} moving */
  function draw(moving) {
    const subject = options.subject?.() ?? "";
    if (!moving && subject !== drawnFor) {
      ranges = {};
      drawnFor = subject;
    }
    const next = options.draw?.(theme, { ranges, moving }) ?? null;
    const room = next !== null || (options.awaited?.() ?? false);
    plotPlace.hidden = !room;
    content.classList.toggle("no-plot", !room);
    if (next) {
      ranges = next.ranges;
      frame.show(next, moving);
    }
    if (moving) return;
    frame.note(options.note?.() ?? "");
    frame.tell(options.describe?.() ?? "", next ? (options.legend?.() ?? []) : []);
  }

  function show() {
    const [main] = analyses;
    const error = analyses.find((analysis) => analysis.error)?.error ?? null;
    setText(message, error ? [error.message, error.hint].map(sentence).filter(Boolean).join(" ") : main?.answer ? "" : "Computing…");
    message.classList.toggle("wrong", error !== null);
    message.hidden = error === null && Boolean(main?.answer);
    frame.root.classList.toggle("stale", Boolean(main?.error));
    content.hidden = !main?.answer;
    if (!main?.answer) return;
    const focused = content.contains(document.activeElement);
    options.render();
    draw(false);
    // What had the focus may be gone, a used-up button say: it stays with the panel.
    if (focused && !content.contains(document.activeElement)) {
      const heading = frame.root.querySelector("h2");
      heading?.setAttribute("tabindex", "-1");
      heading?.focus({ preventScroll: true });
    }
  }

  /** @type {Analysis<any>[]} */
  let analyses = [];
  analyses = start(() => show());
  show();

  const stopTheme = onThemeChange(() => {
    theme = readTheme();
    if (!content.hidden) draw(false);
  });
  const stopMoving = store.subscribe((_, { moving, design }) => {
    if (options.live && design && !content.hidden) draw(moving);
  });
  return {
    redraw: show,
    dispose() {
      stopTheme();
      stopMoving();
      for (const analysis of analyses) analysis.dispose();
      frame.dispose();
    },
  };
}
