/** Undo, redo, link, and responses kept to compare with. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { formatNumber } from "../../core/format.js";
import { hasDerivative, hasIntegral } from "../../core/workbench/loop.js";
import { h } from "../../components/dom.js";
import { icon } from "../../components/icons.js";
import { toast } from "../../components/status-toast.js";
import { bindUndoKeys } from "../../components/undo-keys.js";

const MOST_KEPT = 4;

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} _api
 * @param {{link?: boolean}} [options]  link: whether the address bar holds the loop
 * @returns {() => void}
 */
export function mount(host, store, _api, { link: linked = true } = {}) {
  const button = (/** @type {string} */ picture, /** @type {string} */ label, /** @type {string} */ title, /** @type {() => void} */ run) =>
    h("button", { type: "button", class: "icon-button", "aria-label": label, title, onclick: run }, icon(picture));
  const undo = button("undo", "Undo", "Undo (Ctrl+Z)", () => store.undo());
  const redo = button("redo", "Redo", "Redo (Ctrl+Shift+Z)", () => store.redo());
  const link = button("link", "Copy link", "Copy a link to this loop", () => void copyLink());
  const keep = h("button", { type: "button", class: "button keep", title: "Keep this response to compare with" }, icon("keep"), "Keep");
  const kept = h("ul", { class: "kept", "aria-label": "Kept responses" });
  const root = h("div", { class: "actions", role: "group", "aria-label": "History" }, kept, keep, undo, redo, linked ? link : "");
  host.append(root);

  keep.addEventListener("click", () => {
    if (!store.answers.panels.step) return;
    if (store.snapshots.length >= MOST_KEPT) store.drop(/** @type {{id: number}} */ (store.snapshots[0]).id);
    store.keep(currentName());
  });

  function currentName() {
    const { type, Kc, tau_I, tau_D } = store.get().controller;
    return [type, `Kc ${formatNumber(Kc)}`, hasIntegral(type) ? `τI ${formatNumber(tau_I)}` : "", hasDerivative(type) ? `τD ${formatNumber(tau_D)}` : ""].filter(Boolean).join(" ");
  }

  async function copyLink() {
    try {
      await navigator.clipboard.writeText(location.href);
      toast().say("Link copied: it opens this very loop.");
    } catch {
      toast().say("The browser does not allow copying; the address bar holds the link.");
    }
  }

  const unbind = bindUndoKeys(store);

  function show() {
    undo.disabled = !store.canUndo;
    redo.disabled = !store.canRedo;
    const now = store.snapshots.map(({ id }) => id).join();
    if (kept.dataset["shown"] === now) return;
    kept.dataset["shown"] = now;
    kept.replaceChildren(
      ...store.snapshots.map(({ id, name: words }) =>
        h(
          "li",
          {},
          h("button", { type: "button", class: "kept-name", title: "Go back to it", onclick: () => store.restore(id) }, words),
          h("button", { type: "button", class: "kept-drop", "aria-label": `Drop ${words}`, onclick: () => store.drop(id) }, icon("close")),
        ),
      ),
    );
  }
  const stop = store.subscribe(show);
  show();
  return () => {
    unbind();
    stop();
    root.remove();
  };
}
