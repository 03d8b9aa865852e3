/** The bench of a lab as a workbench state, and back: the knobs' settings are the answer to a design. */

/** @import {LabBench, LabSlider, Settings} from "./types.js" */
/** @import {ControllerState, ControllerType, State} from "../types.js" */

import { startingAnalyses } from "../workbench/analyses.js";
import { formatNumber } from "../format.js";
import { hasDerivative, hasIntegral } from "../workbench/loop.js";
import { tidy } from "../scale.js";

/** @param {LabBench} bench @returns {State} */
export function stateOf({ plant, actuator, sensor, controller, horizon, sliders, response, laplace }) {
  const start = startingAnalyses();
  const analyses = { ...start, response: { ...start.response, ...response }, laplace: { ...start.laplace, ...(laplace && { input: laplace }) } };
  const { form, Kc, tau_I, tau_D, alpha, action } = controller;
  return {
    plant,
    actuator: actuator ?? "",
    sensor: sensor ?? "",
    horizon,
    controller: {
      type: typeOf(tau_I !== null, Boolean(tau_D)),
      form,
      Kc,
      tau_I: tau_I ?? middle(sliders, "tau_I"),
      tau_D: tau_D ?? middle(sliders, "tau_D"),
      alpha,
      beta: 1,
      action,
    },
    view: { signal: "setpoint", show: [], analyses },
  };
}

/** Where a knob stands that is switched on for the first time. @param {LabSlider[]} sliders @param {string} knob */
function middle(sliders, knob) {
  const slider = sliders.find((one) => one.knob === knob);
  return slider ? tidy(slider.scale === "log" ? Math.sqrt(slider.min * slider.max) : (slider.min + slider.max) / 2) : 1;
}

/** @param {boolean} integral @param {boolean} derivative @returns {ControllerType} */
export function typeOf(integral, derivative) {
  return `P${integral ? "I" : ""}${derivative ? "D" : ""}`;
}

/** @param {ControllerState} controller @param {LabSlider["knob"]} knob */
export function isOn(controller, knob) {
  if (knob === "tau_I") return hasIntegral(controller.type);
  return knob === "tau_D" ? hasDerivative(controller.type) : true;
}

/** What the knobs stand at. @param {ControllerState} controller @param {LabSlider[]} sliders @returns {Settings} */
export function settingsOf(controller, sliders) {
  return Object.fromEntries(sliders.map(({ knob }) => [knob, isOn(controller, knob) ? controller[knob] : null]));
}

/**
 * The controller with these settings; a knob that is switched off keeps its value for the next time.
 * @param {ControllerState} controller
 * @param {Settings} settings
 * @returns {Partial<ControllerState>}
 */
export function withSettings(controller, settings) {
  const on = (/** @type {LabSlider["knob"]} */ knob) => (knob in settings ? settings[knob] !== null : isOn(controller, knob));
  const values = Object.fromEntries(Object.entries(settings).filter(([, value]) => value !== null));
  return { ...values, type: typeOf(on("tau_I"), on("tau_D")) };
}

const SPOKEN = { Kc: "Kc", tau_I: "τI", tau_D: "τD", alpha: "α" };

/** "Kc = 4.8, τI = 3 s, τD off". @param {Settings} settings @param {LabSlider[]} sliders */
export function inWords(settings, sliders) {
  return sliders
    .filter(({ knob }) => knob in settings)
    .map(({ knob, unit }) => {
      const value = settings[knob];
      return value == null ? `${SPOKEN[knob]} off` : `${SPOKEN[knob]} = ${short(value)}${unit ? `\u202f${unit}` : ""}`;
    })
    .join(", ");
}

/** Four digits, without zeros that say nothing. @param {number} value */
function short(value) {
  return formatNumber(value, 4).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
}
