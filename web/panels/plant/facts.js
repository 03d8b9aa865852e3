/** What the plant is made of: its equations as formulas, and its parameters with meaning, range and source. */

/** @import {PlantBench} from "../../core/plant/bench.js" */

import { formatShort } from "../../core/roots.js";
import { h } from "../../components/dom.js";
import { captioned, headRow } from "../../components/facts.js";
import { showMath } from "../../components/mathml.js";
import "../../components/number-field.js";

/** @param {HTMLElement} host @param {PlantBench} bench */
export function mount(host, bench) {
  /** @type {Map<string, import("../../components/number-field.js").NumberField>} */
  const fields = new Map();
  const equations = h(
    "div",
    { class: "plant-equations" },
    ...bench.answer.equations.map(({ mathml, latex }) => {
      const place = h("div", { class: "formula", tabindex: 0, role: "group", "aria-label": latex });
      showMath(place, mathml);
      return place;
    }),
  );
  const rows = bench.parameters.map(({ name, value, min, max, meaning, source }) => {
    const field = document.createElement("number-field");
    for (const [key, text] of Object.entries({ label: name, unit: bench.unit(name), min, max })) if (text !== undefined) field.setAttribute(key, String(text));
    field.value = bench.setting.parameters[name] ?? value;
    field.addEventListener("value-change", (event) => bench.set({ parameters: { [name]: /** @type {CustomEvent<{value: number}>} */ (event).detail.value } }));
    fields.set(name, field);
    return h(
      "tr",
      {},
      h("td", {}, field),
      h("th", { scope: "row" }, meaning ?? name),
      h("td", {}, formatShort(value)),
      h("td", {}, `${min === undefined ? "" : formatShort(min)} … ${max === undefined ? "" : formatShort(max)}${bench.unit(name) ? ` ${bench.unit(name)}` : ""}`),
      h("td", { class: "because" }, source ?? ""),
    );
  });
  const table = h("table", { class: "values plant-parameters" }, headRow(["value", "meaning", "nominal", "range", "source"]), h("tbody", {}, ...rows));
  const root = h(
    "div",
    { class: "plant-facts" },
    h("details", { class: "plant-fold", open: true }, h("summary", {}, h("h2", {}, "Equations")), equations),
    rows.length > 0 ? h("details", { class: "plant-fold" }, h("summary", {}, h("h2", {}, `Parameters`), h("span", {}, ` ${rows.length}`)), captioned("Change one and the run goes on with it.", table)) : null,
  );
  host.append(root);
  return {
    root,
    refresh() {
      for (const [name, field] of fields) field.value = bench.setting.parameters[name] ?? field.value;
    },
  };
}
