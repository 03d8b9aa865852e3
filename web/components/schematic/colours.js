/** Colours of a drawing by name and by scale. Their values are in styles/tokens.css, light and dark. */

/** @type {Record<string, string>} */
const NAMED = {
  none: "none",
  ink: "var(--ink-soft)",
  muted: "var(--ink-muted)",
  line: "var(--line-strong)",
  paper: "var(--paper)",
  accent: "var(--accent)",
  good: "var(--good)",
  bad: "var(--bad)",
  warn: "var(--warn)",
  metal: "var(--draw-metal)",
  water: "var(--draw-water)",
  product: "var(--draw-product)",
  steam: "var(--draw-steam)",
  heat: "var(--draw-heat)",
  cold: "var(--draw-cold)",
  force: "var(--signal-u)",
};

/** Stops from low to high. @type {Record<string, string[]>} */
const SCALES = {
  temperature: [0, 1, 2, 3, 4].map((i) => `var(--draw-temperature-${i})`),
  composition: [0, 1, 2].map((i) => `var(--draw-composition-${i})`),
};

/** @param {string} name @returns {string | undefined} */
export function colourOf(name) {
  return Object.hasOwn(NAMED, name) ? NAMED[name] : undefined;
}

/**
 * The colour at a part (0 to 1) of a scale, in steps of a hundredth of a stop.
 * @param {string} scale @param {number} part @returns {string | undefined}
 */
export function colourAt(scale, part) {
  const stops = Object.hasOwn(SCALES, scale) ? SCALES[scale] : undefined;
  if (!stops) return undefined;
  const place = part * (stops.length - 1);
  const low = Math.min(Math.floor(place), stops.length - 2);
  const share = Math.round(100 * (place - low));
  return `color-mix(in oklab, ${stops[low]} ${100 - share}%, ${stops[low + 1]})`;
}

/** A line of the same hue that stands out on a colour: a surface, the dashes of a flow. @param {string} colour */
export function onColour(colour) {
  return colour === "none" ? "var(--ink-soft)" : `color-mix(in oklab, ${colour} 45%, var(--ink))`;
}
