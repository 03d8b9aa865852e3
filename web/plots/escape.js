/** Plotly reads a subset of HTML in every string it is given, so none reaches it raw. */

/** @param {string} text */
export function escapePlotly(text) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll("%{", "%\u200b{");
}
