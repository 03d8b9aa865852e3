/** The reading column of a lab: what it is about, its parts with texts and exercises, and how far one has come. */

/** @import {Api} from "../../core/api.js" */
/** @import {Progress} from "../../core/lab/progress.js" */
/** @import {Lab, LabExercise, LabPart, LabText} from "../../core/lab/types.js" */
/** @import {Store} from "../../core/store.js" */

import { inWords, settingsOf, withSettings } from "../../core/lab/bench.js";
import { sameDesign } from "../../core/store.js";
import { h, setText } from "../../components/dom.js";
import { exerciseCard } from "../../components/exercise-card.js";
import { icon } from "../../components/icons.js";
import { showHtml } from "../../components/rich-text.js";
import { toast } from "../../components/status-toast.js";

/** @typedef {{lab: Lab, progress: Progress, goToBench: () => void, startOver: () => void}} ReadingOptions */

/** @param {LabText | LabExercise} block @returns {block is LabExercise} */
const isExercise = (block) => block.type !== "text";

/**
 * @param {HTMLElement} host
 * @param {Store} store
 * @param {Api} api
 * @param {ReadingOptions} options
 * @returns {() => void}
 */
export function mount(host, store, api, options) {
  const { lab, progress } = options;
  /** @type {(() => void)[]} */
  const stops = [];
  const exercises = lab.parts.flatMap(({ blocks }) => blocks.filter(isExercise));

  const outline = lab.parts.map((part, i) => outlineItem(part, i));
  const bar = h("progress", { max: exercises.length, value: 0, "aria-label": "Exercises solved" });
  const tally = h("span", { class: "tally", role: "status" });
  const objectives = lab.objectives_html.map((html) => {
    const item = h("li", {});
    showHtml(item, html);
    return item;
  });
  const done = h("section", { class: "lab-end", "aria-label": "How far you are" });

  const root = h(
    "article",
    { class: "reading", "aria-labelledby": "lab-title" },
    h(
      "header",
      { class: "lab-head" },
      h("p", { class: "lab-facts" }, h("a", { href: "/labs" }, "Labs"), ` · ${lab.level} · notes §${lab.section} · ${lab.minutes} min`),
      h("h1", { id: "lab-title" }, lab.title),
      h("p", { class: "lead" }, lab.summary),
      h("h2", { class: "small-heading" }, "You will be able to"),
      h("ul", { class: "objectives" }, ...objectives),
      h("nav", { class: "outline", "aria-label": "Parts of the lab" }, h("ol", {}, ...outline.map(({ element }) => element)), h("p", { class: "progress-line" }, bar, tally)),
    ),
    ...lab.parts.map((part, i) => partSection(part, i, store, api, options, stops)),
    done,
  );
  host.append(root);

  function show() {
    const { solved, of, points, ofPoints } = progress.sum(exercises);
    bar.value = solved;
    setText(tally, `${solved} of ${of} solved`);
    for (const { show: showItem } of outline) showItem(progress);
    const all = solved === of;
    done.replaceChildren(
      h("h2", {}, all ? "All solved" : "How far you are"),
      h("p", {}, `${solved} of ${of} exercises solved, ${round(points)} of ${round(ofPoints)} points. Your answers are kept in this browser.`),
      h(
        "p",
        { class: "row" },
        h("a", { class: "button", href: "/labs" }, "All labs"),
        solved + Object.keys(progress.saved.exercises).length > 0 ? h("button", { type: "button", class: "button", onclick: options.startOver }, "Start over") : "",
      ),
    );
  }
  stops.push(progress.subscribe(show));
  show();
  return () => {
    for (const stop of stops) stop();
    root.remove();
  };
}

/** @param {number} points */
const round = (points) => String(Math.round(points * 10) / 10);

/** @param {LabPart} part @param {number} index */
function outlineItem({ id, title, blocks }, index) {
  const ids = blocks.filter(isExercise).map((one) => one.id);
  const state = h("span", { class: "outline-state" });
  const element = h("li", {}, h("a", { href: `#part-${id}` }, h("span", { class: "outline-number", "aria-hidden": "true" }, String(index + 1)), h("span", {}, title)), state);
  return {
    element,
    /** @param {Progress} progress */
    show(progress) {
      const solved = ids.filter((name) => progress.of(name)?.status === "correct").length;
      const all = solved === ids.length && ids.length > 0;
      element.classList.toggle("done", all);
      const words = h("span", {}, `${solved}/${ids.length}`, h("span", { class: "visually-hidden" }, " solved"));
      state.replaceChildren(...(ids.length === 0 ? [] : all ? [icon("stable"), h("span", { class: "visually-hidden" }, "all solved")] : [words]));
    },
  };
}

/**
 * @param {LabPart} part
 * @param {number} index
 * @param {Store} store
 * @param {Api} api
 * @param {ReadingOptions} options
 * @param {(() => void)[]} stops
 */
function partSection(part, index, store, api, options, stops) {
  const { lab } = options;
  const heading = h("h2", { id: `part-${part.id}-title` }, h("span", { class: "part-number", "aria-hidden": "true" }, String(index + 1)), part.title);
  const { settings } = part;
  const preset = settings
    ? h(
        "button",
        {
          type: "button",
          class: "button preset",
          onclick: () => {
            const before = store.get();
            store.setController(withSettings(before.controller, settings));
            const undo = { label: "Undo", run: () => store.undo() };
            toast().say(`The bench stands at ${inWords(settings, lab.bench.sliders)}.`, sameDesign(before, store.get()) ? {} : { action: undo });
          },
        },
        `Set the bench to ${inWords(settings, lab.bench.sliders)}`,
      )
    : "";
  return h(
    "section",
    { class: "part", id: `part-${part.id}`, "aria-labelledby": `part-${part.id}-title` },
    heading,
    ...part.blocks.map((block, i) => {
      if (isExercise(block)) return exercise(block, store, api, options, stops);
      const prose = h("div", { class: "prose" });
      showHtml(prose, block.html);
      // The offer to set the bench stands after the words that ask for it.
      return i === 0 && preset ? h("div", {}, prose, preset) : prose;
    }),
  );
}

/**
 * @param {LabExercise} block
 * @param {Store} store
 * @param {Api} api
 * @param {ReadingOptions} options
 * @param {(() => void)[]} stops
 */
function exercise(block, store, api, { lab, progress, goToBench }, stops) {
  const { sliders } = lab.bench;
  const settings = () => settingsOf(store.get().controller, sliders);
  const { root } = exerciseCard(block, {
    before: progress.of(block.id),
    async check(answer) {
      const verdict = await api.check(lab.id, { exercise: block.id, answer });
      progress.record(block.id, verdict.status, verdict.score, answer);
      return verdict;
    },
    async solution() {
      const { solution_html: html } = await api.check(lab.id, { exercise: block.id, reveal: true });
      progress.record(block.id, "revealed", 0, null);
      return html;
    },
    async typeset(text) {
      try {
        const { plant } = await api.loop({ loop: { plant: { type: "expr", text }, controller: { type: "pid", Kc: 1 } }, want: [] });
        return plant.mathml;
      } catch {
        return null;
      }
    },
    bench: {
      settings,
      inWords: () => inWords(settings(), sliders),
      apply: (values) => store.setController(withSettings(store.get().controller, values)),
      onChange: (listener) => stops.push(store.subscribe(listener)),
      goTo: goToBench,
    },
  });
  return root;
}
