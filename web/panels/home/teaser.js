/** One gain and one response, drawn without the plotting library: the first page is light, and alive. */

/** @import {Api} from "../../core/api.js" */
/** @import {Store} from "../../core/store.js" */

import { formatFixed, formatNumber } from "../../core/format.js";
import { toQuery } from "../../core/url.js";
import { h, set, setText, svg } from "../../components/dom.js";
import "../../components/gain-slider.js";
import { icon } from "../../components/icons.js";
import { linePath } from "../../plots/path.js";

const WIDTH = 560;
const HEIGHT = 260;
const Y = { low: -0.15, high: 1.9 };
const END = 30;

/** @param {HTMLElement} host @param {Store} store @param {Api} _api @returns {() => void} */
export function mount(host, store, _api) {
  const { answers } = store;
  store.set({ horizon: END });
  const y = { slope: -HEIGHT / (Y.high - Y.low), start: (HEIGHT * Y.high) / (Y.high - Y.low), log: false };
  const x = { slope: WIDTH / END, start: 0, log: false };
  const curve = svg("path", { class: "teaser-y" });
  const target = svg("path", { class: "teaser-r", d: `M0,${y.start + y.slope}H${WIDTH}` });
  const axis = svg("path", { class: "teaser-axis", d: `M0,${y.start}H${WIDTH}` });
  const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "Step response of a loop", preserveAspectRatio: "none" }, axis, target, curve);
  const slider = h("gain-slider", { name: "Kc", min: 0.1, max: 10, above: "0" });
  slider.value = store.get().controller.Kc;
  const mark = h("span", { class: "verdict-mark" });
  const words = h("span", {}, "…");
  const verdict = h("p", { class: "teaser-verdict" }, mark, words);
  const link = h("a", { class: "button", href: "/workbench" }, "Open this loop");
  const root = h("div", { class: "teaser" }, h("p", { class: "teaser-title" }, "PI control of three equal lags"), picture, slider, h("div", { class: "row spread" }, verdict, link));
  host.append(root);

  slider.addEventListener("value-input", (event) => store.setController({ Kc: /** @type {CustomEvent<{value: number}>} */ (event).detail.value }, { moving: true }));
  slider.addEventListener("value-change", (event) => store.setController({ Kc: /** @type {CustomEvent<{value: number}>} */ (event).detail.value }));

  const release = answers.want(["step", "verdict", "margins", "metrics"]);
  const stop = answers.subscribe(({ moving }) => {
    const { step, verdict: now, margins, metrics } = answers.panels;
    if (!step || !now) return;
    curve.setAttribute("d", linePath(step.t, step.setpoint.y, x, y));
    if (verdict.dataset["verdict"] !== now.verdict) mark.replaceChildren(icon(now.verdict));
    verdict.dataset["verdict"] = now.verdict;
    const overshoot = metrics?.setpoint.overshoot_pct;
    setText(words, now.closed_loop_stable ? `stable · GM ${formatNumber(margins?.GM)} · overshoot ${formatFixed(overshoot, 0)} %` : `${now.verdict}: the gain is too high`);
    slider.marks = [];
    if (!moving) {
      set(link, { href: `/workbench?${toQuery({ ...store.get(), horizon: null })}` });
      set(picture, { "aria-label": `Step response of a loop with gain ${formatNumber(store.get().controller.Kc)}: ${words.textContent}` });
    }
  });
  return () => {
    release();
    stop();
    root.remove();
  };
}
