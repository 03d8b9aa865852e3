/** The controller that places the poles: as a formula, as a PID where it is one, what it costs, and how exact it is. */

/** @import {DesignBench} from "../../core/design/bench.js" */
/** @import {Placed, PlacementAnswer, PlacementState} from "../../core/design/pole-placement.js" */

import { formatAbsent, formatFixed, formatNumber, formatWithUnit, sentence } from "../../core/format.js";
import { pythonCode, workbenchLink } from "../../core/design/pole-placement.js";
import { formatShort, rootsText } from "../../core/roots.js";
import { mountDesignPanel } from "../../components/design-panel.js";
import { h } from "../../components/dom.js";
import { formulaBlock, valueTable, yesNo } from "../../components/facts.js";
import { toast } from "../../components/status-toast.js";

const HELP =
  "The controller of least order that gives the loop exactly the poles wanted. Margins and Ms tell what the equation does not: how much the plant may differ before the loop is lost. A controller that is itself unstable cannot be switched on without the loop.";
/** Beyond these the design is worth a word of warning. */
const FRAGILE_MS = 2;
const ILL_CONDITIONED = 1e8;

/** Whether a single integrator is all that keeps a controller from being stable by itself. @param {Placed["C"]} C */
const integratesOnly = ({ poles, integrators }) => integrators === 1 && poles.every(([re, im]) => re < 0 || (re === 0 && im === 0));

/** @param {HTMLElement} host @param {DesignBench<PlacementState, PlacementAnswer>} bench */
export function mount(host, bench) {
  const code = h("pre", { class: "design-code", tabindex: 0, role: "region", "aria-label": "Python code of this design" });
  const copy = h("button", { type: "button", class: "button small", onclick: () => void navigator.clipboard.writeText(code.textContent ?? "").then(() => toast().say("Copied."), () => toast().say("The browser does not allow copying.")) }, "Copy");
  const python = h("details", { class: "design-more" }, h("summary", {}, "The same in Python"), copy, code);

  /** @param {Placed} design */
  function what({ C }) {
    if (!C.pid) return ["No PID: ", C.integrators === 0 && C.poles.length > 0 ? "nothing in it integrates, and " : "", `${bench.answer?.design.reasons["C.pid"] ?? ""}.`].join("");
    const { Kc, tau_I, tau_D, alpha } = C.pid;
    const type = `P${tau_I === null ? "" : "I"}${tau_D ? "D" : ""}`;
    const times = [`Kc ${formatNumber(Kc)}`, tau_I === null ? "" : `τI ${formatWithUnit(tau_I, "s")}`, tau_D ? `τD ${formatWithUnit(tau_D, "s")}, α ${formatNumber(alpha)}` : ""].filter(Boolean);
    return `A ${type}${tau_D ? " with a filter" : ""}: ${times.join(", ")}.`;
  }

  /** @param {PlacementAnswer} answer */
  function warnings({ design, loop }) {
    const { margins } = loop.panels;
    const out = [];
    if (!design.C.stable && !integratesOnly(design.C)) out.push("The controller itself is unstable: it works in the loop only, and saturation would be fatal.");
    if (margins?.Ms && margins.Ms > FRAGILE_MS) out.push(`Ms is ${formatNumber(margins.Ms)}: the poles are where you want them, yet a small error of the model would move them far. Try slower poles.`);
    if (design.condition > ILL_CONDITIONED) out.push("A pole and a zero of the plant lie close together, or the poles far apart: the equation is ill-conditioned.");
    if (design.approximation) out.push(`The poles are those of a Padé approximation of order ${design.approximation.order}; response, margins and verdict are of the exact dead time.`);
    return out;
  }

  /** @param {HTMLElement} words */
  function show(words) {
    const { answer } = bench;
    if (!answer) return;
    const { design, loop } = answer;
    const { C } = design;
    const { margins } = loop.panels;
    const absent = (/** @type {number | null | undefined} */ value, /** @type {string} */ name, /** @type {string} */ text) => (value == null ? formatAbsent(margins?.reasons[name]) : text);
    code.textContent = pythonCode(design, bench.state.plant);
    const open = C.pid ? h("a", { class: "button", href: workbenchLink(bench.state.plant, C.pid) }, "Open in the workbench") : null;
    words.replaceChildren(
      formulaBlock("C(s) =", C),
      h("p", { class: "finding" }, what(design)),
      ...warnings(answer).map((text) => h("p", { class: "finding warn" }, text)),
      valueTable("The loop", ["", ""], [
        ["Stable", h("span", {}, yesNo(design.verdict === "stable"))],
        ["Sensitivity peak Ms", absent(margins?.Ms, "Ms", formatNumber(margins?.Ms))],
        ["Gain margin", absent(margins?.GM, "GM", formatNumber(margins?.GM))],
        ["Phase margin", absent(margins?.PM_deg, "PM_deg", `${formatFixed(margins?.PM_deg, 1)}°`)],
        ["Delay margin", absent(margins?.delay_margin, "delay_margin", formatWithUnit(margins?.delay_margin, "s"))],
        ["Static gain T(0)", design.static_gain === null ? "—" : formatNumber(design.static_gain, 4)],
        ["Offset after a setpoint step", design.offset_pct === null ? "—" : `${formatFixed(design.offset_pct, 1)} %`],
      ]),
      valueTable("The controller", ["", ""], [
        ["Poles", rootsText(C.poles)],
        ["Zeros", rootsText(C.zeros)],
        ["Stable by itself", integratesOnly(C) ? "but for its integrator" : h("span", {}, yesNo(C.stable))],
        ["Proper", C.relative_degree > 0 ? "strictly" : "yes"],
        ["Residual of the equation", formatNumber(design.residual, 2)],
        ["Error of the poles", formatNumber(design.pole_error, 2)],
        ["Condition of Sylvester's matrix", formatNumber(design.condition, 2)],
      ]),
      h("div", { class: "design-links" }, open),
      python,
    );
  }

  mountDesignPanel(host, bench, {
    id: "placed-controller",
    title: "Controller",
    help: HELP,
    figure: null,
    words: show,
    table() {
      const { equation } = bench.answer?.design ?? {};
      return equation ? { header: ["polynomial", "coefficients, highest power first"], rows: Object.entries(equation).map(([name, values]) => [name, values.map((value) => formatShort(value, 6)).join(", ")]) } : null;
    },
    describe: () => sentence(bench.answer?.design.because),
  });
}
