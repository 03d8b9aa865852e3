/** A predictor, its model and a plant that differs: responses, the plants it stands, numbers. */

import { createApi } from "../core/api.js";
import { createDesignBench, writeAddress } from "../core/design/bench.js";
import { judge, smithFromQuery, smithToQuery } from "../core/design/smith.js";
import { h } from "../components/dom.js";
import { enlargeable } from "../components/enlarge.js";
import "../components/site-header.js";
import * as compare from "../panels/smith-predictor/compare.js";
import * as form from "../panels/smith-predictor/form.js";
import * as region from "../panels/smith-predictor/region.js";
import * as response from "../panels/smith-predictor/response.js";

const host = document.getElementById("bench");
if (host) {
  const api = createApi();
  const bench = createDesignBench({
    state: smithFromQuery(location.search),
    send: (state, how) => judge(api, state, how),
    write: (state) => writeAddress(smithToQuery(state)),
  });
  const [rail, stage, side] = [h("div", { class: "design-rail" }), h("div", { class: "design-stage" }), h("div", { class: "design-side" })];
  host.append(rail, stage, side);
  form.mount(rail, bench);
  response.mount(stage, bench);
  region.mount(stage, bench);
  compare.mount(side, bench);
  enlargeable(host);
}
