/** Lines of one level through values on a grid: marching squares, linear along the edges of each cell. */

/** @typedef {[number, number]} Point */

/**
 * @param {number[]} x  increasing, one for each column
 * @param {number[]} y  increasing, one for each row
 * @param {number[][]} z  one list per y; a line ends at a cell with a NaN
 * @param {number} level
 * @returns {Point[][]} each line from one end to the other; a closed one ends where it begins
 */
export function contourLines(x, y, z, level) {
  const at = (/** @type {number} */ i, /** @type {number} */ j) => z[j]?.[i] ?? 0;
  /** @type {Map<string, Point>} */
  const points = new Map();
  /** @type {Map<string, string[]>} */
  const links = new Map();

  /** Where the level crosses the edge between two corners, if it does. @param {[number, number]} from @param {[number, number]} to @returns {string | null} */
  function crossing([i, j], [k, l]) {
    const [p, q] = [at(i, j), at(k, l)];
    if (p >= level === q >= level) return null;
    const share = (level - p) / (q - p);
    const between = (/** @type {number[]} */ values, /** @type {number} */ a, /** @type {number} */ b) => (values[a] ?? 0) + share * ((values[b] ?? 0) - (values[a] ?? 0));
    const key = `${i},${j},${k},${l}`;
    points.set(key, [between(x, i, k), between(y, j, l)]);
    return key;
  }

  /** @param {string} a @param {string} b */
  function link(a, b) {
    links.set(a, (links.get(a) ?? []).concat(b));
    links.set(b, (links.get(b) ?? []).concat(a));
  }

  for (let j = 0; j + 1 < y.length; j++) {
    for (let i = 0; i + 1 < x.length; i++) {
      if (Number.isNaN(at(i, j) + at(i + 1, j) + at(i + 1, j + 1) + at(i, j + 1))) continue;
      const edges = [crossing([i, j], [i + 1, j]), crossing([i + 1, j], [i + 1, j + 1]), crossing([i, j + 1], [i + 1, j + 1]), crossing([i, j], [i, j + 1])];
      const [a, b, c, d] = edges.filter((edge) => edge !== null);
      if (a !== undefined && b !== undefined && c !== undefined && d !== undefined) {
        // A saddle: the middle tells which corners hang together.
        const middle = (at(i, j) + at(i + 1, j) + at(i + 1, j + 1) + at(i, j + 1)) / 4;
        const joined = middle >= level === at(i, j) >= level;
        link(a, joined ? b : d);
        link(c, joined ? d : b);
      } else if (a !== undefined && b !== undefined) link(a, b);
    }
  }

  /** @type {Point[][]} */
  const lines = [];
  /** @param {string} start */
  function walk(start) {
    /** @type {Point[]} */
    const line = [];
    let here = /** @type {string | undefined} */ (start);
    while (here !== undefined) {
      line.push(/** @type {Point} */ (points.get(here)));
      const next = /** @type {string | undefined} */ (links.get(here)?.[0]);
      links.delete(here);
      if (next !== undefined) links.set(next, (links.get(next) ?? []).filter((key) => key !== here));
      here = next;
    }
    lines.push(line);
  }
  for (const [key, ends] of [...links]) if (ends.length === 1 && links.has(key)) walk(key);
  for (const key of [...links.keys()]) {
    if (!links.has(key)) continue;
    walk(key);
    const loop = lines.at(-1);
    if (loop?.[0]) loop.push(loop[0]);
  }
  return lines;
}
