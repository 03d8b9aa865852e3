/**
 * What every plot panel is made of: heading, legend, help, data menu, the plot, and a line below it, tied to a
 * store's answers. The panel itself says only what to draw.
 */

/** @import {Store} from "../core/store.js" */
/** @import {Figure, PanelName, Ranges, Table, Theme} from "../core/types.js" */

import { toCsv } from "../core/csv.js";
import { dataTable, download } from "./data-table.js";
import { h, set, setText } from "./dom.js";
import { attachHint } from "./hint.js";
import { icon } from "./icons.js";
import { attachMenu } from "./menu.js";
import { onThemeChange, readTheme } from "./theme.js";

/**
 * What plots/figure.js makes; handed in, so that components know no plot.
 * @typedef {object} FigureLike
 * @property {(figure: Figure, options?: {moving?: boolean}) => void} show
 * @property {() => void} resetZoom
 * @property {(filename: string) => Promise<void>} saveImage
 * @property {() => void} dispose
 */

/** @typedef {{signal: string, label: string, name: string, dash?: string, glyph?: string, on?: boolean, toggle?: () => void}} LegendItem */

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
  const { id, title, help } = options;
  const plot = h("div", { class: "plot", role: "img", "aria-label": title });
  const note = h("div", { class: "panel-note" });
  const legend = h("ul", { class: "legend", "aria-label": `Curves of ${title}` });
  const tableButton = h("button", { type: "button", class: "icon-button", "aria-pressed": "false", "aria-label": `Numbers of ${title} as a table`, title: "Numbers" }, icon("table"));
  const moreButton = h("button", { type: "button", class: "icon-button", "aria-label": `More for ${title}`, title: "More" }, icon("more"));
  const helpButton = h("button", { type: "button", class: "icon-button", "aria-label": `How to read ${title}` }, icon("help"));
  const expandButton = h("button", { type: "button", class: "icon-button expand", "aria-label": `Enlarge ${title}`, title: "Enlarge" }, icon("expand"));
  const tools = h("div", { class: "panel-tools" }, helpButton, tableButton, moreButton, expandButton);
  const body = h("div", { class: "panel-body" }, plot);
  const root = h(
    "section",
    { class: "panel", id: `panel-${id}`, "aria-label": title },
    h("header", { class: "panel-header" }, h("h2", {}, title), legend, h("span", { class: "panel-controls" }, ...(options.controls ?? [])), tools),
    body,
    note,
  );
  host.append(root);

  const figure = options.figure(plot);
  /** @type {Ranges} */
  let ranges = {};
  let theme = readTheme();
  /** @type {HTMLElement | null} */
  let table = null;
  let drawnPlant = "";

  /** @param {boolean} moving */
  function draw(moving) {
    const { plant } = store.get();
    const named = plant.type === "expr" ? plant.text : plant.type;
    // Another plant has axes of its own; they hold only while the same one is tuned.
    if (!moving && named !== drawnPlant && store.answers.error === null) {
      ranges = {};
      drawnPlant = named;
    }
    const next = options.draw(theme, { ranges, moving });
    root.classList.toggle("stale", store.answers.error !== null);
    if (!next) return;
    ranges = next.ranges;
    figure.show(next, { moving });
    const text = options.note?.() ?? "";
    if (typeof text === "string") setText(note, text);
    else if (note.firstChild !== text) note.replaceChildren(text);
    if (moving) return;
    set(plot, { "aria-label": options.describe() });
    showLegend();
    if (table) showTable();
  }

  function showLegend() {
    const items = options.legend?.() ?? [];
    // Rebuilt only when it changes: a legend button must keep the focus it has.
    const now = JSON.stringify(items);
    if (legend.dataset["shown"] === now) return;
    legend.dataset["shown"] = now;
    const focused = [...legend.querySelectorAll("button")].indexOf(/** @type {any} */ (document.activeElement));
    legend.replaceChildren(...items.map(legendItem));
    if (focused >= 0) legend.querySelectorAll("button")[focused]?.focus();
  }

  function showTable() {
    const data = options.table();
    const next = data ? dataTable(data, `Numbers of ${title}`) : null;
    if (table && next) {
      const top = table.scrollTop;
      table.replaceWith(next);
      next.scrollTop = top;
    } else if (next) body.append(next);
    table = next;
  }

  tableButton.addEventListener("click", () => {
    const on = tableButton.getAttribute("aria-pressed") !== "true";
    tableButton.setAttribute("aria-pressed", String(on));
    root.classList.toggle("with-table", on);
    if (on) showTable();
    else {
      table?.remove();
      table = null;
    }
  });
  expandButton.addEventListener("click", () => root.dispatchEvent(new CustomEvent("panel-expand", { bubbles: true, detail: { id } })));
  attachHint(helpButton, () => ({ title, text: help }));
  attachMenu(moreButton, [
    { label: "Download numbers", detail: "CSV, for a spreadsheet", run: () => { const data = options.table(); if (data) download(`looplab-${id}.csv`, toCsv(data)); } },
    { label: "Save picture", detail: "SVG, for a report", run: () => void figure.saveImage(`looplab-${id}`) },
    { label: "Reset zoom", detail: "Drag in the plot to zoom in", run: () => figure.resetZoom() },
  ]);

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
    root,
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
      figure.dispose();
      root.remove();
    },
  };
}

/** @param {LegendItem} item @returns {HTMLElement} */
function legendItem({ signal, label, name, dash, glyph, on = true, toggle }) {
  const swatch = glyph ? h("span", { class: "glyph", "aria-hidden": "true" }, glyph) : h("span", { class: `swatch ${dash ?? "solid"}`, "aria-hidden": "true" });
  swatch.style.setProperty("--swatch", `var(--signal-${signal})`);
  const words = [swatch, h("span", { class: glyph ? "" : "legend-label" }, label)];
  if (!toggle) return h("li", { title: name }, ...words, h("span", { class: "visually-hidden" }, `: ${name}`));
  return h("li", {}, h("button", { type: "button", class: "legend-toggle", "aria-pressed": String(on), title: name, "aria-label": `${label}: ${name}`, onclick: toggle }, ...words));
}
