/**
 * What every panel of the stage is made of: heading, legend, help, data menu, and mostly a plot with its numbers as
 * a table. Who uses it says what is in them and when.
 */

/** @import {Figure, Table} from "../core/types.js" */

import { toCsv } from "../core/csv.js";
import { dataTable, download } from "./data-table.js";
import { h, set, setText } from "./dom.js";
import { attachHint } from "./hint.js";
import { icon } from "./icons.js";
import { attachMenu } from "./menu.js";

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
 * @typedef {object} FrameOptions
 * @property {string} id
 * @property {string} title
 * @property {string} help
 * @property {((element: HTMLElement) => FigureLike) | null} figure  null for a panel of words and tables
 * @property {() => Table | null} table
 * @property {HTMLElement[]} [controls]  beside the heading
 * @property {(parts: {header: HTMLElement, body: HTMLElement, note: HTMLElement}) => Node[]} [arrange]
 */

/**
 * @param {HTMLElement} host
 * @param {FrameOptions} options
 */
export function createPanelFrame(host, { id, title, help, figure: createFigure, table: data, controls = [], arrange = ({ header, body, note }) => [header, body, note] }) {
  const plot = h("div", { class: "plot", role: "img", "aria-label": title });
  const note = h("div", { class: "panel-note" });
  const legend = h("ul", { class: "legend", "aria-label": `Curves of ${title}` });
  const tableButton = h("button", { type: "button", class: "icon-button", "aria-pressed": "false", "aria-label": `Numbers of ${title} as a table`, title: "Numbers" }, icon("table"));
  const moreButton = h("button", { type: "button", class: "icon-button", "aria-label": `More for ${title}`, title: "More" }, icon("more"));
  const saveButton = h("button", { type: "button", class: "icon-button", "aria-label": `Download the numbers of ${title} as CSV`, title: "Download", onclick: save }, icon("download"));
  const helpButton = h("button", { type: "button", class: "icon-button", "aria-label": `How to read ${title}` }, icon("help"));
  const expandButton = h("button", { type: "button", class: "icon-button expand", "aria-label": `Enlarge ${title}`, title: "Enlarge" }, icon("expand"));
  const tools = h("div", { class: "panel-tools" }, helpButton, ...(createFigure ? [tableButton, moreButton] : [saveButton]), expandButton);
  const body = h("div", { class: "panel-body" }, plot);
  const header = h("header", { class: "panel-header" }, h("h2", {}, title), legend, h("span", { class: "panel-controls" }, ...controls), tools);
  const root = h("section", { class: "panel", id: `panel-${id}`, "aria-label": title }, ...arrange({ header, body, note }));
  host.append(root);

  const figure = createFigure?.(plot) ?? null;
  /** @type {HTMLElement | null} */
  let table = null;

  function save() {
    const numbers = data();
    if (numbers) download(`looplab-${id}.csv`, toCsv(numbers));
  }

  function showTable() {
    const numbers = data();
    const next = numbers ? dataTable(numbers, `Numbers of ${title}`) : null;
    if (table && next) {
      const top = table.scrollTop;
      table.replaceWith(next);
      next.scrollTop = top;
    } else if (next) body.append(next);
    else table?.remove();
    table = next;
  }

  const tabled = () => tableButton.getAttribute("aria-pressed") === "true";
  tableButton.addEventListener("click", () => {
    const on = !tabled();
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
    { label: "Download numbers", detail: "CSV, for a spreadsheet", run: save },
    { label: "Save picture", detail: "SVG, for a report", run: () => void figure?.saveImage(`looplab-${id}`) },
    { label: "Reset zoom", detail: "Drag in the plot to zoom in", run: () => figure?.resetZoom() },
  ]);

  return {
    root,
    /** @param {Figure} next @param {boolean} moving */
    show: (next, moving) => figure?.show(next, { moving }),
    /** What is told at rest only: the plot in a sentence, its legend, its table. @param {string} sentence @param {LegendItem[]} items */
    tell(sentence, items) {
      set(plot, { "aria-label": sentence });
      showLegend(items);
      if (tabled()) showTable();
    },
    /** @param {Node | string} text */
    note(text) {
      if (typeof text === "string") setText(note, text);
      // What is there already may hold the focus.
      else if (note.firstChild !== text) note.replaceChildren(text);
    },
    dispose() {
      figure?.dispose();
      root.remove();
    },
  };

  /** @param {LegendItem[]} items */
  function showLegend(items) {
    // Rebuilt only when it changes: a legend button must keep the focus it has.
    const now = JSON.stringify(items);
    if (legend.dataset["shown"] === now) return;
    legend.dataset["shown"] = now;
    const focused = [...legend.querySelectorAll("button")].indexOf(/** @type {any} */ (document.activeElement));
    legend.replaceChildren(...items.map(legendItem));
    if (focused >= 0) legend.querySelectorAll("button")[focused]?.focus();
  }
}

/** @param {LegendItem} item @returns {HTMLElement} */
function legendItem({ signal, label, name, dash, glyph, on = true, toggle }) {
  const swatch = glyph ? h("span", { class: "glyph", "aria-hidden": "true" }, glyph) : h("span", { class: `swatch ${dash ?? "solid"}`, "aria-hidden": "true" });
  swatch.style.setProperty("--swatch", `var(--signal-${signal})`);
  const words = [swatch, h("span", { class: glyph ? "" : "legend-label" }, label)];
  if (!toggle) return h("li", { title: name }, ...words, h("span", { class: "visually-hidden" }, `: ${name}`));
  return h("li", {}, h("button", { type: "button", class: "legend-toggle", "aria-pressed": String(on), title: name, "aria-label": `${label}: ${name}`, onclick: toggle }, ...words));
}
