/** One step of a page that leads from one thing to the next: a number, a heading, what to do, and where things stand. */

import { sentence } from "../core/format.js";
import { h, setText } from "./dom.js";

/** @typedef {ReturnType<typeof createStep>} Step */

/**
 * @param {HTMLElement} host
 * @param {{id: string, number: number, title: string, lead: string}} options
 */
export function createStep(host, { id, number, title, lead }) {
  const message = h("p", { class: "step-message", role: "status" });
  const side = h("div", { class: "step-side" });
  const stage = h("div", { class: "step-stage" });
  const root = h(
    "section",
    { class: "step", id: `step-${id}`, "aria-labelledby": `step-${id}-title`, tabindex: "-1" },
    h("header", { class: "step-head" }, h("span", { class: "step-number", "aria-hidden": "true" }, String(number)), h("h2", { id: `step-${id}-title` }, title), h("p", {}, lead)),
    h("div", { class: "step-grid" }, side, stage),
  );
  host.append(root);
  return {
    root,
    side,
    stage,
    message,
    /** @param {string} text @param {boolean} [wrong] */
    say(text, wrong = false) {
      setText(message, text);
      message.classList.toggle("wrong", wrong);
    },
    /** @param {any} error */
    complain({ message: text, hint }) {
      this.say([text, hint].map(sentence).filter(Boolean).join(" "), true);
    },
  };
}

/**
 * The steps as a bar that stays in sight: each a link, with a tick once it has given something and what that is.
 * @param {HTMLElement} host
 * @param {{id: string, label: string}[]} steps
 */
export function createStepBar(host, steps) {
  const items = new Map(
    steps.map(({ id, label }, k) => {
      const found = h("small", {});
      const link = h("a", { href: `#step-${id}` }, h("span", { class: "step-number", "aria-hidden": "true" }, String(k + 1)), h("span", { class: "step-name" }, label, found));
      return [id, { link, found, item: h("li", {}, link) }];
    }),
  );
  host.append(h("nav", { class: "step-bar", "aria-label": "Steps" }, h("ol", {}, ...[...items.values()].map(({ item }) => item))));
  return {
    /** @param {string} id @param {string | null} found  null where the step is still to do */
    show(id, found) {
      const step = items.get(id);
      if (!step) return;
      step.item.classList.toggle("done", found !== null);
      setText(step.found, found ?? "");
    },
  };
}
