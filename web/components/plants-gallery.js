/** `<plants-gallery>`: the plants of this server as cards with their drawings, shelf by shelf, with a search. */

/** @import {PlantSummary} from "../core/plant/types.js" */

import { createApi } from "../core/api.js";
import { h, setText, uniqueId } from "./dom.js";
import "./plant-schematic.js";

export class PlantsGallery extends HTMLElement {
  connectedCallback() {
    void this.#load();
  }

  async #load() {
    this.setAttribute("aria-busy", "true");
    this.replaceChildren(h("p", { class: "empty" }, "Loading the plants…"));
    try {
      const { plants } = await createApi().plants();
      this.#show(plants);
    } catch (error) {
      const retry = h("button", { type: "button", class: "button", onclick: () => void this.#load() }, "Try again");
      this.replaceChildren(h("p", { class: "empty" }, `The plants could not be loaded. ${error instanceof Error ? error.message : ""} `, retry));
    } finally {
      this.removeAttribute("aria-busy");
    }
  }

  /** @param {PlantSummary[]} plants */
  #show(plants) {
    const id = uniqueId("search");
    const search = h("input", { type: "search", id, autocomplete: "off", placeholder: "tank, unstable, Fi, 3.1 …" });
    const count = h("p", { class: "plants-count", role: "status" });
    const cards = plants.map((plant) => ({ plant, card: plantCard(plant), words: wordsOf(plant) }));
    const shelves = [...new Set(plants.map(({ group }) => group))].map((group) => {
      const own = cards.filter(({ plant }) => plant.group === group);
      return { own, root: h("section", { class: "plants-shelf" }, h("h2", {}, group), h("ul", { class: "plant-cards" }, ...own.map(({ card }) => card))) };
    });
    const filter = () => {
      const asked = search.value.toLowerCase().split(/\s+/).filter(Boolean);
      for (const { card, words } of cards) card.hidden = !asked.every((word) => words.includes(word));
      for (const { own, root } of shelves) root.hidden = own.every(({ card }) => card.hidden);
      const shown = cards.filter(({ card }) => !card.hidden).length;
      setText(count, shown === cards.length ? `${cards.length} plants` : shown === 0 ? "No plant has all of these words." : `${shown} of ${cards.length} plants`);
    };
    search.addEventListener("input", filter);
    this.replaceChildren(h("div", { class: "plants-search" }, h("label", { for: id }, "Search"), search, count), ...shelves.map(({ root }) => root));
    filter();
  }
}

/** @param {PlantSummary} plant */
function wordsOf({ title, summary, group, notes, inputs, outputs, states }) {
  return [title, summary, group, notes, ...inputs, ...outputs, ...states].join(" ").toLowerCase();
}

/** @param {PlantSummary} plant */
function plantCard({ id, kind, title, summary, notes, inputs, outputs, states, drawing, values }) {
  const picture = h("div", { class: "plant-card-picture", "aria-hidden": "true" });
  if (drawing) {
    const schematic = document.createElement("plant-schematic");
    schematic.still = true;
    schematic.drawing = drawing;
    schematic.values = values;
    picture.append(schematic);
  }
  const order = kind === "transfer-matrix" ? "transfer matrix" : `order ${states.length}`;
  const [first = ""] = summary.split(/(?<=\.)\s/);
  return h(
    "li",
    { class: "plant-tile" },
    picture,
    h("h3", {}, h("a", { href: `/plants/${encodeURIComponent(id)}` }, title)),
    h("p", {}, first),
    h("p", { class: "facts" }, [order, `${counted(inputs.length, "input")}, ${counted(outputs.length, "output")}`, notes ? `notes §${notes}` : ""].filter(Boolean).join(" · ")),
  );
}

/** @param {number} n @param {string} noun */
function counted(n, noun) {
  return `${n} ${noun}${n === 1 ? "" : "s"}`;
}

customElements.define("plants-gallery", PlantsGallery);
