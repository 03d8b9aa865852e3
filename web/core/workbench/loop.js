/** From what the student set to what the API takes, and back from the rules' settings. */

/** @import {ControllerState, ControllerType, State, TuneSetting} from "../types.js" */

/** @param {ControllerType} type */
export function hasIntegral(type) {
  return type === "PI" || type === "PID";
}

/** @param {ControllerType} type */
export function hasDerivative(type) {
  return type === "PD" || type === "PID";
}

/** @param {ControllerState} controller */
export function controllerJson(controller) {
  const { form, Kc, alpha, beta, action } = controller;
  const tau_I = hasIntegral(controller.type) ? controller.tau_I : null;
  const tau_D = hasDerivative(controller.type) ? controller.tau_D : null;
  if (form === "parallel") {
    const { Kp, Ki, Kd } = parallelGains(controller);
    return { type: "pid", form, Kp, Ki: tau_I === null ? 0 : Ki, Kd: tau_D === null ? 0 : Kd, alpha, beta, action };
  }
  return { type: "pid", form, Kc, tau_I, tau_D, alpha, beta, action };
}

/** @param {Pick<State, "plant" | "controller" | "actuator" | "sensor">} state */
export function loopOf({ plant, controller, actuator, sensor }) {
  /** @param {string} text */
  const typed = (text) => (text.trim() === "" ? null : { type: "expr", text });
  return { plant, controller: controllerJson(controller), actuator: typed(actuator), sensor: typed(sensor) };
}

/** @param {Pick<ControllerState, "Kc" | "tau_I" | "tau_D">} controller */
export function parallelGains({ Kc, tau_I, tau_D }) {
  return { Kp: Kc, Ki: Kc / tau_I, Kd: Kc * tau_D };
}

/**
 * The ideal-form patch that gives these parallel gains. Changing Kp keeps Ki and Kd, as the form promises.
 * @param {ControllerState} controller
 * @param {{Kp?: number, Ki?: number, Kd?: number}} change
 * @returns {Partial<ControllerState>}
 */
export function fromParallel(controller, change) {
  const { Kp, Ki, Kd } = { ...parallelGains(controller), ...change };
  return { Kc: Kp, tau_I: Kp / Ki, tau_D: Kd / Kp };
}

/**
 * @param {Pick<TuneSetting, "type" | "Kc" | "tau_I" | "tau_D" | "alpha">} setting
 * @param {ControllerState} controller
 * @returns {ControllerState}
 */
export function applySetting(setting, controller) {
  const Kc = setting.Kc ?? controller.Kc;
  return {
    ...controller,
    type: setting.type,
    form: "ideal",
    action: Kc < 0 ? "direct" : "reverse",
    Kc: Math.abs(Kc),
    tau_I: setting.tau_I ?? controller.tau_I,
    tau_D: setting.tau_D ?? controller.tau_D,
    alpha: setting.alpha ?? controller.alpha,
  };
}
