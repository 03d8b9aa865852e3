/** From where the feedback catches the plant: asked of the server row by row, with the start as a handle on it. */

/** @import {Api} from "../../core/api.js" */
/** @import {FeedbackSession} from "../../core/state-feedback/session.js" */
/** @import {MapAxis} from "../../core/state-feedback/plants.js" */
/** @import {MapSide, OutcomeLook} from "../../plots/state-feedback/map.js" */
/** @import {Table} from "../../core/types.js" */

import { designRequest, mapRequest } from "../../core/state-feedback/feedback.js";
import { formatNumber, sentence } from "../../core/format.js";
import { tidy } from "../../core/scale.js";
import { h, setText } from "../../components/dom.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createPlaneHandle } from "../../components/plane-handle.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { feedbackMapPlot } from "../../plots/state-feedback/map.js";

const COLUMNS = 29;
const ROWS = 21;
const BAND = 3;
/** A press that moves no farther than this, in px, is a click. */
const CLICK = 4;

/** @type {Record<string, OutcomeLook>} */
const LOOKS = {
  caught: { outcome: "caught", label: "caught", kind: "caught" },
  fallen: { outcome: "fallen", label: "fell", kind: "lost" },
  end_of_track: { outcome: "end_of_track", label: "off the track", kind: "left" },
  stopped: { outcome: "stopped", label: "stopped", kind: "lost" },
  unsettled: { outcome: "unsettled", label: "not at rest", kind: "open" },
};

