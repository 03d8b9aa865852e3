/** Tables as CSV, for a spreadsheet. */

/** @import {Table} from "./types.js" */

import { tableNumber } from "./format.js";

/** @param {string | number | null} cell */
function csvCell(cell) {
  if (cell === null) return "";
  if (typeof cell === "number") return tableNumber(cell);
  // A spreadsheet would run text that begins like a formula.
  const text = /^[=+\-@\t\r]/.test(cell) ? `'${cell}` : cell;
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** @param {Table} table */
export function toCsv({ header, rows }) {
  return [header, ...rows].map((row) => row.map(csvCell).join(",")).join("\r\n") + "\r\n";
}

/**
 * At most `limit` rows, evenly spaced, first and last among them.
 * @template T
 * @param {T[]} rows
 * @param {number} limit
 * @returns {T[]}
 */
export function thin(rows, limit) {
  if (rows.length <= limit) return rows;
  const step = (rows.length - 1) / (limit - 1);
  return Array.from({ length: limit }, (_, i) => /** @type {T} */ (rows[Math.round(i * step)]));
}
