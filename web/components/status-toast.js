/** `<status-toast>`: brief news at the foot of the page, spoken by screen readers, with at most one action. */

import { h } from "./dom.js";

const SHOWN_MS = 6000;

export class StatusToast extends HTMLElement {
  #timer = 0;
  #text = h("span", { role: "status" });
  #action = h("span", {});

  connectedCallback() {
    if (!this.#text.isConnected) this.append(this.#text, this.#action);
  }

  /** @param {string} text @param {{action?: {label: string, run: () => void}, lasting?: boolean}} [options] */
  say(text, { action, lasting = false } = {}) {
    clearTimeout(this.#timer);
    this.#text.textContent = text;
    this.#action.replaceChildren(
      action
        ? h("button", { type: "button", onclick: () => { action.run(); this.hush(); } }, action.label)
        : "",
    );
    this.classList.add("shown");
    if (!lasting) this.#timer = window.setTimeout(() => this.hush(), SHOWN_MS);
  }

  hush() {
    clearTimeout(this.#timer);
    this.classList.remove("shown");
    this.#text.textContent = "";
    this.#action.replaceChildren();
  }
}

customElements.define("status-toast", StatusToast);

/** The page's toast, made on first use. @returns {StatusToast} */
export function toast() {
  let element = document.querySelector("status-toast");
  if (!element) {
    element = document.createElement("status-toast");
    document.body.append(element);
  }
  return element;
}
