/** Icons drawn as strokes in the current colour; always beside or inside something that has a name. */

import { svg } from "./dom.js";

/** @type {Record<string, string[]>} */
const PATHS = {
  expand: ["M9 3H3v6", "M15 3h6v6", "M9 21H3v-6", "M15 21h6v-6"],
  shrink: ["M3 9h6V3", "M21 9h-6V3", "M3 15h6v6", "M21 15h-6v6"],
  table: ["M3 5h18v14H3z", "M3 10h18", "M9 5v14"],
  help: ["M9.2 9a2.9 2.9 0 1 1 4.3 2.6c-1 .6-1.5 1.1-1.5 2.4", "M12 17.6v.1"],
  more: ["M5 12v.1", "M12 12v.1", "M19 12v.1"],
  undo: ["M8 5 3.5 9.5 8 14", "M4 9.5h9.5a6 6 0 0 1 0 12H9"],
  redo: ["M16 5l4.5 4.5L16 14", "M20 9.5h-9.5a6 6 0 0 0 0 12H15"],
  link: ["M10 14a4.5 4.5 0 0 0 6.4 0l3.2-3.200a4.5 4.5 0 0 0-6.4-6.400L12 5.6", "M14 10a4.5 4.5 0 0 0-6.4 0l-3.2 3.200a4.5 4.5 0 0 0 6.4 6.400L12 18.4"],
  keep: ["M6 4h12v17l-6-4.5L6 21z"],
  close: ["M6 6l12 12", "M18 6 6 18"],
  chevron: ["M6 9l6 6 6-6"],
  sun: ["M12 7.5a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9z", "M12 2v2.5", "M12 19.5V22", "M2 12h2.5", "M19.5 12H22", "M4.9 4.900l1.8 1.8", "M17.3 17.300l1.8 1.8", "M19.1 4.900l-1.8 1.8", "M6.7 17.300l-1.8 1.8"],
  moon: ["M20 14.5A8.5 8.5 0 0 1 9.5 4a8.5 8.5 0 1 0 10.5 10.5z"],
  auto: ["M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18z", "M12 3v18", "M12 7l5.5 3", "M12 12h7", "M12 17l5.5-3"],
  stable: ["M4.5 12.5l5 5 10-11"],
  unstable: ["M6 6l12 12", "M18 6 6 18"],
  marginal: ["M4 12c2-6 6-6 8 0s6 6 8 0"],
  reset: ["M4 12a8 8 0 1 0 2.5-5.8", "M4 4v5h5"],
  download: ["M12 4v11", "M7 11l5 5 5-5", "M5 20h14"],
};

/** @param {string} name @returns {SVGElement} */
export function icon(name) {
  return svg(
    "svg",
    { class: "icon", viewBox: "0 0 24 24", "aria-hidden": "true", focusable: "false" },
    ...(PATHS[name] ?? []).map((d) => svg("path", { d })),
  );
}
