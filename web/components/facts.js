/** Small pieces that analyses say things with: a formula with its name, a yes or no, a table of values. */

import { sentence } from "../core/format.js";
import { formatShort } from "../core/roots.js";
import { h, uniqueId } from "./dom.js";
import { showMath } from "./mathml.js";

/** @typedef {Node | string | null} Cell */

/** Text longer than this may go over several lines. */
const LONG = 32;

/**
 * A formula of the server under a name; as text where it is too long to typeset.
 * @param {string} name
 * @param {{text: string, mathml: string | null} | null} formula
 */
export function formulaBlock(name, formula) {
  const place = h("div", { class: "formula", tabindex: 0, role: "group", "aria-label": name });
  if (formula?.mathml) showMath(place, formula.mathml);
  else place.append(h("code", {}, formula?.text ?? ""));
  return h("div", { class: "formula-block" }, h("span", { class: "formula-name" }, name), place);
}

/**
 * Yes or no as a word in a shape.
 * @param {boolean | null} holds  null where it is not decided
 * @param {{yes?: string, no?: string}} [words]
 */
export function yesNo(holds, { yes = "yes", no = "no" } = {}) {
  return h("span", { class: "yes-no", "data-holds": holds === null ? "open" : String(holds) }, holds === null ? "not decided" : holds ? yes : no);
}

/**
 * Whether something holds, in a word and a shape, and why.
 * @param {string} name
 * @param {boolean | null} holds  null where it is not decided
 * @param {string | null | undefined} because
 */
export function verdictRow(name, holds, because) {
  return h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, yesNo(holds)), h("td", { class: "because" }, sentence(because)));
}

/**
 * A table that scrolls where it is too wide; its caption does not scroll away with it.
 * @param {string} caption
 * @param {HTMLTableElement} table
 */
export function captioned(caption, table) {
  const name = h("p", { class: "table-caption", id: uniqueId("table") }, caption);
  table.setAttribute("aria-labelledby", name.id);
  return h("div", {}, name, h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-labelledby": name.id }, table));
}

/**
 * @param {string} caption
 * @param {string[]} header
 * @param {Cell[][]} rows  the first cell of a row heads it
 */
export function valueTable(caption, header, rows) {
  return captioned(
    caption,
    h(
      "table",
      { class: "values" },
      headRow(header),
      h("tbody", {}, ...rows.map(([first = null, ...rest]) => h("tr", {}, h("th", { scope: "row" }, first), ...rest.map((cell) => h("td", { class: typeof cell === "string" && cell.length > LONG ? "because" : null }, cell))))),
    ),
  );
}

/**
 * A matrix between brackets.
 * @param {string} name
 * @param {number[][] | null} matrix
 */
export function matrixBlock(name, matrix) {
  const rows = (matrix ?? []).map((row) => h("tr", {}, ...row.map((value) => h("td", {}, formatShort(value)))));
  const size = `${matrix?.length ?? 0} × ${matrix?.[0]?.length ?? 0}`;
  return h("div", { class: "matrix-block" }, h("span", { class: "formula-name" }, name), h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": `${name}, ${size}` }, rows.length > 0 ? h("table", { class: "matrix" }, h("tbody", {}, ...rows)) : h("span", {}, "empty")));
}

/** A column without a name has no heading to be read out. @param {string[]} names */
export function headRow(names) {
  return h("thead", {}, h("tr", {}, ...names.map((name) => (name === "" ? h("td") : h("th", { scope: "col" }, name)))));
}

/** @param {string} title @param {...Cell} children */
export function part(title, ...children) {
  return h("section", { class: "analysis-part" }, h("h3", {}, title), ...children);
}
