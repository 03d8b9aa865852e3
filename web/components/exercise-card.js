/**
 * One exercise: number and title, what is asked, the answer, hints, the check, and the worked solution.
 * The kind of answer is the body's matter; what an answer is worth is the server's.
 */

/** @import {LabExercise, Status, Verdict} from "../core/lab/types.js" */

import { h, set, setText, uniqueId } from "./dom.js";
import { choiceBody } from "./exercise-choice.js";
import { designBody } from "./exercise-design.js";
import { numberBody } from "./exercise-number.js";
import { systemBody } from "./exercise-system.js";
import { icon } from "./icons.js";
import { showHtml } from "./rich-text.js";

/**
 * @typedef {object} Body
 * @property {HTMLElement} element
 * @property {() => any} answer
 * @property {(answer: any) => void} restore
 * @property {(verdict: Verdict) => void} show
 * @property {() => void} clear
 * @property {() => void} focus
 */

/**
 * @typedef {object} CardContext
 * @property {(answer: any) => Promise<Verdict>} check
 * @property {() => Promise<string>} solution
 * @property {(text: string) => Promise<string | null>} typeset
 * @property {import("./exercise-design.js").BenchOfDesign} bench
 * @property {{status: Status, answer: any} | null} before  what was answered on an earlier visit
 */

/** @type {Record<string, string>} */
const WORDS = { correct: "Correct", partly: "Partly right", wrong: "Not yet", unreadable: "Cannot be read", blank: "", revealed: "Solution shown" };

/** @param {LabExercise} exercise @param {CardContext} context */
export function exerciseCard(exercise, context) {
  const { id, number, title, points, type } = exercise;
  const titleId = uniqueId("exercise");
  const state = h("span", { class: "exercise-state" });
  const verdictLine = h("p", { class: "exercise-verdict", role: "status" });
  const trouble = h("p", { class: "exercise-trouble", role: "alert" });
  const button = h("button", { type: "submit", class: "button primary" }, type === "design" ? "Check what I built" : "Check");
  const onEdit = () => {
    if (root.dataset["status"] === "correct" || root.dataset["status"] === "revealed") return;
    body.clear();
    setStatus(null);
  };
  /** @type {Body} */
  const body = makeBody(exercise, { ...context, onEdit });
  const prompt = h("div", { class: "prose" });
  showHtml(prompt, exercise.prompt_html);
  const solution = solutionOf(context);
  const ask = h("button", { type: "button", class: "button", hidden: true, onclick: () => void reveal() }, "Show the solution");

  const form = h(
    "form",
    { class: "exercise-form", novalidate: true, onsubmit: (/** @type {Event} */ event) => void submit(event) },
    body.element,
    h("div", { class: "exercise-actions" }, button, ask, verdictLine),
    trouble,
  );
  const root = h(
    "section",
    { class: "exercise", id: `exercise-${id}`, "aria-labelledby": titleId, "data-type": type },
    h(
      "header",
      { class: "exercise-header" },
      h("span", { class: "exercise-number", "aria-hidden": "true" }, String(number)),
      h("h3", { id: titleId }, h("span", { class: "visually-hidden" }, `Exercise ${number}: `), title),
      state,
      h("span", { class: "exercise-points" }, `${points} ${points === 1 ? "point" : "points"}`),
    ),
    prompt,
    form,
    hintsOf(exercise.hints_html),
    solution.element,
  );

  /** @param {Status | null} status */
  function setStatus(status) {
    set(root, { "data-status": status });
    setText(verdictLine, status ? (WORDS[status] ?? "") : "");
    const done = status === "correct" || status === "revealed";
    state.replaceChildren(...(status === "correct" ? [icon("stable"), "Solved"] : status === "revealed" ? ["Solution shown"] : []));
    solution.element.hidden = !done;
    ask.hidden = done || status === null || status === "blank" || status === "unreadable";
  }

  /** @param {Event} event */
  async function submit(event) {
    event.preventDefault();
    if (button.getAttribute("aria-disabled")) return;
    set(button, { "aria-disabled": "true" });
    setText(trouble, "");
    try {
      const verdict = await context.check(body.answer());
      body.show(verdict);
      // A solved exercise stays solved, whatever is tried afterwards.
      const solved = root.dataset["status"] === "correct" && !verdict.correct;
      if (solved) setText(verdictLine, `${WORDS[verdict.status] ?? ""} this time; it stays solved.`);
      else if (root.dataset["status"] !== "revealed") setStatus(verdict.status);
      else setText(verdictLine, WORDS[verdict.status] ?? "");
    } catch (error) {
      const { message = "", hint = "" } = /** @type {any} */ (error);
      setText(trouble, [message, hint].filter(Boolean).join(" ") || "The answer could not be checked. Try again.");
    } finally {
      set(button, { "aria-disabled": null });
    }
  }

  async function reveal() {
    try {
      await solution.load();
      setStatus("revealed");
      solution.open();
    } catch (error) {
      setText(trouble, error instanceof Error ? error.message : "The solution could not be loaded.");
    }
  }

  if (context.before) {
    body.restore(context.before.answer);
    setStatus(context.before.status === "correct" || context.before.status === "revealed" ? context.before.status : null);
  }
  return { root };
}

/** @param {LabExercise} exercise @param {any} context @returns {Body} */
function makeBody(exercise, context) {
  if (exercise.type === "number") return numberBody(exercise, context);
  if (exercise.type === "choice") return choiceBody(exercise, context);
  return exercise.type === "design" ? designBody(exercise, context) : systemBody(exercise, context);
}

/** Hints come one at a time: the next opens when the one before was read. @param {string[]} hints */
function hintsOf(hints) {
  const holder = h("div", { class: "hints" });
  const items = hints.map((html, i) => {
    const words = h("div", { class: "prose" });
    showHtml(words, html);
    const name = hints.length > 1 ? `Hint ${i + 1} of ${hints.length}` : "Hint";
    const details = h("details", { class: "hint-box", hidden: i > 0 }, h("summary", {}, name), words);
    details.addEventListener("toggle", () => {
      const next = items[i + 1];
      if (details.open && next) next.hidden = false;
    });
    return details;
  });
  holder.append(...items);
  return holder;
}

/** @param {CardContext} context */
function solutionOf(context) {
  const words = h("div", { class: "prose" });
  const element = h("details", { class: "solution", hidden: true }, h("summary", {}, "Worked solution"), words);
  let loaded = false;
  async function load() {
    if (loaded) return;
    showHtml(words, await context.solution());
    loaded = true;
  }
  element.addEventListener("toggle", () => {
    if (element.open) load().catch(() => setText(words, "The solution could not be loaded. Close this and open it again."));
  });
  return {
    element,
    load,
    open: () => {
      element.open = true;
    },
  };
}
