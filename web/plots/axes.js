/** Axis ranges that hold still: round ends, kept as long as they still show the data well. */

/** @import {Numbers, Range, Ranges, Theme} from "../core/types.js" */

/** @typedef {{ranges: Ranges, moving: boolean}} Held  what was drawn last, and whether a knob is moving now */

/** How much of the old range the data may leave unused before the axis is drawn anew. */
const WORTH_KEEPING = 0.5;

/** @param {number} span @param {number} parts */
function niceStep(span, parts) {
  const rough = span / parts;
  const power = 10 ** Math.floor(Math.log10(rough));
  const lead = rough / power;
  return power * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 2.5 ? 2.5 : lead <= 5 ? 5 : 10);
}

/**
 * A range with round ends that shows all of [low, high] and a little air.
 * @param {number} low
 * @param {number} high
 * @param {number} [step]  multiples to end on; a round one if not given
 * @returns {Range}
 */
export function niceRange(low, high, step) {
  if (!(high - low > 1e-12 * Math.max(1, Math.abs(high), Math.abs(low)))) {
    const half = Math.abs(high) > 0 ? Math.abs(high) / 2 : 1;
    return niceRange(low - half, high + half, step);
  }
  const air = 0.04 * (high - low);
  const unit = step ?? niceStep(high - low, 8);
  // Data that starts at zero keeps zero as its edge.
  const from = low === 0 && step === undefined ? -air : low - (step === undefined ? air : 0);
  const to = high + (step === undefined ? air : 0);
  return low === 0 && step === undefined ? [from, Math.ceil(to / unit) * unit] : [Math.floor(from / unit) * unit, Math.ceil(to / unit) * unit];
}

/**
 * The axis to draw: while a knob moves the old one, at rest the old one if it still fits, else a new one.
 * @param {Held} held
 * @param {string} name
 * @param {number} low
 * @param {number} high
 * @param {number} [step]
 * @returns {Range}
 */
export function holdRange({ ranges, moving }, name, low, high, step) {
  const old = ranges[name];
  if (!old) return niceRange(low, high, step);
  if (moving) return old;
  const inside = low >= old[0] && high <= old[1];
  return inside && high - low >= WORTH_KEEPING * (old[1] - old[0]) ? old : niceRange(low, high, step);
}

/**
 * Lowest and highest of several series, gaps left out.
 * @param {...(Numbers | (number | null)[])} series
 * @returns {Range}
 */
export function extent(...series) {
  let low = Infinity;
  let high = -Infinity;
  for (const values of series) {
    for (const value of values) {
      if (value === null || !Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

/**
 * The extent without a brief spike, such as the kick of derivative action, that would flatten all the rest.
 * @param {Numbers} values
 * @returns {Range}
 */
export function calmExtent(values) {
  const [low, high] = extent(values);
  const sorted = Float64Array.from(values).sort();
  const at = (/** @type {number} */ share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? 0;
  const [calmLow, calmHigh] = [at(0.02), at(0.98)];
  const reach = Math.max(Math.abs(calmLow), Math.abs(calmHigh), 1e-12);
  return [low < -6 * reach ? Math.min(calmLow, -2 * reach) : low, high > 6 * reach ? Math.max(calmHigh, 2 * reach) : high];
}

/**
 * The extent of a response that runs away: it may leave the picture, or it would flatten its own beginning.
 * @param {Numbers} values
 * @param {number} scale  a size worth showing in any case
 * @returns {Range}
 */
export function runawayExtent(values, scale) {
  const [firstLow, firstHigh] = extent(values.slice(0, Math.ceil(values.length / 8)));
  const reach = 3 * Math.max(scale, Math.abs(firstLow), Math.abs(firstHigh));
  const [low, high] = extent(values);
  return [Math.max(low, -reach), Math.min(high, reach)];
}

/** Room on the left for the labels of these axes: powers of ten take more of it. @param {...Range} ranges */
export function leftMargin(...ranges) {
  const wide = ranges.some(([low, high]) => Math.max(Math.abs(low), Math.abs(high)) >= 1e5 || high - low < 5e-3);
  return wide ? 86 : 62;
}

/**
 * What all plots have in common.
 * @param {Theme} theme
 */
export function baseLayout(theme) {
  return {
    autosize: true,
    // Fixed margins: labels that change their width must not push the plot about.
    margin: { l: 58, r: 14, t: 10, b: 40 },
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    showlegend: false,
    font: { family: theme.font, size: theme.fontSize, color: theme.muted },
    hoverlabel: { bgcolor: theme.paper, bordercolor: theme.axis, font: { family: theme.font, size: theme.fontSize, color: theme.ink } },
    // The student's own zoom survives a redraw.
    uirevision: "held",
    dragmode: "zoom",
    hovermode: "closest",
  };
}

/**
 * @param {Theme} theme
 * @param {string} title
 * @param {Range} range
 * @param {object} [more]
 */
export function axis(theme, title, range, more = {}) {
  return {
    title: { text: title, font: { size: theme.fontSize, color: theme.muted }, standoff: 6 },
    // Plotly writes a zoom into the array that it is given.
    range: [...range],
    gridcolor: theme.grid,
    zerolinecolor: theme.axis,
    zerolinewidth: 1,
    linecolor: theme.axis,
    showline: true,
    ticks: "outside",
    ticklen: 3,
    tickcolor: theme.axis,
    tickfont: { size: theme.fontSize - 1, color: theme.muted },
    automargin: false,
    exponentformat: "power",
    nticks: 6,
    ...more,
  };
}
