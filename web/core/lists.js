/** Lists of numbers and matrices as people type them, and back. */

import { parseNumber } from "./format.js";

/** As many as the server takes in one list. */
const LONGEST = 500;

/**
 * Numbers separated by commas, semicolons or spaces; null where one of them is none.
 * @param {string} text
 * @returns {number[] | null}
 */
export function parseList(text) {
  const parts = text.split(/[\s,;]+/).filter((part) => part !== "");
  const values = parts.map(parseNumber);
  return values.length <= LONGEST && values.every((value) => value !== null) ? /** @type {number[]} */ (values) : null;
}

/**
 * Rows separated by semicolons or new lines; null where it is no matrix. Nothing typed is a matrix without rows.
 * @param {string} text
 * @returns {number[][] | null}
 */
export function parseMatrix(text) {
  const lines = text.split(/[;\n]/).filter((line) => line.trim() !== "");
  const rows = lines.map(parseList);
  const width = rows[0]?.length ?? 0;
  return rows.every((row) => row !== null && row.length === width && width > 0) ? /** @type {number[][]} */ (rows) : null;
}

/** @param {number[]} values @param {string} [gap] */
export function listText(values, gap = ", ") {
  return values.map(String).join(gap);
}

/** One row a line. @param {number[][]} matrix */
export function matrixText(matrix) {
  return matrix.map((row) => row.map(String).join("  ")).join("\n");
}

/** On one line, for an address. @param {number[][]} matrix */
export function matrixLine(matrix) {
  return matrix.map((row) => row.join(",")).join(";");
}
