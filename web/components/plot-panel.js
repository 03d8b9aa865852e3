/** A plot of the loop: a panel tied to a store's answers. The panel itself says only what to draw. */

/** @import {Store} from "../core/store.js" */
/** @import {Figure, PanelName, Ranges, Table, Theme} from "../core/types.js" */
/** @import {FigureLike, LegendItem} from "./panel-frame.js" */

import { createPanelFrame } from "./panel-frame.js";
import { onThemeChange, readTheme } from "./theme.js";

/**
 * @typedef {object} PlotPanelOptions
 * @property {string} id
 * @property {string} title
 * @property {string} help
 * @property {PanelName[]} wants
 * @property {(element: HTMLElement) => FigureLike} figure
 * @property {(theme: Theme, held: {ranges: Ranges, moving: boolean}) => Figure | null} draw  null while there is nothing to draw
 * @property {() => Table | null} table
 * @property {() => string} describe  the plot in a sentence, for those who cannot see it
 * @property {() => LegendItem[]} [legend]
 * @property {() => (Node | string)} [note]
 * @property {HTMLElement[]} [controls]  beside the heading
 */

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {PlotPanelOptions} options
 */
export function mountPlotPanel(host, store, options) {
  const frame = createPanelFrame(host, options);
  /** @type {Ranges} */
  let ranges = {};
  let theme = readTheme();
  let drawnPlant = "";

  /** @param {boolean} moving */
  function draw(moving) {
    const { plant } = store.get();
    const named = plant.type === "expr" ? plant.text : plant.type === "ss" ? JSON.stringify(plant) : plant.type;
    // Another plant has axes of its own; they hold only while the same one is tuned.
    if (!moving && named !== drawnPlant && store.answers.error === null) {
      ranges = {};
      drawnPlant = named;
    }
    const next = options.draw(theme, { ranges, moving });
    frame.root.classList.toggle("stale", store.answers.error !== null);
    if (!next) return;
    ranges = next.ranges;
    frame.show(next, moving);
    frame.note(options.note?.() ?? "");
    if (!moving) frame.tell(options.describe(), options.legend?.() ?? []);
  }

  const release = store.answers.want(options.wants);
  const stopAnswers = store.answers.subscribe(({ moving }) => draw(moving));
  const stopView = store.subscribe((_, change) => {
    if (change.view) draw(false);
  });
  const stopTheme = onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });
  draw(false);

  return {
    root: frame.root,
    /** Draws again, for what is no matter of the store. @param {{refit?: boolean}} [how] */
    redraw({ refit = false } = {}) {
      if (refit) ranges = {};
      draw(false);
    },
    dispose() {
      release();
      stopAnswers();
      stopView();
      stopTheme();
      frame.dispose();
    },
  };
}

