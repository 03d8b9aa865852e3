/** The stage of a bench: the plots that the view asks for, in their order, each mounted when it is first shown. */

/** @import {Api} from "../core/api.js" */
/** @import {Store} from "../core/store.js" */

import { takesRow } from "../core/workbench/plots.js";
import { h } from "./dom.js";

/** @typedef {(host: HTMLElement, store: Store, api: Api) => () => void} Mount */

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} api
 * @param {{id: string, mount: Mount}[]} plots
 * @returns {() => void}
 */
export function createStage(host, store, api, plots) {
  /** @type {Map<string, {slot: HTMLElement, dispose: () => void}>} */
  const mounted = new Map();
  /** What was shown before one plot was enlarged. @type {string[] | null} */
  let before = null;

  /** @param {string} id */
  function drop(id) {
    mounted.get(id)?.dispose();
    mounted.get(id)?.slot.remove();
    mounted.delete(id);
  }

  function layOut() {
    // Out of sight a plot has no size to draw in: it waits until the stage is shown.
    if (host.clientWidth === 0) return;
    const { show } = store.get().view;
    for (const id of [...mounted.keys()]) if (!show.includes(id)) drop(id);
    let next = null;
    for (const { id, mount } of plots.toReversed()) {
      if (!show.includes(id)) continue;
      if (!mounted.has(id)) {
        const slot = h("div", { class: takesRow(id) ? "slot row-slot" : "slot", "data-plot": id });
        host.insertBefore(slot, next);
        mounted.set(id, { slot, dispose: mount(slot, store, api) });
      }
      next = mounted.get(id)?.slot ?? null;
    }
    host.dataset["plots"] = String(show.filter((id) => !takesRow(id)).length);
  }

  /** @param {Event} event */
  function enlarge(event) {
    const { id } = /** @type {CustomEvent<{id: string}>} */ (event).detail;
    const { show } = store.get().view;
    const alone = show.length === 1;
    store.setView({ show: alone ? (before ?? plots.map((plot) => plot.id)) : [id] });
    before = alone ? null : show;
  }
  host.addEventListener("panel-expand", enlarge);
  const seen = new ResizeObserver(layOut);
  seen.observe(host);
  const stop = store.subscribe((_, change) => {
    if (change.view) layOut();
  });
  layOut();
  return () => {
    stop();
    seen.disconnect();
    host.removeEventListener("panel-expand", enlarge);
    for (const id of [...mounted.keys()]) drop(id);
  };
}
