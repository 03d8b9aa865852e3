/** The plane of Kc and tau_I: where PI control is stable, how robust and how good, and the present point to be dragged. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */
/** @import {GainMapFound} from "../../core/workbench/tuning.js" */
/** @import {ControllerState, Table} from "../../core/types.js" */

import { createAnalysis } from "../../core/workbench/analysis.js";
import { MS_LIMIT } from "../../core/workbench/analyses.js";
import { ANALYSIS_HELP } from "../../core/explain.js";
import { formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { applySetting } from "../../core/workbench/loop.js";
import { createScale, tidy } from "../../core/scale.js";
import { gainMap, gainMapRequest } from "../../core/workbench/tuning.js";
import { mountAnalysisPanel } from "../../components/analysis-panel.js";
import { h } from "../../components/dom.js";
import { captioned, headRow, part } from "../../components/facts.js";
import "../../components/number-field.js";
import { createPlaneHandle } from "../../components/plane-handle.js";
import "../../components/segmented-control.js";
import { toast } from "../../components/status-toast.js";
import { createFigure } from "../../plots/figure.js";
import { gainMapPlot, mapRanges } from "../../plots/gain_map.js";

/** @param {HTMLElement} host @param {Store} store @param {Api} api @returns {() => void} */
export function mount(host, store, api) {
  const unit = store.answers.time_unit;
  /** @type {import("../../core/workbench/analysis.js").Analysis<GainMapFound>} */
  let analysis;
  /** @type {import("../../plots/figure.js").FigureHandle | null} */
  let figure = null;
  /** The element that the plot is drawn in. @type {HTMLElement | null} */
  let plot = null;

  const step = h("segmented-control", { label: "Error after a step in", class: "small" });
  step.options = [
    { value: "setpoint", label: "Setpoint", title: "IAE after a unit step of the setpoint r" },
    { value: "load", label: "Load", title: "IAE after a unit step of the load d at the plant's input" },
  ];
  step.addEventListener("value-change", () => store.setView({ signal: step.value === "load" ? "load" : "setpoint" }));
  const limit = h("number-field", { label: "Optimal with Ms up to", min: MS_LIMIT.min, max: MS_LIMIT.max });
  limit.addEventListener("value-change", () => limit.value !== null && store.setAnalyses({ Ms_limit: limit.value }));
  const hint = h("p", { class: "finding" });
  const words = h("div", { class: "analysis-parts" });

  /** The map is of gains of one sign: whether this controller has it. @param {ControllerState} controller */
  const rightSign = ({ action }) => (action === "direct") === ((analysis?.answer?.map.Kc[0] ?? 1) < 0);

  function scales() {
    const { xaxis, yaxis } = mapRanges(/** @type {GainMapFound} */ (analysis.answer).map);
    const scale = ([low, high] = [0, 1]) => createScale({ min: 10 ** low, max: 10 ** high, log: true });
    return { x: scale(xaxis), y: scale(yaxis) };
  }

  const handle = createPlaneHandle({
    toPixels: (value) => figure?.pixelsOf(value) ?? null,
    toValues(pixels) {
      const found = figure?.valuesAt(pixels);
      return found ? { x: tidy(found.x), y: tidy(found.y) } : null;
    },
    step(value, across, up) {
      const { x, y } = scales();
      return { x: across ? x.step(value.x, across) : value.x, y: up ? y.step(value.y, up) : value.y };
    },
    describe: ({ x, y }) => `Present settings: Kc ${formatNumber(x)}, τI ${formatWithUnit(y, unit)}. Arrow keys move it.`,
    onMove: ({ x, y }, moving) => store.setController({ Kc: x, tau_I: y }, { moving }),
  });

  function showHandle() {
    const { controller } = store.get();
    const here = analysis?.answer && controller.type === "PI" && rightSign(controller);
    handle.show(here ? { x: controller.Kc, y: controller.tau_I } : null);
    hint.textContent = !analysis?.answer || here ? "" : controller.type === "PI" ? "The controller acts the other way than this plant needs: change its action in the Controller card." : "The map is of PI control: choose PI in the Controller card to have the present settings on it and to drag them.";
  }

  /** @param {string} label @param {{Kc: number | null, tau_I: number | null}} setting */
  function useButton(label, { Kc, tau_I }) {
    const use = () => {
      store.set({ controller: applySetting({ type: "PI", Kc, tau_I, tau_D: null, alpha: null }, store.get().controller) });
      toast().say(`${label}: gains are set.`, { action: { label: "Undo", run: () => store.undo() } });
    };
    return h("button", { type: "button", class: "button use", "aria-label": `Use ${label}`, onclick: use }, "Use");
  }

  /** @param {string[]} header @param {HTMLElement[]} rows @param {string} caption */
  const table = (caption, header, rows) => captioned(caption, h("table", { class: "values settings" }, headRow(header), h("tbody", {}, ...rows)));
  /** @param {string} head @param {string} label @param {(number | null)[]} values @param {{Kc: number | null, tau_I: number | null}} setting */
  const row = (head, label, values, setting) => h("tr", {}, h("th", { scope: "row" }, head), ...values.map((value) => h("td", {}, formatNumber(value))), h("td", {}, useButton(label, setting)));

  function render() {
    const { settings, tradeOff, optimum, reason } = /** @type {GainMapFound} */ (analysis.answer);
    const { actuator, sensor, view } = store.get();
    const chosen = view.analyses.Ms_limit;
    const limits = tradeOff.filter(({ Ms_limit }) => Ms_limit !== chosen || !optimum).concat(optimum ? { Ms_limit: chosen, optimum, reason: null } : []);
    const rows = limits.toSorted((a, b) => a.Ms_limit - b.Ms_limit).flatMap(({ Ms_limit, optimum: found }) =>
      found ? [row(`${found === optimum ? "★ " : ""}Ms ≤ ${Ms_limit}`, `the best with Ms up to ${Ms_limit}`, [found.controller.Kc, found.controller.tau_I, found.Ms, found.value], found.controller)] : [],
    );
    words.replaceChildren(
      hint,
      actuator.trim() || sensor.trim() ? h("p", { class: "finding" }, "Actuator and sensor are left out here: the map is of the plant alone.") : "",
      part(
        "Price of robustness",
        rows.length > 0 ? table(`Smallest IAE after a ${view.signal} step within a limit of Ms, and the Ms that it has`, ["Limit", "Kc", `τI [${unit}]`, "Ms", "IAE", ""], rows) : h("p", { class: "finding" }, sentence(reason)),
      ),
      part(
        "Rules for PI",
        settings.length > 0
          ? table("Numbers as on the map", ["Rule", "Kc", `τI [${unit}]`, ""], settings.map((setting, k) => row(`${k + 1} ${setting.name}`, setting.name, [setting.Kc, setting.tau_I], setting)))
          : h("p", { class: "finding" }, "No rule applies to this plant; the Tune card tells why."),
      ),
    );
    showForm();
  }

  function showForm() {
    step.value = store.get().view.signal;
    limit.value = store.get().view.analyses.Ms_limit;
    showHandle();
  }

  const panel = mountAnalysisPanel(
    host,
    store,
    {
      id: "gain_map",
      title: "Gain map",
      help: ANALYSIS_HELP["gain_map"] ?? "",
      controls: [step],
      form: [h("div", { class: "form-fields" }, limit)],
      words: [words],
      figure(element) {
        plot = element;
        element.parentElement?.append(handle.root);
        figure = createFigure(element);
        figure.onZoom(handle.place);
        element.addEventListener("figure-drawn", showHandle);
        return figure;
      },
      render,
      draw(theme) {
        const found = analysis?.answer;
        if (!found) return null;
        const marks = found.settings.map(({ name, Kc, tau_I }, k) => ({ number: k + 1, label: name, Kc: Math.abs(Kc ?? 0), tau_I: tau_I ?? 0 }));
        return gainMapPlot({ map: found.map, marks, tradeOff: found.tradeOff, optimum: found.optimum, timeUnit: unit }, theme);
      },
      legend: () => [
        { signal: "pole", label: "now", name: "present settings: drag them", glyph: "■" },
        { signal: "limit", label: "limit", name: "exact limit of stability" },
        { signal: "contour", label: "Ms", name: "settings of the same Ms", dash: "dash" },
        { signal: "y", label: "IAE", name: "settings of the same IAE" },
        { signal: "optimal", label: "best", name: "the smallest IAE for each limit of Ms; the star keeps the limit chosen", glyph: "★" },
        { signal: "rule", label: "rules", name: "settings by the rules, numbered as in the table", glyph: "●" },
      ],
      table: () => (analysis?.answer ? tableOf(analysis.answer) : null),
      describe: () => "Map of PI settings: limit of stability, contours of Ms and IAE, rules and best settings.",
    },
    (onChange) => [(analysis = createAnalysis(store, { request: gainMapRequest, send: (request) => gainMap(api, request, store.get().controller.Kc) }, onChange))],
  );
  const stop = store.subscribe((_, { view }) => {
    if (view) panel.redraw();
    showHandle();
  });
  showForm();
  return () => {
    stop();
    plot?.removeEventListener("figure-drawn", showHandle);
    handle.dispose();
    panel.dispose();
  };
}

/** @param {GainMapFound} found @returns {Table} */
function tableOf({ map }) {
  return {
    header: ["tau_I", "Kc", "Ms", "IAE"],
    rows: map.tau_I.flatMap((tau_I, j) => map.Kc.map((Kc, i) => [tau_I, Kc, map.Ms[j]?.[i] ?? null, map.value[j]?.[i] ?? null])),
  };
}
