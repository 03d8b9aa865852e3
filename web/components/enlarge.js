/** Panels that grow to the width of their grid at a press. @param {HTMLElement} host */
export function enlargeable(host) {
  host.addEventListener("panel-expand", (event) => /** @type {HTMLElement} */ (event.target).classList.toggle("enlarged"));
}
