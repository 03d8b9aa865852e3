/** How fast a plant is shown: simulated time in a second, from its slowest time constant. */

/** One of 1, 2, 5 times a power of ten. @param {number} value */
export function round125(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const lead = value / power;
  return Number((power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10)).toPrecision(6));
}

/** @param {number | null} timeScale @param {string} timeUnit @returns {{speeds: number[], speed: number, window: number}} */
export function paceOf(timeScale, timeUnit) {
  const scale = timeScale ?? 1;
  const speeds = [...new Set([0.02, 0.1, 0.5, 2, 10].map((share) => round125(share * scale)))];
  // What a person could watch is watched as it goes.
  const real = timeUnit === "s" && scale < 12;
  if (real && !speeds.includes(1)) speeds.push(1);
  speeds.sort((a, b) => a - b);
  const speed = real ? 1 : (speeds[2] ?? scale);
  return { speeds, speed, window: round125(12 * speed) };
}
