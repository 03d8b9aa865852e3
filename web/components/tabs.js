/**
 * Tabs that are tabs only where the page is too narrow to show all panels at once; otherwise the bar is gone and
 * every panel is in sight. Each tab remembers how far its panel was scrolled.
 */

import { h, set, setText } from "./dom.js";

/**
 * @param {HTMLElement} host
 * @param {string} label
 * @param {{id: string, label: string, panel: HTMLElement}[]} items
 */
export function createTabs(host, label, items) {
  let selected = items[0]?.id ?? "";
  let used = false;
  /** @type {Map<string, number>} */
  const scrolled = new Map();

  const tabs = items.map((item) => {
    const note = h("small", { class: "tab-note" });
    const button = h("button", { type: "button", role: "tab", id: `tab-${item.id}`, "aria-controls": item.panel.id, onclick: () => select(item.id) }, h("span", {}, item.label), note);
    return { ...item, button, note };
  });
  const list = h("div", { class: "tab-list", role: "tablist", "aria-label": label, onkeydown: key }, ...tabs.map(({ button }) => button));
  host.replaceChildren(list);

  function show() {
    for (const { id, button, panel } of tabs) {
      const on = id === selected;
      set(button, { "aria-selected": String(on), tabindex: on ? 0 : -1 });
      panel.hidden = used && !on;
      set(panel, { role: used ? "tabpanel" : null, "aria-labelledby": used ? button.id : null });
    }
  }

  /** @param {string} id */
  function select(id) {
    if (!used || id === selected) return;
    scrolled.set(selected, scrollY);
    selected = id;
    show();
    scrollTo({ top: scrolled.get(id) ?? 0, behavior: "instant" });
  }

  /** @param {KeyboardEvent} event */
  function key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const at = tabs.findIndex(({ id }) => id === selected);
    const next = tabs[(at + step + tabs.length) % tabs.length];
    if (!next) return;
    select(next.id);
    next.button.focus();
  }

  return {
    select,
    /** @param {boolean} on */
    use(on) {
      used = on;
      host.hidden = !on;
      show();
    },
    /** A word beside a tab's label. @param {string} id @param {string} text */
    note(id, text) {
      const tab = tabs.find((one) => one.id === id);
      if (tab) setText(tab.note, text);
    },
  };
}
