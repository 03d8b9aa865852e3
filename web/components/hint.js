/**
 * A short explanation that shows on hover and on focus, and stays while the pointer is on it; Escape hides it.
 * One popover serves the page: it lies above everything and is never cut off by a scrolling bar.
 */

import { h, uniqueId } from "./dom.js";

/** @typedef {{title: string, text: string, more?: string | null}} Hint */

/** @type {HTMLElement | null} */
let bubble = null;
/** @type {HTMLElement | null} */
let owner = null;
let leaving = 0;

function makeBubble() {
  bubble = h("div", { class: "hint", popover: "manual", role: "tooltip", id: "hint-bubble" });
  bubble.addEventListener("pointerenter", () => clearTimeout(leaving));
  bubble.addEventListener("pointerleave", hideSoon);
  // In the main landmark, as all that a screen reader is to find on a page.
  (document.querySelector("main") ?? document.body).append(bubble);
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") hide();
  });
  addEventListener("scroll", hide, { passive: true, capture: true });
  addEventListener("resize", hide);
  return bubble;
}

function hide() {
  clearTimeout(leaving);
  owner = null;
  if (bubble?.matches(":popover-open")) bubble.hidePopover();
}

function hideSoon() {
  clearTimeout(leaving);
  leaving = window.setTimeout(hide, 150);
}

/** @param {HTMLElement} element @param {Hint} hint */
function show(element, { title, text, more }) {
  clearTimeout(leaving);
  const box = bubble ?? makeBubble();
  owner = element;
  box.replaceChildren(h("strong", {}, title), h("span", {}, text), more ? h("em", {}, more) : "");
  box.showPopover();
  const at = element.getBoundingClientRect();
  const { offsetWidth: width, offsetHeight: height } = box;
  const left = Math.max(8, Math.min(at.left, document.documentElement.clientWidth - width - 8));
  const below = at.bottom + 8 + height < innerHeight;
  box.style.left = `${left}px`;
  box.style.top = `${below ? at.bottom + 8 : Math.max(8, at.top - height - 8)}px`;
}

/**
 * @param {HTMLElement} element  focusable
 * @param {() => Hint} hint  asked each time, so that it speaks of the values of now
 */
export function attachHint(element, hint) {
  // The bubble is shared, so each element keeps its own words for screen readers.
  const words = h("span", { class: "visually-hidden", id: uniqueId("hint") });
  element.after(words);
  element.setAttribute("aria-describedby", words.id);
  const open = () => show(element, hint());
  const describe = () => {
    const { text, more } = hint();
    const full = more ? `${text} ${more}` : text;
    if (words.textContent !== full) words.textContent = full;
  };
  describe();
  element.addEventListener("pointerenter", (event) => {
    if (event.pointerType !== "touch") open();
  });
  element.addEventListener("pointerleave", hideSoon);
  element.addEventListener("focus", () => {
    describe();
    if (element.matches(":focus-visible")) open();
  });
  element.addEventListener("blur", hide);
  element.addEventListener("click", () => (owner === element && bubble?.matches(":popover-open") ? hideSoon() : open()));
  return { describe };
}
