/**
 * A card of the rail: a heading that opens and closes it, a line of live values that shows when it is closed.
 * It opens itself, and takes the focus, on the event "card-open" sent to its root.
 */

import { h, setText } from "./dom.js";
import { icon } from "./icons.js";

/**
 * @typedef {object} Card
 * @property {HTMLElement} root
 * @property {HTMLElement} body
 * @property {(text: string) => void} summarise
 * @property {(open: boolean) => void} setOpen
 */

/**
 * @param {HTMLElement} host
 * @param {{id: string, title: string, open?: boolean, onToggle?: (open: boolean) => void}} options
 * @returns {Card}
 */
export function createCard(host, { id, title, open = true, onToggle = () => {} }) {
  const bodyId = `${id}-body`;
  const summary = h("span", { class: "card-summary" });
  const button = h("button", { type: "button", class: "card-toggle", "aria-controls": bodyId }, h("span", { class: "card-title" }, title), summary, icon("chevron"));
  const body = h("div", { class: "card-body", id: bodyId });
  const root = h("section", { class: "card", id, "aria-label": title }, h("h2", {}, button), body);

  /** @param {boolean} value */
  function setOpen(value) {
    button.setAttribute("aria-expanded", String(value));
    root.classList.toggle("open", value);
    body.hidden = !value;
    onToggle(value);
  }
  button.addEventListener("click", () => setOpen(body.hidden === true));
  root.addEventListener("card-open", () => {
    setOpen(true);
    root.scrollIntoView({ block: "nearest", behavior: calm() ? "auto" : "smooth" });
    button.focus({ preventScroll: true });
  });
  setOpen(open);
  host.append(root);
  return { root, body, setOpen, summarise: (text) => setText(summary, text) };
}

/** Opens the card with this id, wherever on the page it is. @param {string} id */
export function openCard(id) {
  document.getElementById(id)?.dispatchEvent(new CustomEvent("card-open"));
}

/** True where the student asked for less motion. */
export function calm() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}
