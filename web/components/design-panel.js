/** A panel of a design page: drawn again when the answer comes, from what is known while something moves. */

/** @import {DesignBench} from "../core/design/bench.js" */
/** @import {Figure, Ranges, Table, Theme} from "../core/types.js" */
/** @import {FigureLike, LegendItem} from "./panel-frame.js" */

import { h } from "./dom.js";
import { createPanelFrame } from "./panel-frame.js";
import { onThemeChange, readTheme } from "./theme.js";

/**
 * @typedef {object} DesignPanelOptions
 * @property {string} id
 * @property {string} title
 * @property {string} help
 * @property {((element: HTMLElement) => FigureLike) | null} figure
 * @property {HTMLElement[]} [controls]
 * @property {(theme: Theme, held: {ranges: Ranges, moving: boolean}) => Figure | null} [draw]
 * @property {() => string} [subject]  what the axes belong to: another one has axes of its own
 * @property {() => Table | null} table
 * @property {() => string} [describe]
 * @property {() => LegendItem[]} [legend]
 * @property {() => Node | string} [note]
 * @property {(words: HTMLElement, moving: boolean) => void} [words]  below the plot, or alone
 * @property {boolean} [live]  drawn already while the state moves, before the answer
 */

/**
 * @param {HTMLElement} host
 * @param {DesignBench<any, any>} bench
 * @param {DesignPanelOptions} options
 */
export function mountDesignPanel(host, bench, options) {
  const words = h("div", { class: "design-words" });
  const frame = createPanelFrame(host, { ...options, arrange: ({ header, body, note }) => [header, ...(options.figure ? [body] : []), words, note] });
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  let subject = "";

  /** @param {boolean} moving */
  function draw(moving) {
    const now = options.subject?.() ?? "";
    if (now !== subject && !moving) {
      ranges = {};
      subject = now;
    }
    const figure = options.draw?.(theme, { ranges, moving }) ?? null;
    if (figure) {
      ranges = figure.ranges;
      frame.show(figure, moving);
    }
    options.words?.(words, moving);
    if (moving) return;
    frame.note(options.note?.() ?? "");
    frame.tell(options.describe?.() ?? options.title, options.legend?.() ?? []);
  }

  bench.subscribe(({ moving, what }) => {
    frame.root.classList.toggle("stale", bench.error !== null && bench.answer !== null && !options.live);
    if (what === "error" && !bench.answer) frame.note("Nothing to show: the message at the settings says why.");
    if (what === "answer" || options.live || (what === "state" && !moving)) draw(moving);
  });
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });
  draw(false);
  return { root: frame.root, redraw: () => draw(false) };
}
