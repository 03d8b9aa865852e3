/** The Nichols grid: where the closed loop T = L/(1 + L) has a given magnitude or phase, in the plane of L. */

/** @typedef {{phase_deg: number[], mag_dB: number[]}} Contour */

const DEGREES = 180 / Math.PI;

export const M_LEVELS_DB = [12, 6, 3, 1, 0.5, 0, -1, -3, -6, -12, -20, -30];
export const N_LEVELS_DEG = [-1, -5, -15, -30, -60, -90, -120, -150, -180, -210, -240, -270, -300, -330, -345, -355, -359];

/**
 * The L that closes to T = M e^{jφ}: L = T/(1 − T), on the turn between −360° and 0°.
 * @param {number} M
 * @param {number} phase_deg  of T, between −360 and 0
 * @returns {[number, number]} phase [deg] and magnitude [dB] of L
 */
export function openLoop(M, phase_deg) {
  const angle = phase_deg / DEGREES;
  const [re, im] = [1 - M * Math.cos(angle), -M * Math.sin(angle)];
  return [phase_deg - Math.atan2(im, re) * DEGREES, 20 * Math.log10(M / Math.hypot(re, im))];
}

/** Angles from −360° to 0°, closer at the ends, where a contour of M > 1 lies almost on the vertical. */
const AROUND = Array.from({ length: 181 }, (_, i) => {
  const share = i / 180;
  return -360 * Math.min(1 - 1e-6, Math.max(1e-6, 0.5 - 0.5 * Math.cos(Math.PI * share)));
});

/** |T| = M. @param {number} M @returns {Contour} */
export function mContour(M) {
  const points = AROUND.map((angle) => openLoop(M, angle));
  return { phase_deg: points.map(([phase]) => phase), mag_dB: points.map(([, level]) => level) };
}

const SIZES = Array.from({ length: 121 }, (_, i) => 10 ** (-3 + (i / 120) * 6));

/** arg T = angle. @param {number} angle @returns {Contour} */
export function nContour(angle) {
  const points = SIZES.map((M) => openLoop(M, angle));
  return { phase_deg: points.map(([phase]) => phase), mag_dB: points.map(([, level]) => level) };
}

/**
 * Contours side by side with gaps between them, on every turn that a phase axis shows.
 * @param {Contour[]} contours
 * @param {import("../core/types.js").Range} phases
 * @returns {{x: (number | null)[], y: (number | null)[]}}
 */
export function onEveryTurn(contours, phases) {
  /** @type {(number | null)[]} */
  const x = [];
  /** @type {(number | null)[]} */
  const y = [];
  for (const turn of turnsOf(phases)) {
    for (const { phase_deg, mag_dB } of contours) {
      x.push(...phase_deg.map((phase) => phase + turn), null);
      y.push(...mag_dB, null);
    }
  }
  return { x, y };
}

/** Multiples of 360° by which (−180°, 0 dB) is repeated. @param {import("../core/types.js").Range} phases @returns {number[]} */
export function turnsOf([low, high]) {
  const turns = [];
  for (let turn = 360 * Math.floor(low / 360); turn < high + 360; turn += 360) turns.push(turn);
  return turns;
}