/** @param {HTMLElement} host @param {FeedbackSession} session @param {Api} api */
export function mount(host, session, api) {
  const start = h("button", { type: "button", class: "button primary", onclick: () => void explore() }, "Map the region");
  const bar = h("progress", { max: ROWS, value: 0, "aria-label": "Rows of the map", hidden: true });
  const status = h("span", { class: "field-hint", role: "status" });
  /** @type {import("../../plots/figure.js").FigureHandle | null} */
  let figure = null;
  const frame = createPanelFrame(host, {
    id: "feedback-map",
    title: "From where is it caught?",
    help: "Every mark is one run of the nonlinear plant, begun at that tilt and that speed of turning. Click in the map, or move the square, to run from there. The line is the boundary of what this feedback, this motor and this track can catch.",
    figure(element) {
      figure = createFigure(element);
      element.addEventListener("figure-drawn", () => handle.place());
      return figure;
    },
    table,
  });
  const plot = /** @type {HTMLElement} */ (frame.root.querySelector(".plot"));
  frame.root.append(h("div", { class: "feedback-map-bar" }, start, bar, status));
  let theme = readTheme();
  /** @type {(string | null)[][]} */
  let outcomes = empty();
  let mapped = "";
  let running = 0;
  onThemeChange(() => {
    theme = readTheme();
    draw();
  });

  function empty() {
    return Array.from({ length: ROWS }, () => Array.from({ length: COLUMNS }, () => /** @type {string | null} */ (null)));
  }
  const key = () => JSON.stringify([designRequest(session.state), session.state.limit]);
  /** @param {MapAxis} side @param {number} count */
  const spread = ({ low, high }, count) => Array.from({ length: count }, (_, i) => low + ((high - low) * i) / (count - 1));
  const factorOf = (/** @type {string} */ state) => session.profile.tilts.find((tilt) => tilt.state === state)?.factor ?? 1;

  /** @returns {{sides: [MapAxis, MapAxis], x: MapSide, y: MapSide, factors: [number, number]} | null} */
  function sides() {
    const { map, tilts } = session.profile;
    if (!map) return null;
    const side = (/** @type {MapAxis} */ each, /** @type {number} */ count) => {
      const tilt = tilts.find(({ state }) => state === each.state);
      return { label: tilt?.label.toLowerCase() ?? each.state, unit: tilt?.unit ?? "", values: spread(each, count).map((value) => value * factorOf(each.state)) };
    };
    return { sides: map, x: side(map[0], COLUMNS), y: side(map[1], ROWS), factors: [factorOf(map[0].state), factorOf(map[1].state)] };
  }

  /** @param {{x: number, y: number}} value @param {boolean} moving */
  function begin({ x, y }, moving) {
    const found = sides();
    if (!found) return;
    const [across, up] = found.sides;
    session.set({ start: { ...session.state.start, [across.state]: tidy(x) / found.factors[0], [up.state]: tidy(y) / found.factors[1] } }, { moving });
    if (!moving) session.letGo();
  }

  const handle = createPlaneHandle({
    toPixels: (value) => figure?.pixelsOf(value) ?? null,
    toValues: (pixels) => figure?.valuesAt(pixels) ?? null,
    step(value, across, up) {
      const found = sides();
      const width = (/** @type {number[]} */ values) => ((values.at(-1) ?? 1) - (values[0] ?? 0)) / 100;
      return found ? { x: value.x + across * width(found.x.values), y: value.y + up * width(found.y.values) } : value;
    },
    describe({ x, y }) {
      const found = sides();
      return `Start: ${found?.x.label} ${formatNumber(x)} ${found?.x.unit}, ${found?.y.label} ${formatNumber(y)} ${found?.y.unit}. Arrow keys move it and run from there.`;
    },
    onMove: begin,
  });
  plot.parentElement?.append(handle.root);
  let pressed = { x: 0, y: 0 };
  plot.addEventListener("pointerdown", (event) => (pressed = { x: event.clientX, y: event.clientY }));
  plot.addEventListener("click", (event) => {
    if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK) return;
    const box = plot.getBoundingClientRect();
    const value = figure?.valuesAt({ x: event.clientX - box.left, y: event.clientY - box.top });
    if (value) begin(value, false);
  });

  function looks() {
    const found = new Set(outcomes.flat());
    return Object.values(LOOKS).filter(({ outcome }) => found.has(outcome)).concat([...found].filter((outcome) => outcome !== null && !(outcome in LOOKS)).map((outcome) => ({ outcome: String(outcome), label: String(outcome).replaceAll("_", " "), kind: "left" })));
  }

  function draw() {
    const found = sides();
    frame.root.hidden = found === null;
    if (!found) return;
    // A fixed number of traces: what has not been met yet is one without points.
    const met = looks();
    const all = Object.values(LOOKS).concat(met.filter(({ outcome }) => !(outcome in LOOKS)));
    frame.show(feedbackMapPlot({ x: found.x, y: found.y, outcomes, looks: all }, theme), false);
    const count = outcomes.flat().filter((outcome) => outcome === "caught").length;
    frame.tell(`Map of ${ROWS * COLUMNS} starts: ${count} are caught.`, [
      ...met.map(({ label, kind }) => ({ signal: kind === "caught" ? "stable" : kind === "lost" ? "unstable" : kind === "left" ? "u" : "rule", label, name: `runs that end so`, glyph: kind === "caught" ? "●" : kind === "lost" ? "×" : kind === "left" ? "–" : "○" })),
    ]);
  }

  /** @returns {Table | null} */
  function table() {
    const found = sides();
    if (!found) return null;
    return { header: [found.x.label, found.y.label, "ends"], rows: outcomes.flatMap((row, j) => row.flatMap((outcome, i) => (outcome === null ? [] : [[found.x.values[i] ?? 0, found.y.values[j] ?? 0, outcome]]))) };
  }

  async function explore() {
    const { design, state } = session;
    const found = sides();
    if (!design || !found) return;
    const mine = (running += 1);
    mapped = key();
    outcomes = empty();
    frame.root.classList.remove("stale");
    bar.hidden = false;
    bar.value = 0;
    const values = spread(found.sides[1], ROWS);
    // From the middle outwards: what is caught shows first.
    const bands = Array.from({ length: ROWS / BAND }, (_, k) => k * BAND).toSorted((a, b) => Math.abs(a + 1 - ROWS / 2) - Math.abs(b + 1 - ROWS / 2));
    for (const first of bands) {
      setText(status, `${bar.value} of ${ROWS} rows`);
      try {
        const answer = await api.analyse("state-feedback/region", mapRequest(state, design, { columns: COLUMNS, rows: [values[first] ?? 0, values[first + BAND - 1] ?? 0, BAND] }));
        if (mine !== running || mapped !== key()) break;
        answer.outcomes.forEach((/** @type {string[]} */ row, /** @type {number} */ k) => (outcomes[first + k] = row));
        bar.value += BAND;
        draw();
      } catch (error) {
        setText(status, sentence(/** @type {Error} */ (error).message));
        bar.hidden = true;
        return;
      }
    }
    if (mine !== running) return;
    bar.hidden = true;
    refresh();
  }

  function refresh() {
    const found = sides();
    frame.root.hidden = found === null;
    if (!found) return;
    const old = mapped !== "" && mapped !== key();
    frame.root.classList.toggle("stale", old);
    setText(start, mapped === "" ? "Map the region" : "Map again");
    if (bar.hidden || old) setText(status, mapped === "" ? `${ROWS * COLUMNS} runs, a few seconds.` : old ? "The design has changed since." : "Click in it, or move the square, to run from there.");
    const [across, up] = found.sides;
    handle.show({ x: (session.state.start[across.state] ?? 0) * found.factors[0], y: (session.state.start[up.state] ?? 0) * found.factors[1] });
  }

  return {
    /** @param {{anew: boolean}} how */
    refresh({ anew }) {
      if (anew) {
        running += 1;
        mapped = "";
        outcomes = empty();
        bar.hidden = true;
        draw();
      }
      refresh();
    },
  };
}
