/** The process of several loops: one of the library, or a matrix of one's own, entry by entry. */

/** @import {MimoStore} from "../../core/mimo/mimo.js" */
/** @import {PlantSummary} from "../../core/plant/types.js" */

import { sentence } from "../../core/format.js";
import { blankState } from "../../core/mimo/mimo.js";
import { createCard } from "../../components/card.js";
import { h, set, setText, uniqueId } from "../../components/dom.js";
import "../../components/segmented-control.js";
import { createSelectField } from "../../components/select-field.js";

const OWN = "";
const HINT = "Type a transfer function, such as 12.8exp(-s)/(16.7s+1), or K, τ, θ: 12.8, 16.7, 1.";

/**
 * @param {HTMLElement} host
 * @param {MimoStore} store
 * @param {{plants: PlantSummary[], choose: (id: string) => void, write: (entries: string[][], timeUnit: string) => void}} options
 */
export function mount(host, store, { plants, choose, write }) {
  const card = createCard(host, { id: "card-process", title: "Process" });
  const library = createSelectField({
    label: "Process",
    groups: [
      { label: "Library", choices: plants.map(({ id, title }) => ({ value: id, label: title })) },
      { label: null, choices: [{ value: OWN, label: "A matrix of my own" }] },
    ],
    onChoice: (id) => (id === OWN ? write(store.get().entries, store.about.timeUnit) : choose(id)),
  });
  const size = h("segmented-control", { label: "Number of loops" });
  size.options = [2, 3, 4, 5].map((n) => ({ value: String(n), label: `${n}×${n}` }));
  size.addEventListener("value-change", () => {
    const n = Number(size.value);
    const old = store.get().entries;
    write(blankState(n).entries.map((row, i) => row.map((text, j) => old[i]?.[j] ?? text)), store.get().timeUnit);
  });
  const unit = h("segmented-control", { label: "Unit of time" });
  unit.options = ["s", "min", "h"].map((value) => ({ value, label: value }));
  unit.addEventListener("value-change", () => write(store.get().entries, unit.value));
  const grid = h("div", { class: "mimo-entries", role: "group", "aria-label": "Entries of the transfer matrix" });
  const message = h("p", { class: "field-message", role: "alert", id: uniqueId("entries") });
  const own = h("div", { class: "row" }, size, unit);
  const summary = h("p", { class: "field-hint" });
  card.body.append(library.root, summary, own, grid, message, h("p", { class: "field-hint" }, HINT));
  /** @type {HTMLInputElement[][]} */
  let fields = [];

  function take() {
    const entries = fields.map((row) => row.map(({ value }) => value.trim() || "0"));
    if (JSON.stringify(entries) !== JSON.stringify(store.get().entries)) write(entries, store.about.timeUnit);
  }

  /** @param {number} n */
  function build(n) {
    fields = Array.from({ length: n }, (_, i) =>
      Array.from({ length: n }, (_unused, j) => {
        const field = h("input", { type: "text", class: "expression", id: `entry-${i}-${j}`, maxlength: 200, autocomplete: "off", autocapitalize: "off", spellcheck: "false", "aria-describedby": message.id });
        field.addEventListener("change", take);
        return field;
      }),
    );
    grid.style.setProperty("--size", String(n));
    grid.replaceChildren(...fields.flatMap((row, i) => row.map((field, j) => h("div", { class: "mimo-entry" }, h("label", { for: field.id }, h("i", {}, "g"), h("sub", {}, `${i + 1}${j + 1}`), h("span", { class: "visually-hidden" }, `, from u${j + 1} to y${i + 1}`)), field))));
  }

  function show() {
    const { plant, entries, timeUnit } = store.get();
    if (fields.length !== entries.length) build(entries.length);
    library.show(plant);
    size.value = String(entries.length);
    unit.value = timeUnit;
    own.hidden = plant !== OWN;
    const found = plants.find(({ id }) => id === plant);
    setText(summary, found?.summary ?? "");
    summary.hidden = !found;
    for (const [i, row] of fields.entries()) for (const [j, field] of row.entries()) if (document.activeElement !== field) field.value = entries[i]?.[j] ?? "";
    card.summarise(found?.title ?? `${entries.length}×${entries.length}`);
  }
  store.subscribe((_, { moving }) => {
    if (!moving) show();
  });
  show();

  return {
    /** What the server refused, at the entry it is about; null when it was content. @param {any} error */
    complain(error) {
      const at = /^plant\.entries\[(\d)\](?:\[(\d)\])?/.exec(error?.path ?? "");
      for (const [i, row] of fields.entries()) for (const [j, field] of row.entries()) set(field, { "aria-invalid": at && Number(at[1]) === i && Number(at[2]) === j ? "true" : null });
      setText(message, at ? `${at[2] ? `g${Number(at[1]) + 1}${Number(at[2]) + 1}: ` : ""}${[error.message, error.hint].map(sentence).filter(Boolean).join(" ")}` : "");
    },
  };
}
