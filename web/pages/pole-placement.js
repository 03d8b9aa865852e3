/** Poles wanted, controller found: plane, responses, controller. */

import { createApi } from "../core/api.js";
import { createDesignBench, writeAddress } from "../core/design/bench.js";
import { countOf, groupsOf, trimmed } from "../core/design/pole-groups.js";
import { place, placementFromQuery, placementToQuery } from "../core/design/pole-placement.js";
import { h } from "../components/dom.js";
import { enlargeable } from "../components/enlarge.js";
import "../components/site-header.js";
import * as poles from "../panels/pole-placement/desired-poles.js";
import * as controller from "../panels/pole-placement/controller.js";
import * as response from "../panels/pole-placement/response.js";
import * as form from "../panels/pole-placement/form.js";

const host = document.getElementById("bench");
if (host) {
  const api = createApi();
  const bench = createDesignBench({
    state: placementFromQuery(location.search),
    send: (state, how) => place(api, state, how),
    // Poles that were added or left out; the others stay as they are, and so do their handles.
    accept({ groups }, { design }, { moving }) {
      if (moving || countOf(groups) === design.wanted.length) return {};
      const kept = [...trimmed(groups, design.required), ...groupsOf(design.added)];
      return { groups: countOf(kept) === design.wanted.length ? kept : groupsOf(design.wanted) };
    },
    write: (state) => writeAddress(placementToQuery(state)),
  });
  const [rail, stage, side] = [h("div", { class: "design-rail" }), h("div", { class: "design-stage" }), h("div", { class: "design-side" })];
  host.append(rail, stage, side);
  form.mount(rail, bench);
  poles.mount(stage, bench);
  response.mount(stage, bench);
  controller.mount(side, bench);
  enlargeable(host);
}
