/** `<design-cards>`: ways to a controller that is computed, each with a small picture and one sentence. */

import { h, svg } from "./dom.js";

/** @typedef {{href: string, title: string, says: string, picture: () => SVGElement[]}} DesignCard */

const path = (/** @type {string} */ d, kind = "line") => svg("path", { d, class: `pic-${kind}` });
const box = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ width, /** @type {number} */ height, label = "", kind = "box") =>
  svg("g", {}, svg("rect", { x, y, width, height, rx: 4, class: `pic-${kind}` }), svg("text", { x: x + width / 2, y: y + height / 2 + 5, class: "pic-text" }, label));
const cross = (/** @type {number} */ x, /** @type {number} */ y, kind = "cross") => path(`M${x - 5} ${y - 5}l10 10m0 -10l-10 10`, kind);

/** @type {DesignCard[]} */
const CARDS = [
  {
    href: "/pole-placement",
    title: "Pole placement",
    says: "Drag the closed-loop poles to where you want them, and get the controller that puts them there.",
    picture: () => [
      path("M20 60H220M160 12V108", "axis"),
      path("M160 60L82 12M160 60L82 108", "guide"),
      cross(138, 60, "from"),
      cross(112, 60, "from"),
      path("M134 52C126 34 116 30 104 32", "move"),
      path("M109 66C104 86 100 90 96 88", "move"),
      cross(98, 32),
      cross(98, 88),
      cross(48, 60),
    ],
  },
  {
    href: "/smith-predictor",
    title: "Smith predictor",
    says: "Take the dead time out of the loop with a model, and see how wrong that model may be.",
    picture: () => [
      path("M24 12V104H224", "axis"),
      path("M24 34H224", "guide"),
      path("M24 104H40C62 104 62 40 96 36S150 34 224 34", "ghost"),
      path("M24 104H96C118 104 118 40 152 36S190 34 224 34", "line"),
      path("M40 70H92m-6 -4l6 4l-6 4", "move"),
      svg("text", { x: 66, y: 63, class: "pic-text" }, "θ"),
    ],
  },
  {
    href: "/mimo",
    title: "Several loops",
    says: "Pair inputs with outputs, measure the interaction, and take it away with a decoupler.",
    picture: () => [
      path("M20 36H70M20 84H70", "line"),
      box(70, 20, 100, 80),
      path("M70 36H170M70 84H170", "line"),
      path("M74 38L166 82M74 82L166 38", "cross-talk"),
      path("M170 36H222m-6 -4l6 4l-6 4M170 84H222m-6 -4l6 4l-6 4", "line"),
    ],
  },
  {
    href: "/state-feedback",
    title: "State feedback",
    says: "Feed back every state, place the poles or weigh the costs, and estimate what is not measured.",
    picture: () => [
      path("M20 42H58", "line"),
      svg("circle", { cx: 66, cy: 42, r: 8, class: "pic-box" }),
      path("M74 42H96m-6 -4l6 4l-6 4M160 42H222m-6 -4l6 4l-6 4", "line"),
      box(96, 22, 64, 40, "A, B"),
      path("M128 62V88H116M128 74H128", "move"),
      box(86, 76, 30, 24, "K", "gain"),
      path("M86 88H66V52m-4 6l4 -6l4 6", "move"),
    ],
  },
];

class DesignCards extends HTMLElement {
  connectedCallback() {
    if (this.firstChild) return;
    this.append(
      h(
        "ul",
        { class: "design-cards" },
        ...CARDS.map(({ href, title, says, picture }) =>
          h(
            "li",
            { class: "design-card" },
            svg("svg", { viewBox: "0 0 240 120", class: "design-picture", "aria-hidden": "true", focusable: "false" }, ...picture()),
            h("h2", {}, h("a", { href }, title)),
            h("p", {}, says),
          ),
        ),
      ),
    );
  }
}

customElements.define("design-cards", DesignCards);
