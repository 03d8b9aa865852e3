/**
 * The only module that touches Plotly, and the only one that knows how it lays out its SVG.
 *
 * Plotly owns axes, hover, zoom and export, but its own update takes ten times longer than a frame has. So while
 * a knob moves, each line's `d` and each marker's `transform` are rewritten in place on axes that hold, and
 * `Plotly.react` follows when the knob is released or has rested for a moment.
 */

/** @import {Figure, Ranges, Trace} from "../core/types.js" */

import { linePath, toPixel } from "./path.js";

const REST_MS = 120;
/** A server that answers slowly is no rest: this many of its last intervals must pass. */
const REST_INTERVALS = 2.5;
const LONGEST_REST_MS = 800;

const CONFIG = {
  displayModeBar: false,
  showAxisRangeEntryBoxes: false,
  doubleClick: "reset",
  showTips: false,
  displayNotifier: false,
  responsive: false,
};

/** @typedef {{way: "fast" | "react", ms: number, moving: boolean}} Drawn  detail of the event "figure-drawn", which bubbles from the element */
/** @typedef {ReturnType<typeof createFigure>} FigureHandle */

/** @returns {Promise<any>} Plotly, when its script has run */
export function plotlyReady() {
  const { Plotly } = /** @type {any} */ (window);
  if (Plotly) return Promise.resolve(Plotly);
  const script = document.querySelector("script[data-plotly]");
  return new Promise((resolve, reject) => {
    script?.addEventListener("load", () => resolve(/** @type {any} */ (window).Plotly));
    script?.addEventListener("error", () => reject(new Error("The plotting library could not be loaded.")));
    if (!script) reject(new Error("The page has no plotting library."));
  });
}

// Several plots settle at once when a knob is released: one at a time, a frame each, so that the page stays alive.
/** @type {Promise<void>} */
let queue = Promise.resolve();

/** @param {() => Promise<void>} work */
function enqueue(work) {
  queue = queue
    .then(() => new Promise((done) => requestAnimationFrame(() => done(undefined))))
    .then(work)
    .catch((error) => console.error(error));
}

/** @param {HTMLElement} element  with a size of its own */
export function createFigure(element) {
  /** @type {any} */
  let plotly = null;
  /** @type {Figure | null} */
  let latest = null;
  let drawn = "";
  let queued = false;
  let frame = 0;
  let rest = 0;
  let revision = 0;
  let lastShown = 0;
  let interval = 0;
  let moving = false;
  let closed = false;
  /** @type {Set<(ranges: Ranges) => void>} */
  const zoomListeners = new Set();

  /** Plotly's own words for a zoom name axes and ends; what is asked for are the ranges that are shown now. */
  function tellZoom() {
    const full = /** @type {any} */ (element)._fullLayout;
    if (!full || closed) return;
    /** @type {Ranges} */
    const ranges = {};
    for (const axis of Object.keys(latest?.ranges ?? {})) ranges[axis] = [full[axis].range[0], full[axis].range[1]];
    for (const listener of zoomListeners) listener(ranges);
  }

  /** @param {Drawn["way"]} way @param {number} since */
  function report(way, since) {
    element.dispatchEvent(new CustomEvent("figure-drawn", { bubbles: true, detail: { way, ms: performance.now() - since, moving } }));
  }

  function settle() {
    clearTimeout(rest);
    cancelAnimationFrame(frame);
    frame = 0;
    if (queued || closed) return;
    queued = true;
    enqueue(async () => {
      plotly ??= await plotlyReady();
      queued = false;
      if (closed || !latest || element.clientWidth === 0) return;
      const since = performance.now();
      const { traces, layout } = latest;
      const first = drawn === "";
      drawn = signature(latest);
      // Plotly skips what it takes for unchanged, but the fast path has drawn over it: the revision makes it look.
      revision += 1;
      await plotly.react(element, traces, { ...layout, datarevision: revision, width: element.clientWidth, height: element.clientHeight }, CONFIG);
      if (first) /** @type {any} */ (element).on("plotly_relayout", tellZoom);
      report("react", since);
    });
  }

  function paintNow() {
    frame = 0;
    if (!latest || closed) return;
    const since = performance.now();
    if (drawn === signature(latest) && paint(element, latest.traces)) {
      report("fast", since);
      clearTimeout(rest);
      rest = window.setTimeout(settle, Math.min(LONGEST_REST_MS, Math.max(REST_MS, REST_INTERVALS * interval)));
    } else settle();
  }

  const resized = new ResizeObserver(() => {
    if (latest && drawn) settle();
  });
  resized.observe(element);

  return {
    /** @param {Figure} figure @param {{moving?: boolean}} [options] */
    show(figure, options = {}) {
      moving = options.moving ?? false;
      latest = { ...figure, traces: figure.traces.map(prepared) };
      interval = performance.now() - lastShown;
      lastShown += interval;
      if (!drawn) settle();
      else if (moving) {
        if (frame === 0) frame = requestAnimationFrame(paintNow);
      } else {
        // The value is seen at once where the axes hold; the plots take their turns at being drawn in full.
        if (drawn === signature(latest)) paintNow();
        settle();
      }
    },
    /** Tells the ranges shown whenever the student has zoomed, moved or reset them. @param {(ranges: Ranges) => void} listener */
    onZoom(listener) {
      zoomListeners.add(listener);
    },
    /** Takes back the student's zoom. */
    resetZoom() {
      if (!latest || !plotly) return;
      /** @type {Record<string, any>} */
      const update = {};
      for (const [axis, range] of Object.entries(latest.ranges)) update[`${axis}.range`] = [...range];
      plotly.relayout(element, update);
    },
    /** @param {string} filename */
    async saveImage(filename) {
      plotly ??= await plotlyReady();
      await plotly.downloadImage(element, { format: "svg", filename });
    },
    dispose() {
      closed = true;
      clearTimeout(rest);
      cancelAnimationFrame(frame);
      resized.disconnect();
      plotly?.purge(element);
    },
  };
}

