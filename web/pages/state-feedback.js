/** State feedback: a plant that is let go and caught, its design beside it, and how far the catch reaches. */

import { createApi } from "../core/api.js";
import { defaultFeedback, fromQuery, toQuery } from "../core/state-feedback/feedback.js";
import { PROFILES } from "../core/state-feedback/plants.js";
import { createFeedbackSession } from "../core/state-feedback/session.js";
import { h } from "../components/dom.js";
import { createSelectField } from "../components/select-field.js";
import "../components/site-header.js";
import * as curves from "../panels/state-feedback/curves.js";
import * as map from "../panels/state-feedback/map.js";
import * as numbers from "../panels/state-feedback/numbers.js";
import * as poles from "../panels/state-feedback/poles.js";
import * as settings from "../panels/state-feedback/settings.js";
import * as stage from "../panels/state-feedback/stage.js";

const LONGEST_TICK = 0.1;

/** @param {HTMLElement} main */
async function open(main) {
  const api = createApi();
  const session = createFeedbackSession(api, fromQuery(location.search));
  const plants = new Map((await api.plants()).plants.map((plant) => [plant.id, plant]));
  const chooser = createSelectField({
    label: "Plant",
    groups: [{ label: null, choices: PROFILES.map(({ id, label }) => ({ value: id, label })) }],
    onChoice: (id) => session.set(defaultFeedback(id)),
  });
  const [middle, right, rail, region, law] = ["stage", "run", "rail", "map", "law"].map((name) => h("div", { class: `feedback-place ${name}` }));
  if (!middle || !right || !rail || !region || !law) return;
  main.replaceChildren(
    h("header", { class: "feedback-head" }, h("div", {}, h("p", { class: "design-path" }, h("a", { href: "/design" }, "Design"), " › State feedback"), h("h1", {}, "State feedback"), h("p", {}, "Take the plant out of its balance, let it go, and see the feedback catch it. Then find out from where it no longer can.")), chooser.root),
    h("div", { class: "feedback-bench" }, middle, right, rail, region, law),
  );
  const staged = stage.mount(middle, session, api, plants);
  const curved = curves.mount(right, session);
  const placed = poles.mount(rail, session);
  const set = settings.mount(rail, session);
  const mapped = map.mount(region, session, api);
  const told = numbers.mount(law, session);
  main.addEventListener("panel-expand", (event) => /** @type {HTMLElement} */ (event.target).classList.toggle("enlarged"));

  let frame = 0;
  let before = 0;
  /** @param {number} now */
  function show(now) {
    frame = 0;
    session.tick(Math.min(LONGEST_TICK, Math.max(0, (now - before) / 1000)));
    before = now;
    staged.frame();
    if (session.playing) {
      curved.frame(now);
      frame ||= requestAnimationFrame(show);
    }
  }
  let plant = "";
  let writing = 0;
  /** @param {{moving: boolean, design: boolean}} change */
  function refresh({ moving, design }) {
    // The first answer about a plant gives the axes.
    const anew = session.state.plant !== plant;
    if (anew) plant = session.state.plant;
    chooser.show(plant);
    staged.refresh();
    curved.refresh({ anew: anew || (design && !moving && session.clock === 0), moving: moving || session.playing });
    placed.refresh({ anew, moving });
    set.refresh();
    mapped.refresh({ anew });
    if (!moving) told.refresh();
    if (frame === 0) {
      before = performance.now();
      frame = requestAnimationFrame(show);
    }
    if (moving) return;
    clearTimeout(writing);
    writing = window.setTimeout(() => {
      const query = toQuery(session.state);
      history.replaceState(null, "", query ? `?${query}` : location.pathname);
    }, 200);
  }
  session.subscribe(refresh);
  refresh({ moving: false, design: true });
  session.ask();
}

const main = document.getElementById("main");
if (main) void open(main);
