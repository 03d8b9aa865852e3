/** States that stand in a row, such as the trays of a column: x_1, x_2 ... */

/** @import {Signal} from "./types.js" */

/** Fewer are no profile. */
const FEWEST = 4;

/** @param {Signal[]} states @returns {{stem: string, unit: string, members: {index: number, name: string}[]}[]} */
export function profilesOf(states) {
  /** @type {Map<string, {stem: string, unit: string, members: {index: number, name: string}[]}>} */
  const found = new Map();
  for (const { name, unit = "" } of states) {
    const [, stem, index] = /^(.*?)_?(\d+)$/.exec(name) ?? [];
    if (stem === undefined || index === undefined) continue;
    const profile = found.get(stem) ?? { stem, unit: unit === "-" ? "" : unit, members: [] };
    profile.members.push({ index: Number(index), name });
    found.set(stem, profile);
  }
  for (const { members } of found.values()) members.sort((a, b) => a.index - b.index);
  return [...found.values()].filter(({ members }) => members.length >= FEWEST);
}
