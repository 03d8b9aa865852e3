/** A transfer matrix written out, entry by entry, each with a way to the workbench. */

/** @import {Equation, MatrixDocument, MatrixEntry} from "../../core/plant/types.js" */

import { h } from "../../components/dom.js";
import { formulaBlock, valueTable } from "../../components/facts.js";
import { createPanelFrame } from "../../components/panel-frame.js";

/** @param {MatrixEntry} entry @returns {string} the address of the workbench with this entry as its plant */
export function entryLink({ K, leads, lags, theta }) {
  const [tau] = lags;
  if (leads.length === 0 && lags.length === 1) return `/workbench?${new URLSearchParams({ plant: "fopdt", K: String(K), tau: String(tau), theta: String(theta) })}`;
  const product = (/** @type {number[]} */ times) => times.map((time) => `(${time}*s + 1)`).join("*");
  const numerator = [String(K), product(leads), theta ? `exp(-${theta}*s)` : ""].filter(Boolean).join("*");
  return `/workbench?${new URLSearchParams({ plant: lags.length > 0 ? `${numerator}/(${product(lags)})` : numerator })}`;
}

/** @param {HTMLElement} host @param {MatrixDocument} matrix @param {Equation[]} equations */
export function mount(host, { inputs, outputs, entries, time_unit: timeUnit }, equations) {
  const written = new Map(equations.map((equation) => [equation.path, equation]));
  const rows = outputs.map((output, i) =>
    h(
      "div",
      { class: "matrix-row" },
      ...inputs.map((input, j) => {
        const [equation, entry] = [written.get(`entries[${i}][${j}]`), entries[i]?.[j]];
        const channel = `from ${input.name} to ${output.name}`;
        return h("div", { class: "matrix-entry" }, formulaBlock(channel, equation ? { text: equation.latex, mathml: equation.mathml } : null), entry ? h("a", { class: "button", href: entryLink(entry), "aria-label": `Open in the workbench, ${channel}` }, "Open in the workbench") : null);
      }),
    ),
  );
  const signals = valueTable("Signals, all deviations from where the plant ran", ["", "what it is", "unit"], [...inputs, ...outputs].map(({ name, meaning, unit }) => [name, meaning, unit]));
  const { root } = createPanelFrame(host, {
    id: "matrix-entries",
    title: "Transfer matrix",
    help: "What each input alone does to each output: rows are outputs, columns are inputs. The workbench takes one entry as its plant, as if no other input moved.",
    figure: null,
    table: () => ({ header: ["output", "input", "K", "leads", "lags", "theta"], rows: outputs.flatMap((output, i) => inputs.map((input, j) => numbersOf(output.name, input.name, entries[i]?.[j]))) }),
    arrange: ({ header }) => [header, h("div", { class: "plant-words" }, h("p", {}, `What each input does to each output; times in ${timeUnit}.`), ...rows, signals)],
  });
  root.classList.add("plant-analysis");
}

/** @param {string} output @param {string} input @param {MatrixEntry | undefined} entry */
function numbersOf(output, input, entry) {
  return [output, input, entry?.K ?? null, entry?.leads.join(" ") ?? "", entry?.lags.join(" ") ?? "", entry?.theta ?? null];
}
