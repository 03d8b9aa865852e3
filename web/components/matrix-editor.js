/** Four matrices to type, A to D: told together when they are done and fit each other. */

import { matrixText, parseMatrix } from "../core/lists.js";
import { h, set, setText, uniqueId } from "./dom.js";

/** @typedef {{A: number[][], B: number[][], C: number[][], D: number[][]}} Matrices */

const NAMES = /** @type {const} */ (["A", "B", "C", "D"]);
/** What each must look like, for n states. @type {Record<keyof Matrices, string>} */
const SHAPE = { A: "n × n", B: "n × 1", C: "1 × n", D: "1 × 1" };

/** @param {Matrices} matrices @returns {string} what does not fit, or nothing */
function misfit({ A, B, C, D }) {
  const n = A.length;
  if (n > 50) return "At most 50 states.";
  if (n > 0 && A[0]?.length !== n) return `A is ${n} × ${A[0]?.length}: it must be square.`;
  if (B.length !== n || (n > 0 && B[0]?.length !== 1)) return `B must be a column of ${n}.`;
  if (n > 0 && (C.length !== 1 || C[0]?.length !== n)) return `C must be a row of ${n}.`;
  return D.length === 1 && D[0]?.length === 1 ? "" : "D must be one number.";
}

/** @param {{onMatrices: (matrices: Matrices) => void}} options */
export function createMatrixEditor({ onMatrices }) {
  const message = h("p", { class: "field-message", id: uniqueId("matrix-message"), role: "alert" });
  const boxes = NAMES.map((name) => {
    const box = h("textarea", { id: uniqueId("matrix"), class: "matrix-input", spellcheck: "false", autocomplete: "off", autocapitalize: "off", "aria-describedby": message.id });
    box.addEventListener("change", done);
    return { name, box, root: h("div", { class: "matrix-field" }, h("label", { for: box.id }, h("b", {}, name), h("small", {}, ` ${SHAPE[name]}`)), box) };
  });
  const root = h("div", { class: "matrix-editor" }, ...boxes.map(({ root: field }) => field), message, h("p", { class: "field-hint" }, "One row a line; numbers apart by spaces or commas."));
  let told = "";

  function done() {
    const parsed = boxes.map(({ name, box }) => ({ name, box, matrix: parseMatrix(box.value) }));
    for (const { box, matrix } of parsed) set(box, { "aria-invalid": matrix === null ? "true" : null });
    const wrong = parsed.find(({ matrix }) => matrix === null);
    const matrices = /** @type {Matrices} */ (Object.fromEntries(parsed.map(({ name, matrix }) => [name, matrix])));
    const complaint = wrong ? `${wrong.name} is no matrix: rows of equal length, numbers only.` : misfit(matrices);
    setText(message, complaint);
    if (complaint || JSON.stringify(matrices) === told) return;
    told = JSON.stringify(matrices);
    onMatrices(matrices);
  }

  return {
    root,
    /** @param {Matrices} matrices */
    show({ A, B, C, D }) {
      const matrices = { A, B, C, D };
      if (JSON.stringify(matrices) === told) return;
      told = JSON.stringify(matrices);
      for (const { name, box } of boxes) {
        box.value = matrixText(matrices[name]);
        box.rows = Math.min(8, Math.max(name === "A" || name === "B" ? 2 : 1, matrices[name].length));
        set(box, { "aria-invalid": null });
      }
      setText(message, "");
    },
  };
}
