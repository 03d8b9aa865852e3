/** Step 3, what the model is read off: the record of the step test, or a file or text of one's own. */

/** @import {Api} from "../../core/api.js" */
/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {Step} from "../../components/step-section.js" */

import { patiently } from "../../core/patience.js";
import { h, setText } from "../../components/dom.js";
import { choice, fieldRow, number } from "../../components/form-parts.js";

const TYPING_MS = 500;
/** So much of a line that cannot be read is shown. */
const SHOWN = 60;
/** As much as the server takes. */
const MAX_BYTES = 2 * 1024 * 1024;
const SAMPLE = "time [min]; valve [%]; T [°C]\n0; 20; 60,1\n1; 20; 60,0\n2; 25; 60,0\n…";
const HINT = "Three columns: time, input, output. Commas, semicolons or tabs; decimal commas, units in the header and gaps are fine.";

/** Names in the first line that is not empty or a remark, however they are parted. @param {string} text */
export function headerOf(text) {
  const line = text.replace(/^\uFEFF/, "").split(/\r?\n/).find((each) => each.trim() !== "" && !/^\s*(#|%|!|\/\/)/.test(each)) ?? "";
  const mark = [";", "\t", ","].find((each) => line.includes(each)) ?? ",";
  return line.split(mark).map((cell) => cell.trim().replace(/^"|"$/g, ""));
}

/** Text of a file: UTF-8, or what older spreadsheets write. @param {ArrayBuffer} bytes */
function decoded(bytes) {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/** @param {Step} step @param {ExperimentBench} bench @param {Api} api */
export function mount(step, bench, api) {
  let asked = 0;
  let typing = 0;
  const origin = h("p", { class: "field-hint" });
  const text = h("textarea", { class: "record-text", rows: 6, placeholder: SAMPLE, spellcheck: "false", "aria-label": "Record as text", "aria-describedby": "record-hint" });
  const file = h("input", { type: "file", accept: ".csv,.txt,.tsv,.dat,text/*", class: "visually-hidden", tabindex: -1, "aria-hidden": "true" });
  const pickFile = h("button", { type: "button", class: "button", onclick: () => file.click() }, "Choose a file");
  const back = h("button", { type: "button", class: "button", hidden: true, onclick: () => bench.finish() }, "Back to the step test");
  const earlier = number("u before the record, if it begins with the step", { value: null, optional: true }, () => take());
  const columns = h("div", { class: "step-fields" });
  const own = h(
    "details",
    { class: "step-fold record-drop" },
    h("summary", {}, "Use a record of your own"),
    h("div", { class: "step-fields" }, h("p", { class: "field-hint", id: "record-hint" }, HINT), text, h("div", { class: "row" }, pickFile, file, h("span", { class: "field-hint" }, "or drop it here")), columns, earlier),
  );
  step.side.append(origin, back, own, step.message);

  /** @param {{t: string, u: string, y: string} | null} [named] */
  function take(named = null) {
    clearTimeout(typing);
    if (text.value.trim() === "") return;
    bench.setSource({ from: "text", data: null, csv: text.value, columns: named, u_before: earlier.value, timeUnit: "", inputUnit: "", outputUnit: "", inputName: "u", outputName: "y" });
  }
  text.addEventListener("input", () => {
    clearTimeout(typing);
    typing = window.setTimeout(() => take(), TYPING_MS);
  });
  text.addEventListener("change", () => text.value !== bench.source?.csv && take());

  /** @param {File | null | undefined} chosen */
  async function open(chosen) {
    if (!chosen) return;
    own.open = true;
    if (chosen.size > MAX_BYTES) return step.say("The file is larger than 2 MiB: send a part of it.", true);
    text.value = decoded(await chosen.arrayBuffer());
    take();
  }
  file.addEventListener("change", () => {
    void open(file.files?.[0]);
    file.value = "";
  });
  own.addEventListener("dragover", (event) => {
    event.preventDefault();
    own.classList.add("dropping");
  });
  own.addEventListener("dragleave", () => own.classList.remove("dropping"));
  own.addEventListener("drop", (event) => {
    event.preventDefault();
    own.classList.remove("dropping");
    void open(event.dataTransfer?.files[0]);
  });

  /** Where the header leaves doubt, which column is which. */
  function offerColumns() {
    const names = headerOf(text.value);
    const choices = names.map((name) => ({ value: name, label: name }));
    const [t, u, y] = ["time t", "input u", "output y"].map((label, k) => {
      const field = choice(label, choices, () => {});
      field.value = names[Math.min(k, names.length - 1)] ?? "";
      return field;
    });
    if (!t || !u || !y) return;
    columns.replaceChildren(fieldRow(t.root, u.root, y.root), h("button", { type: "button", class: "button", onclick: () => take({ t: t.value, u: u.value, y: y.value }) }, "Read these columns"));
  }

  /** Shows the line that the server names. @param {string} csv @param {string} message */
  function point(csv, message) {
    const place = Number(/^line (\d+)/.exec(message)?.[1]);
    const lines = csv.split(/\r\n|\r|\n/);
    const bad = lines[place - 1];
    if (bad === undefined) return;
    step.say(`${step.message.textContent} It reads: ${bad.slice(0, SHOWN)}${bad.length > SHOWN ? "…" : ""}`, true);
    const before = lines.slice(0, place - 1).reduce((sum, line) => sum + line.length + 1, 0);
    text.setSelectionRange(before, before + bad.length);
    text.scrollTop = Math.max(0, place - 3) * (text.scrollHeight / lines.length);
  }

  async function ask() {
    const { source } = bench;
    const now = (asked += 1);
    step.say("");
    if (!source || bench.identified) return;
    if (source.from === "experiment") columns.replaceChildren();
    step.say("Reading the record…");
    const { data, csv, columns: named, u_before } = source;
    const request = { ...(csv === null ? { data } : { csv, columns: named }), u_before };
    /** @param {import("../../core/experiments/types.js").IdentifyAnswer} answer */
    const accept = (answer) => {
      if (now !== asked) return;
      step.say("");
      if (!named) columns.replaceChildren();
      if (source.from === "text") {
        const { names, units, time_unit } = answer.record;
        Object.assign(source, { timeUnit: time_unit ?? units["t"] ?? "", inputUnit: units["u"] ?? "", outputUnit: units["y"] ?? "", inputName: names["u"] || "u", outputName: names["y"] || "y" });
      }
      bench.setIdentified(answer);
    };
    try {
      // The method that is looked at comes first; where it does not apply, the others say so beside it.
      const { method } = bench.setting;
      if (!method.startsWith("least_squares")) await patiently(() => api.identify({ ...request, method })).then(accept, () => {});
      if (now === asked) accept(await patiently(() => api.identify({ ...request, method: "least_squares", compare: true })));
    } catch (error) {
      if (now !== asked) return;
      bench.setIdentified(null);
      step.complain(error);
      if (csv !== null) point(csv, /** @type {any} */ (error).message);
      if (csv !== null && /which column|no column/.test(/** @type {any} */ (error).message)) offerColumns();
    }
  }

  function show() {
    const { source } = bench;
    back.hidden = !(source?.from === "text" && bench.result?.kind === "step");
    setText(origin, !source ? "Make a step test above, or use a record of your own." : source.from === "text" ? "The record is your own. No plant stands behind it: step 5 shows the model's promise alone." : "The record is that of the step test above.");
    void ask();
  }
  bench.on(["source"], show);
  show();
}
