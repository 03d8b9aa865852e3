/** Step 3, the record with the model's answer over it, and the lines it is read off, each with a handle. */

/** @import {ExperimentBench} from "../../core/experiments/bench.js" */
/** @import {LineName, MethodName} from "../../core/experiments/types.js" */
/** @import {Ranges, Table} from "../../core/types.js" */
/** @import {Step} from "../../components/step-section.js" */

import { levelOf, LINES, METHODS, tangentLine } from "../../core/experiments/construction.js";
import { formatFixed, formatNumber, formatWithUnit } from "../../core/format.js";
import { readOff } from "../../core/experiments/read-off.js";
import { h, setText } from "../../components/dom.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { createPlaneHandle } from "../../components/plane-handle.js";
import { createSelectField } from "../../components/select-field.js";
import { onThemeChange, readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { identificationPlot } from "../../plots/experiments/identification.js";

const HELP = "The record, and over it what the model answers to the same input. Drag a line by its handle, or focus the handle and use the arrow keys (Shift: large steps): the model follows by the method's formula. What the model leaves over stands below; it should look like noise, without a pattern.";
const NONE = "No record yet: it appears here as soon as the step test above has run to its end.";
const UNREAD = "Your record appears here once it can be read.";
/** One key press, in parts of the record's span. */
const STEP = 1 / 400;
/** How far from the edges of the plot, in parts of it, a handle lies that is free to lie anywhere on its line. */
const EDGE = 0.04;

/** @param {Step} step @param {ExperimentBench} bench */
export function mount(step, bench) {
  let theme = readTheme();
  /** @type {Ranges} */
  let ranges = {};
  /** @type {import("../../plots/figure.js").FigureHandle | null} */
  let figure = null;
  const method = createSelectField({
    label: "Method",
    groups: [
      { label: "Read off the curve", choices: choices(true) },
      { label: "Fitted to all samples", choices: choices(false) },
    ],
    onChoice: (value) => bench.setMethod(/** @type {MethodName} */ (value)),
  });
  const formula = h("p", { class: "identify-formula" });
  const own = h("button", { type: "button", class: "button small", onclick: () => bench.setLines({}) }, "Back to the method's own lines");
  const empty = h("p", { class: "empty" });
  const panel = createPanelFrame(step.stage, {
    id: "identify",
    title: "Record and model",
    help: HELP,
    figure(element) {
      figure = createFigure(element);
      figure.onZoom(() => placeAll());
      element.addEventListener("figure-drawn", () => placeAll());
      return figure;
    },
    table,
    arrange: ({ header, body }) => [header, h("div", { class: "identify-method" }, method.root, formula, own), body],
  });
  step.stage.prepend(empty);
  const body = /** @type {HTMLElement} */ (panel.root.querySelector(".panel-body"));

  /** @param {boolean} drawn */
  function choices(drawn) {
    return Object.entries(METHODS).filter(([, { lines }]) => lines.length > 0 === drawn).map(([value, { label }]) => ({ value, label }));
  }

  const handles = /** @type {LineName[]} */ (Object.keys(LINES)).map((name) => ({ name, handle: handleOf(name) }));
  for (const { name, handle } of handles) {
    handle.root.classList.add("line-handle", LINES[name].time ? "for-time" : "for-level");
    handle.root.append(h("span", { "aria-hidden": "true" }, LINES[name].label));
    body.append(handle.root);
  }

  /** @param {LineName} name */
  function handleOf(name) {
    const { label, time } = LINES[name];
    return createPlaneHandle({
      toPixels: (value) => figure?.pixelsOf(value) ?? null,
      toValues(pixels) {
        const at = figure?.valuesAt(pixels);
        const here = placeOf(name);
        return at && here ? (time ? { x: at.x, y: here.y } : { x: here.x, y: at.y }) : null;
      },
      step(value, across, up) {
        const [[x0 = 0, x1 = 1], [y0 = 0, y1 = 1]] = [ranges["xaxis"] ?? [0, 1], ranges["yaxis"] ?? [0, 1]];
        return time ? { x: value.x + (across || up) * STEP * (x1 - x0), y: value.y } : { x: value.x, y: value.y + (up || across) * STEP * (y1 - y0) };
      },
      describe: ({ x, y }) => `Line ${label} at ${time ? formatWithUnit(x, bench.source?.timeUnit ?? "", 4) : formatWithUnit(y, bench.source?.outputUnit ?? "", 4)}. Arrow keys move it.`,
      onMove({ x, y }) {
        bench.setLines({ ...bench.setting.moved, [name]: Number((time ? x : y).toPrecision(6)) });
      },
    });
  }

  const read = () => readOff(bench.identified, bench.setting.method, bench.setting.moved);

  /** Where the handle of a line lies: a time at the level that it is read at, a level at the plot's edge. @param {LineName} name */
  function placeOf(name) {
    const found = read();
    const value = found?.lines[name];
    if (!found || value === undefined) return null;
    const [[x0 = 0, x1 = 1], [low = 0, high = 1]] = [ranges["xaxis"] ?? [], ranges["yaxis"] ?? []];
    if (!LINES[name].time) return { x: name === "y0" ? x1 - EDGE * (x1 - x0) : x0 + EDGE * (x1 - x0), y: value };
    // t0 is off the levels, where t1 may come close to it, and off y∞, whose handle is as near to the left edge.
    if (name === "t0") return { x: value, y: (low + high) / 2 };
    return { x: value, y: levelOf(bench.setting.method, name, found.lines) };
  }

  function placeAll() {
    for (const { name, handle } of handles) handle.show(panel.root.hidden ? null : placeOf(name));
  }

  /** @returns {Table | null} */
  function table() {
    const found = read();
    if (!found || !bench.identified) return null;
    const { t, u, y } = bench.identified.record;
    return { header: [`t [${bench.source?.timeUnit ?? ""}]`, "u", "y", "y_hat", "residual"], rows: t.map((at, k) => [at, u[k] ?? null, y[k] ?? null, found.y_hat?.[k] ?? null, found.residuals?.[k] ?? null]) };
  }

  /** @param {boolean} moving */
  function draw(moving) {
    const { identified, source, setting } = bench;
    const found = read();
    panel.root.hidden = !found;
    empty.hidden = found !== null;
    setText(empty, source?.from === "text" ? UNREAD : NONE);
    if (!found || !identified || !source) return placeAll();
    const unit = (/** @type {string} */ name, /** @type {string} */ of) => (of ? `${name} [${of}]` : name);
    const { lines } = METHODS[setting.method];
    const at = lines.filter((name) => LINES[name].time && name !== "t0" && found.lines[name] !== undefined);
    const next = identificationPlot(
      {
        record: identified.record,
        y_hat: found.y_hat,
        residuals: found.residuals,
        lines: found.lines,
        drawn: lines,
        reads: { t: at.map((name) => found.lines[name] ?? 0), y: at.map((name) => levelOf(setting.method, name, found.lines)) },
        tangent: setting.method.startsWith("tangent") && found.model ? tangentLine(setting.method, found.lines, found.found.construction) : { t: [], y: [] },
        yName: unit(source.outputName, source.outputUnit),
        uName: unit(source.inputName, source.inputUnit),
        timeUnit: source.timeUnit || "as recorded",
      },
      theme,
      { ranges, moving },
    );
    ranges = next.ranges;
    panel.show(next, moving);
    method.show(setting.method);
    setText(formula, METHODS[setting.method].formula);
    own.hidden = !found.hand;
    if (!moving) {
      const { model, fit_pct } = found;
      panel.tell(`Record of ${identified.record.t.length} samples${model ? ` and a model with ${Object.entries(model).map(([name, value]) => `${name} = ${formatNumber(value)}`).join(", ")}; fit ${formatFixed(fit_pct, 1)} %` : ""}.`, [
        { signal: "y", label: "record", name: "output, as recorded", glyph: "●" },
        { signal: "model", label: "model", name: "what the model answers to the same input", dash: "dash" },
        { signal: "u", label: "input", name: "input, as recorded" },
      ]);
    }
  }

  let rest = 0;
  bench.on(["lines"], () => {
    draw(true);
    clearTimeout(rest);
    rest = window.setTimeout(() => draw(false), 200);
  });
  bench.on(["identified", "method"], () => {
    ranges = bench.identified ? {} : ranges;
    draw(false);
  });
  onThemeChange(() => {
    theme = readTheme();
    draw(false);
  });
  draw(false);
}
