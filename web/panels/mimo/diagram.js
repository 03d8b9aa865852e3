/** The block diagram of two loops, with the paths by which each moves the other's output. Larger ones have the matrix. */

/** @import {MimoStore} from "../../core/mimo/mimo.js" */

import { formatNumber } from "../../core/format.js";
import { openCard } from "../../components/card.js";
import { h, set, setText, svg } from "../../components/dom.js";

const ROW = [76, 244];
/** Heights of g11, g12, g21, g22. */
const PATHS = [76, 136, 184, 244];
const HEAD = "mimo-arrow";

/** @param {HTMLElement} host @param {MimoStore} store */
export function mount(host, store) {
  const wire = (/** @type {string} */ d, /** @type {string} */ signal, head = true) => svg("path", { d, class: `wire wire-${signal}`, "marker-end": head ? `url(#${HEAD})` : null });
  const text = (/** @type {number} */ x, /** @type {number} */ y, /** @type {string} */ words, kind = "wire-label") => svg("text", { x, y, class: kind }, words);
  const sum = (/** @type {number} */ x, /** @type {number} */ y) => svg("circle", { cx: x, cy: y, r: 9, class: "sum" });
  const node = (/** @type {number} */ x, /** @type {number} */ y, kind = "node") => svg("circle", { cx: x, cy: y, r: 3, class: kind });

  /** @param {string} card @param {{x: number, y: number, width: number, height: number}} box @param {Element[]} inside */
  const block = (card, box, inside) => {
    const open = () => openCard(card);
    return svg(
      "g",
      {
        class: "block",
        role: "button",
        tabindex: 0,
        onclick: open,
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key !== "Enter" && event.key !== " ") return;
          event.preventDefault();
          open();
        },
      },
      svg("rect", { ...box, rx: 5 }),
      ...inside,
    );
  };

  const controllers = ROW.map((y, i) => {
    const lines = [text(132, y - 4, `C${i + 1}`, "block-title"), text(132, y + 15, "", "block-value")];
    return { lines, root: block(`card-loop-${i + 1}`, { x: 84, y: y - 26, width: 96, height: 52 }, lines) };
  });
  const entries = PATHS.map((y, k) => {
    const lines = [text(396, y - 3, `g${k < 2 ? 1 : 2}${k % 2 === 0 ? 1 : 2}`, "block-title"), text(396, y + 14, "", "block-value")];
    return { lines, root: block("card-process", { x: 352, y: y - 21, width: 88, height: 42 }, lines) };
  });
  const levers = ROW.map(() => svg("path", { class: "wire wire-u" }));
  const lines = ROW.map(() => wire("", "u", false));
  const decoupler = svg("g", {}, svg("rect", { x: 226, y: 40, width: 26, height: 240, rx: 5, class: "mimo-decoupler" }), text(239, 166, "D", "block-title"));
  const [top = 76, low = 244] = ROW;
  const picture = svg(
    "svg",
    { viewBox: "0 0 600 322", class: "loop-diagram mimo-diagram", role: "group", "aria-label": "Block diagram of the two loops. Each block opens its card." },
    svg("defs", {}, svg("marker", { id: HEAD, viewBox: "0 0 10 10", refX: 9, refY: 5, markerWidth: 7, markerHeight: 7, orient: "auto-start-reverse" }, svg("path", { d: "M0 1 10 5 0 9z", class: "arrow-head" }))),
    wire(`M510 ${top}V24H52V${top - 10}`, "y"),
    wire(`M510 ${low}V300H52V${low + 10}`, "y"),
    ...ROW.flatMap((y, i) => [wire(`M20 ${y}H42`, "r"), wire(`M61 ${y}H83`, "e"), wire(`M180 ${y}H192`, "u", false), sum(52, y), text(12, y + 5, `r${i + 1}`), text(540, y - 9, `y${i + 1}`), text(306, y - 9, `u${i + 1}`)]),
    text(41, top - 12, "−", "sign"),
    text(41, low + 24, "−", "sign"),
    // Own paths in the colours of their signals, crossing ones in that of a disturbance, which they are to the other loop.
    wire(`M292 ${top}H351`, "u"),
    wire(`M292 ${low}H351`, "u"),
    wire(`M326 ${top}V184H351`, "d"),
    wire(`M338 ${low}V136H351`, "d"),
    node(326, top, "node mimo-node-u"),
    node(338, low, "node mimo-node-u"),
    wire(`M440 ${top}H471`, "y"),
    wire(`M440 ${low}H471`, "y"),
    wire(`M440 136H481V${top + 10}`, "d"),
    wire(`M440 184H481V${low - 10}`, "d"),
    sum(481, top),
    sum(481, low),
    wire(`M490 ${top}H572`, "y"),
    wire(`M490 ${low}H572`, "y"),
    node(510, top),
    node(510, low),
    ...lines,
    ...levers,
    decoupler,
    ...controllers.map(({ root }) => root),
    ...entries.map(({ root }) => root),
  );
  const root = h("section", { class: "mimo-picture", "aria-label": "Block diagram" }, h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Block diagram, scrolls sideways" }, picture));
  host.append(root);
  /** @type {number[][] | null} */
  let gains = null;

  function show() {
    const { loops, pairing, decoupler: kind, plant } = store.get();
    root.hidden = loops.length !== 2;
    if (root.hidden) return;
    const decoupled = kind !== "none";
    set(decoupler, { display: decoupled ? null : "none" });
    for (const [i, loop] of loops.entries()) {
      const y = ROW[i] ?? 0;
      const goal = ROW[pairing[i] ?? i] ?? 0;
      const open = loop.mode === "manual";
      const entry = decoupled ? 226 : 222;
      const exit = decoupled ? 252 : 222;
      set(/** @type {Element} */ (levers[i]), { d: open ? `M192 ${y}L${entry - 8} ${y - 14}` : `M192 ${y}H${entry}` });
      set(/** @type {Element} */ (lines[i]), { d: goal === y ? `M${exit} ${y}H292` : `M${exit} ${y}L284 ${goal}H292` });
      const own = controllers[i];
      if (!own) continue;
      const gain = `Kc ${loop.action === "direct" ? "−" : ""}${formatNumber(loop.Kc)}`;
      setText(/** @type {Element} */ (own.lines[1]), open ? "manual" : gain);
      own.root.classList.toggle("mimo-off", open);
      set(own.root, { "aria-label": `Controller ${i + 1}, ${loop.type}, ${gain}, ${open ? "manual" : "automatic"}, moves u${(pairing[i] ?? i) + 1}` });
    }
    for (const [k, { lines: words, root: group }] of entries.entries()) {
      const [i, j] = [k < 2 ? 0 : 1, k % 2];
      const gain = gains?.[i]?.[j];
      setText(/** @type {Element} */ (words[1]), gain === undefined ? "" : `K ${formatNumber(gain)}`);
      group.classList.toggle("mimo-paired", pairing[i] === j);
      set(group, { "aria-label": `From u${j + 1} to y${i + 1}${gain === undefined ? "" : `, gain ${formatNumber(gain)}`}${plant ? "" : ", typed"}` });
    }
  }
  store.subscribe(show);
  show();
  return {
    /** @param {number[][] | null} next  gains at rest */
    gains(next) {
      gains = next;
      show();
    },
  };
}