/**
 * A trace as both ways can draw it. Plotly leaves out one without points, and with it the node that the fast path
 * would fill later; and it thins out lines, by up to a pixel, which would show as a twitch when a knob comes to rest.
 * @param {Trace} trace
 * @returns {Trace}
 */
function prepared(trace) {
  const points = trace.x.length > 0 ? trace : { ...trace, x: [null], y: [null] };
  return { ...points, line: { simplify: false, ...trace.line } };
}

/** What has to be the same for the drawn SVG to be rewritten: traces, their kinds and axes, and the axis ranges. @param {Figure} figure */
function signature({ traces, ranges }) {
  const kinds = traces.map(({ name, mode, xaxis, yaxis }) => `${name}:${mode}:${xaxis ?? ""}:${yaxis ?? ""}`);
  return JSON.stringify([kinds, ranges]);
}

/**
 * Rewrites the SVG in place. False where it cannot, and Plotly has to draw.
 * @param {any} element
 * @param {Trace[]} traces
 */
function paint(element, traces) {
  const { calcdata, _fullLayout: full } = element;
  if (!full || calcdata?.length !== traces.length) return false;
  for (const [i, trace] of traces.entries()) {
    const node = calcdata[i][0]?.node3?.node();
    if (!node?.isConnected) return false;
    const xAxis = pixelAxis(full, trace.xaxis ?? "x");
    const yAxis = pixelAxis(full, trace.yaxis ?? "y");
    if (trace.mode !== "markers" && !paintLine(node, linePath(trace.x, trace.y, xAxis, yAxis))) return false;
    if (trace.mode !== "lines" && !paintMarkers(node, trace, xAxis, yAxis)) return false;
  }
  return true;
}

/** @param {any} full @param {string} name "x", "y2" ... @returns {import("./path.js").PixelAxis} */
function pixelAxis(full, name) {
  const axis = full[`${name[0]}axis${name.slice(1)}`];
  return { slope: axis._m, start: axis._b, log: axis.type === "log" };
}

/**
 * Plotly draws one path per stretch without gaps; here the first takes all of them.
 * @param {Element} node
 * @param {string} d
 */
function paintLine(node, d) {
  const paths = node.querySelectorAll("path.js-line");
  if (paths.length === 0) return d === "";
  for (const [i, path] of paths.entries()) path.setAttribute("d", i === 0 && d !== "" ? d : "M0,0");
  return true;
}

/**
 * @param {Element} node
 * @param {Trace} trace
 * @param {import("./path.js").PixelAxis} xAxis
 * @param {import("./path.js").PixelAxis} yAxis
 */
function paintMarkers(node, trace, xAxis, yAxis) {
  const points = [];
  for (let i = 0; i < trace.x.length; i++) {
    const x = toPixel(xAxis, trace.x[i]);
    const y = toPixel(yAxis, trace.y[i]);
    if (Number.isFinite(x) && Number.isFinite(y)) points.push(`translate(${Math.round(x * 100) / 100},${Math.round(y * 100) / 100})`);
  }
  const paths = [...node.querySelectorAll("path.point")];
  const model = paths[0];
  if (!model) return points.length === 0;
  while (paths.length < points.length) {
    const copy = /** @type {Element} */ (model.cloneNode(true));
    model.parentNode?.append(copy);
    paths.push(copy);
  }
  for (const [i, path] of paths.entries()) {
    const point = points[i];
    // A point too many goes out of sight rather than away: Plotly's next draw takes the node up again.
    path.setAttribute("transform", point ?? "translate(-99999,-99999)");
  }
  return true;
}
