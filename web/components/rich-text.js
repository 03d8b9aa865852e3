/** Text from the server, put on the page element by element: what is not on the list does not get there. */

import { set } from "./dom.js";

const MATH = "http://www.w3.org/1998/Math/MathML";
const TAGS = /^(p|br|hr|em|strong|s|code|pre|blockquote|ul|ol|li|a|span|div|h[3-6]|table|thead|tbody|tr|th|td)$/;
const ATTRIBUTES = /^(class|style|start|title|display|displaystyle|scriptlevel|mathvariant|stretchy|symmetric|fence|separator|[lr]space|largeop|movablelimits|form|minsize|maxsize|accent|accentunder|linethickness|width|height|depth|voffset|columnspan|rowspan)$/;
const LINK = /^(https?:|mailto:)/i;

/**
 * @param {Element} host
 * @param {string} html
 */
export function showHtml(host, html) {
  const parsed = new DOMParser().parseFromString(html, "text/html").body;
  host.replaceChildren(...copies(parsed));
  for (const box of host.querySelectorAll("div.math, div.table")) scrollable(box);
}

/** @param {Node} parent @returns {(Node | string)[]} */
function copies(parent) {
  return [...parent.childNodes].flatMap((node) => {
    if (node.nodeType === Node.TEXT_NODE) return node.textContent ?? "";
    return node instanceof Element ? copy(node) : [];
  });
}

/** @param {Element} element @returns {(Node | string)[]} */
function copy(element) {
  const math = element.namespaceURI === MATH;
  // What is unknown falls away, its words stay; a script's "words" are its code.
  if (!math && !TAGS.test(element.localName)) return element.localName === "script" || element.localName === "style" ? [] : copies(element);
  const made = document.createElementNS(math ? MATH : "http://www.w3.org/1999/xhtml", element.localName);
  for (const { name, value } of element.attributes) if (ATTRIBUTES.test(name)) made.setAttribute(name, value);
  const href = element.getAttribute("href") ?? "";
  if (element.localName === "a" && LINK.test(href)) set(made, { href, target: "_blank", rel: "noopener noreferrer" });
  made.append(...copies(element));
  return [made];
}

/** A wide formula or table scrolls by itself; while it does, the keyboard has to reach it. @param {Element} box */
function scrollable(box) {
  new ResizeObserver(() => {
    const wide = box.scrollWidth > box.clientWidth + 1;
    set(box, { tabindex: wide ? 0 : null, role: wide ? "group" : null, "aria-label": wide ? "Scrolls sideways" : null });
  }).observe(box);
}
