/** What a step of one input does to every output of a transfer matrix, one above the other. */

/** @import {Figure, Theme} from "../../core/types.js" */

import { plantRunPlot } from "./run.js";

/**
 * @param {{t: number[], outputs: {name: string, unit: string, values: number[]}[], timeUnit: string}} steps
 * @param {Theme} theme
 * @returns {Figure}
 */
export function matrixStepsPlot({ t, outputs, timeUnit }, theme) {
  const rows = outputs.map((output) => ({ ...output, signal: "y" }));
  // Axes made anew: inputs differ a thousandfold in what they do, so that those of another one would not fit.
  return plantRunPlot({ t, rows, window: [0, t.at(-1) ?? 1], cursor: null, timeUnit }, theme, { ranges: {}, moving: false });
}
