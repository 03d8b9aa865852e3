/** How long a response is watched: long enough to see it settle, short enough to see how. */

/** @import {Metrics, MetricsPanel, StepPanel} from "./types.js" */

const ROUND = [1, 2, 3, 5, 8, 10];
/** How many settling times to watch: the setpoint response is the one looked at most, the load's has the longer tail. */
const SETTLING_TIMES = { setpoint: 2, load: 1.3 };
/** An axis is kept while it is between these parts of what would be best. */
const WORTH_KEEPING = { least: 0.65, most: 2.5 };
/** A growing response has shown what it does when it is this many times the setpoint. */
const GROWN = 20;

/** The next of 1, 2, 3, 5, 8, 10 ... times a power of ten. @param {number} value */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const lead = ROUND.find((step) => step * power >= value * (1 - 1e-9)) ?? 10;
  return Number((lead * power).toPrecision(6));
}

/**
 * The time axis for a stable loop, or null where the server's own choice is best.
 * @param {MetricsPanel | undefined} metrics  over the server's own horizon
 * @param {number | null} held  the axis of now
 * @returns {number | null}
 */
export function settledHorizon(metrics, held) {
  const times = [metrics?.setpoint, metrics?.load].map((/** @type {Metrics | undefined} */ m) => m?.t_settle ?? null);
  const [setpoint, load] = times;
  if (setpoint == null || load == null) return null;
  const best = Math.max(SETTLING_TIMES.setpoint * setpoint, SETTLING_TIMES.load * load);
  if (!(best > 0)) return null;
  if (held !== null && held >= WORTH_KEEPING.least * best && held <= WORTH_KEEPING.most * best) return held;
  return roundUp(best);
}

/**
 * The time axis for a loop that runs away, or null where it has room enough.
 * @param {StepPanel} step
 * @returns {number | null}
 */
export function runawayHorizon({ t, horizon, setpoint }) {
  const grown = setpoint.y.findIndex((value) => Math.abs(value) > GROWN);
  const at = grown < 0 ? null : (t[grown] ?? null);
  return at !== null && at > 0 && at < 0.5 * horizon ? roundUp(at) : null;
}
