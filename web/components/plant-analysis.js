/**
 * An analysis of a plant: a panel with its form, asked for at a press and from then on at rest whenever the plant is
 * set to something else. The panel itself says what to ask and what to show.
 */

/** @import {PlantBench} from "../core/plant/bench.js" */
/** @import {Figure, Ranges, Table, Theme} from "../core/types.js" */
/** @import {FigureLike, LegendItem} from "./panel-frame.js" */

import { sentence } from "../core/format.js";
import { createTransport } from "../core/transport.js";
import { h, setText } from "./dom.js";
import { createPanelFrame } from "./panel-frame.js";
import { onThemeChange, readTheme } from "./theme.js";

const REST_MS = 250;

/**
 * @typedef {object} PlantAnalysis
 * @property {string} id
 * @property {string} title
 * @property {string} help
 * @property {string | null} action  what the button says; null where the panel asks by itself
 * @property {(request: any) => Promise<any>} send
 * @property {() => object | null} request  null while the form is not good; what the plant is set to is added
 * @property {HTMLElement[]} [form]
 * @property {((element: HTMLElement) => FigureLike) | null} figure
 * @property {(answer: any, theme: Theme, held: {ranges: Ranges, moving: boolean}) => Figure | null} [draw]
 * @property {(answer: any) => Node[]} [words]  what is said below the plot
 * @property {(answer: any) => Table | null} table
 * @property {(answer: any) => string} describe
 * @property {(answer: any) => LegendItem[]} [legend]
 * @property {(answer: any) => void} [onAnswer]
 * @property {boolean} [follows]  asks again when the plant is set to something else
 */

/** @param {HTMLElement} host @param {Pick<PlantBench, "subscribe"> & {request: () => object}} bench @param {PlantAnalysis} options */
export function mountPlantAnalysis(host, bench, options) {
  /** @type {any} */
  let answer = null;
  let asked = false;
  let rest = 0;
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  const message = h("p", { class: "analysis-status", role: "status" });
  const words = h("div", { class: "plant-words" });
  const button = options.action === null ? null : h("button", { type: "button", class: "button primary", onclick: () => ask() }, options.action);
  const form = h("div", { class: "plant-form" }, ...(options.form ?? []), button, message);
  const frame = createPanelFrame(host, {
    id: options.id,
    title: options.title,
    help: options.help,
    figure: options.figure,
    table: () => (answer ? options.table(answer) : null),
    arrange: ({ header, body, note }) => [header, form, ...(options.figure ? [body] : []), words, note],
  });
  frame.root.classList.add("plant-analysis");

  /** @param {any} error */
  function complain(error) {
    setText(message, [sentence(error.message), sentence(error.hint)].join(" ").trim());
    frame.root.classList.add("stale");
  }

  const transport = createTransport({
    send: options.send,
    onAnswer(next) {
      answer = next;
      setText(message, "");
      frame.root.classList.remove("stale");
      frame.root.classList.add("answered");
      options.onAnswer?.(answer);
      draw(false);
    },
    onError: complain,
    retryAfter: (error) => error.retryAfter ?? null,
  });

  function ask() {
    const own = options.request();
    if (!own) return;
    asked = true;
    if (!answer) setText(message, "Working it out…");
    transport.push({ ...bench.request(), ...own });
  }

  /** @param {boolean} moving */
  function draw(moving) {
    if (!answer) return;
    const figure = options.draw?.(answer, theme, { ranges, moving });
    if (figure) {
      ranges = figure.ranges;
      frame.show(figure, moving);
    }
    words.replaceChildren(...(options.words?.(answer) ?? []));
    frame.tell(options.describe(answer), options.legend?.(answer) ?? []);
  }

  /** Asks again once things have come to rest; nothing before the first press. */
  function again() {
    clearTimeout(rest);
    if (asked) rest = window.setTimeout(ask, REST_MS);
  }
  if (options.follows ?? true) bench.subscribe(again);
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });

  return {
    root: frame.root,
    ask,
    again,
    complain,
    get answer() {
      return answer;
    },
    /** @param {{refit?: boolean}} [how] */
    redraw({ refit = false } = {}) {
      if (refit) ranges = {};
      draw(false);
    },
  };
}
