/** A button that opens a short list of actions in a popover: arrow keys, Escape and a click outside work. */

import { h, uniqueId } from "./dom.js";

/** @typedef {{label: string, detail?: string, run: () => void} | {heading: string}} MenuItem */

/**
 * @param {HTMLButtonElement} button
 * @param {MenuItem[]} items
 */
export function attachMenu(button, items) {
  const id = uniqueId("menu");
  const list = h("div", { class: "menu", popover: "auto", id, role: "menu", "aria-label": button.getAttribute("aria-label") ?? button.textContent });
  for (const item of items) {
    if ("heading" in item) {
      list.append(h("div", { class: "menu-heading", role: "presentation" }, item.heading));
      continue;
    }
    const entry = h("button", { type: "button", role: "menuitem", tabindex: -1 }, h("span", {}, item.label), item.detail ? h("small", {}, item.detail) : null);
    entry.addEventListener("click", () => {
      list.hidePopover();
      button.focus();
      item.run();
    });
    list.append(entry);
  }
  button.setAttribute("aria-haspopup", "menu");
  button.setAttribute("aria-expanded", "false");
  button.setAttribute("popovertarget", id);
  button.after(list);

  const entries = () => /** @type {HTMLElement[]} */ ([...list.querySelectorAll('[role="menuitem"]')]);
  list.addEventListener("toggle", (event) => {
    const open = /** @type {ToggleEvent} */ (event).newState === "open";
    button.setAttribute("aria-expanded", String(open));
    if (!open) return;
    place(button, list);
    entries()[0]?.focus({ preventScroll: true });
  });
  list.addEventListener("keydown", (event) => {
    const all = entries();
    const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
    /** @type {Record<string, number>} */
    const to = { ArrowDown: (at + 1) % all.length, ArrowUp: (at - 1 + all.length) % all.length, Home: 0, End: all.length - 1 };
    const next = to[event.key];
    if (next === undefined) return;
    event.preventDefault();
    all[next]?.focus();
  });
}

/** @param {HTMLElement} button @param {HTMLElement} list */
function place(button, list) {
  const at = button.getBoundingClientRect();
  const room = document.documentElement.clientWidth;
  const left = Math.max(8, Math.min(at.left, room - list.offsetWidth - 8));
  const below = at.bottom + 4;
  const top = below + list.offsetHeight < innerHeight - 8 ? below : Math.max(8, innerHeight - 8 - list.offsetHeight);
  list.style.left = `${left}px`;
  list.style.top = `${top}px`;
}
