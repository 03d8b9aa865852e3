/** Paths of straight lines and rounded corners. */

/** @typedef {[number, number]} Point */

/** @param {number} n */
const r = (n) => Math.round(100 * n) / 100;

/** A polyline with corners rounded by `radius`. @param {Point[]} points @param {number} radius */
export function roundedPath(points, radius) {
  let d = `M${r(points[0][0])} ${r(points[0][1])}`;
  for (let i = 1; i < points.length - 1; i += 1) {
    const corner = points[i];
    const cut = Math.min(radius, distance(corner, points[i - 1]) / 2, distance(corner, points[i + 1]) / 2);
    const before = towards(corner, points[i - 1], cut);
    const after = towards(corner, points[i + 1], cut);
    d += `L${r(before[0])} ${r(before[1])}Q${r(corner[0])} ${r(corner[1])} ${r(after[0])} ${r(after[1])}`;
  }
  const end = points[points.length - 1];
  return `${d}L${r(end[0])} ${r(end[1])}`;
}

/** @param {Point} a @param {Point} b */
export function distance(a, b) {
  return Math.hypot(b[0] - a[0], b[1] - a[1]);
}

/** The point `length` away from a on the way to b. @param {Point} a @param {Point} b @param {number} length @returns {Point} */
export function towards(a, b, length) {
  const whole = distance(a, b) || 1;
  return [a[0] + ((b[0] - a[0]) * length) / whole, a[1] + ((b[1] - a[1]) * length) / whole];
}

/** A slim arrowhead whose tip is at `tip`, coming from `from`. @param {Point} from @param {Point} tip @param {number} length */
export function arrowHead(from, tip, length) {
  const back = towards(tip, from, length);
  const [dx, dy] = [(tip[0] - back[0]) * 0.42, (tip[1] - back[1]) * 0.42];
  const notch = towards(tip, from, length * 0.82);
  return `M${r(tip[0])} ${r(tip[1])}L${r(back[0] - dy)} ${r(back[1] + dx)}L${r(notch[0])} ${r(notch[1])}L${r(back[0] + dy)} ${r(back[1] - dx)}Z`;
}

/** The rectangle about points. @param {Point[]} points @returns {[number, number, number, number]} */
export function boundsOf(points) {
  const xs = points.map(([x]) => x);
  const ys = points.map(([, y]) => y);
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return [x, y, Math.max(...xs) - x, Math.max(...ys) - y];
}
