/** `<labs-list>`: the labs of this server as cards; says what to do where there are none. */

/** @import {LabSummary} from "../core/types.js" */

import { createApi } from "../core/api.js";
import { localStore, readProgress, solvedIn } from "../core/lab/progress.js";
import { h } from "./dom.js";

export class LabsList extends HTMLElement {
  connectedCallback() {
    void this.#load();
  }

  async #load() {
    this.setAttribute("aria-busy", "true");
    this.replaceChildren(h("p", { class: "empty" }, "Loading the labs…"));
    try {
      const { labs } = await createApi().labs();
      this.replaceChildren(
        labs.length > 0
          ? h("ul", { class: "lab-cards" }, ...labs.map(labCard))
          : h("p", { class: "empty" }, "There are no labs on this server yet. A lab is one JSON file in its labs folder."),
      );
    } catch (error) {
      const retry = h("button", { type: "button", class: "button", onclick: () => void this.#load() }, "Try again");
      this.replaceChildren(h("p", { class: "empty" }, `The labs could not be loaded. ${error instanceof Error ? error.message : ""} `, retry));
    } finally {
      this.removeAttribute("aria-busy");
    }
  }
}

/** @param {LabSummary} lab */
function labCard({ id, title, level, section, summary, minutes, exercises }) {
  const facts = [level, section ? `notes §${section}` : "", minutes ? `${minutes} min` : "", exercises ? `${exercises} ${exercises === 1 ? "exercise" : "exercises"}` : ""];
  return h(
    "li",
    { class: "lab-card" },
    h("h3", {}, h("a", { href: `/labs/${encodeURIComponent(id)}` }, title)),
    h("p", {}, summary),
    h("p", { class: "facts" }, facts.filter(Boolean).join(" · ")),
    begun(id, exercises),
  );
}

/** How far this browser's student has come, once there is something to say. @param {string} id @param {number} exercises */
function begun(id, exercises) {
  const saved = readProgress(id, localStore());
  const solved = Math.min(solvedIn(saved), exercises);
  if (Object.keys(saved.exercises).length === 0) return null;
  return h("p", { class: "lab-begun" }, h("progress", { max: exercises, value: solved, "aria-hidden": "true" }), solved === exercises ? "All solved" : `${solved} of ${exercises} solved`);
}

customElements.define("labs-list", LabsList);
