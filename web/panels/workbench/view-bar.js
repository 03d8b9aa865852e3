/** What is on the stage, in two groups: on a wide page any number of plots and analyses, on a narrow one a list to pick one from. */

/** @import {Api} from "../../core/api.js" */
/** @import {ViewItem} from "../../core/workbench/plots.js" */
/** @import {Store} from "../../core/store.js" */

import { PLOTS } from "../../core/workbench/plots.js";
import { h, uniqueId } from "../../components/dom.js";
import { createSelectField } from "../../components/select-field.js";

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} _api
 * @param {{narrow: () => boolean, plots?: ViewItem[], analyses?: ViewItem[]}} options
 * @returns {() => void}
 */
export function mount(host, store, _api, { narrow, plots = PLOTS, analyses = [] }) {
  const order = [...plots, ...analyses].map(({ id }) => id);

  /** @param {string} id */
  function toggle(id) {
    const { show } = store.get().view;
    if (narrow()) store.setView({ show: [id] });
    else if (show.includes(id)) store.setView({ show: show.length > 1 ? show.filter((name) => name !== id) : show });
    else store.setView({ show: order.filter((name) => name === id || show.includes(name)) });
  }

  /** @type {{id: string, button: HTMLButtonElement}[]} */
  const buttons = [];
  /** @param {string} label @param {ViewItem[]} items */
  const group = (label, items) => {
    const name = h("span", { class: "view-group-name", id: uniqueId("views") }, label);
    const made = items.map(({ id, label: text }) => ({ id, button: h("button", { type: "button", class: "view-toggle", onclick: () => toggle(id) }, text) }));
    buttons.push(...made);
    return h("div", { class: "view-group", role: "group", "aria-labelledby": name.id }, name, ...made.map(({ button }) => button));
  };

  const groups = [{ label: "Plots", items: plots }, { label: "Analyses", items: analyses }].filter(({ items }) => items.length > 0);
  const bar = h("div", { class: "view-bar" }, ...groups.map(({ label, items }) => group(label, items)));
  const list = createSelectField({
    label: "Show",
    groups: groups.map(({ label, items }) => ({ label, choices: items.map(({ id, label: text }) => ({ value: id, label: text })) })),
    onChoice: (id) => store.setView({ show: [id] }),
  });
  // With one group the buttons fit a narrow page too, and scroll where they do not.
  const both = groups.length > 1;
  bar.classList.toggle("with-list", both);
  list.root.classList.add("view-list");
  host.append(bar, ...(both ? [list.root] : []));

  function showPressed() {
    const { show } = store.get().view;
    for (const { id, button } of buttons) button.setAttribute("aria-pressed", String(show.includes(id)));
    list.show(show[0] ?? "");
  }
  const stop = store.subscribe(showPressed);
  showPressed();
  return () => {
    stop();
    bar.remove();
    list.root.remove();
  };
}
