/** Which plots are on the stage: on a wide page any number of them, on a narrow one as tabs. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */

import { PLOTS } from "../core/plots.js";
import { h } from "../components/dom.js";

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} _api
 * @param {{narrow: () => boolean, plots?: {id: string, label: string}[]}} options
 * @returns {() => void}
 */
export function mount(host, store, _api, { narrow, plots = PLOTS }) {
  const buttons = plots.map(({ id, label }) => {
    const button = h("button", { type: "button", class: "view-toggle" }, label);
    button.addEventListener("click", () => {
      const { show } = store.get().view;
      if (narrow()) store.setView({ show: [id] });
      else if (show.includes(id)) store.setView({ show: show.length > 1 ? show.filter((name) => name !== id) : show });
      else store.setView({ show: plots.map((plot) => plot.id).filter((name) => name === id || show.includes(name)) });
    });
    return { id, button };
  });
  const root = h("div", { class: "view-bar", role: "group", "aria-label": "Plots shown" }, ...buttons.map(({ button }) => button));
  host.append(root);

  function showPressed() {
    const { show } = store.get().view;
    for (const { id, button } of buttons) button.setAttribute("aria-pressed", String(show.includes(id)));
  }
  const stop = store.subscribe(showPressed);
  showPressed();
  return () => {
    stop();
    root.remove();
  };
}
