/** Units of what is made of two quantities. */

/** @param {string} over @param {string} under @returns {string} "" where they cancel */
export function unitRatio(over, under) {
  if (over === under) return "";
  return `${over || "1"}/${/[/ ]/.test(under) ? `(${under})` : under || "1"}`;
}
