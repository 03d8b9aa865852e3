/** Formulas from the server: MathML text put on the page as elements, and nothing but MathML elements. */

const NAMESPACE = "http://www.w3.org/1998/Math/MathML";
const ALLOWED = /^(?!href$|xlink|on|src$|style$)/i;

/** @param {Element} host @param {string | null | undefined} mathml */
export function showMath(host, mathml) {
  const known = /** @type {any} */ (host);
  if (known.shownMath === mathml) return;
  known.shownMath = mathml;
  const parsed = new DOMParser().parseFromString(mathml ?? "", "text/html").querySelector("math");
  host.replaceChildren(...(parsed ? [clean(parsed)] : []));
}

/** @param {Element} element @returns {Element} */
function clean(element) {
  const copy = document.createElementNS(NAMESPACE, element.localName);
  for (const { name, value } of element.attributes) if (ALLOWED.test(name)) copy.setAttribute(name, value);
  for (const child of element.childNodes) {
    if (child.nodeType === Node.TEXT_NODE) copy.append(child.textContent ?? "");
    else if (child instanceof Element && child.namespaceURI === NAMESPACE) copy.append(clean(child));
  }
  return copy;
}
