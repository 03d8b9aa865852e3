/** Numbers of a plot as a table that can be read, scrolled and copied. */

/** @import {Table} from "../core/types.js" */

import { thin } from "../core/csv.js";
import { formatNumber } from "../core/format.js";
import { h } from "./dom.js";

const ROWS = 200;

/** @param {Table} table @param {string} caption @returns {HTMLElement} */
export function dataTable({ header, rows, lead = 0 }, caption) {
  const shown = [...rows.slice(0, lead), ...thin(rows.slice(lead), ROWS)];
  const note = shown.length < rows.length ? `${caption}, ${shown.length} of ${rows.length} rows; the CSV file has all` : caption;
  const head = h("tr", {}, ...header.map((name) => h("th", { scope: "col" }, name)));
  const body = shown.map((row) =>
    h("tr", {}, ...row.map((cell) => typeof cell === "number" || cell === null ? h("td", {}, formatNumber(cell, 5)) : h("td", { class: "words" }, cell))),
  );
  return h(
    "div",
    { class: "data-table", tabindex: 0, role: "region", "aria-label": caption },
    h("table", {}, h("caption", {}, note), h("thead", {}, head), h("tbody", {}, ...body)),
  );
}

/** @param {string} filename @param {string} text @param {string} [type] */
export function download(filename, text, type = "text/csv;charset=utf-8") {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = h("a", { href: url, download: filename });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
