/** The home page: a small live loop to take hold of at once, and the labs. */

import { createApi } from "../core/api.js";
import { defaultState } from "../core/workbench/presets.js";
import { startSession } from "../core/workbench/session.js";
import { createStore } from "../core/store.js";
import "../components/labs-list.js";
import "../components/site-header.js";
import * as teaser from "../panels/home/teaser.js";

const host = document.getElementById("teaser");
if (host) {
  const api = createApi();
  const store = createStore(defaultState());
  teaser.mount(host, store, api);
  startSession(store, api);
}
