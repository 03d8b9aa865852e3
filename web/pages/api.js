/** The API's own page: its description read from the server, each route with an example to send. */

import { routesOf } from "../core/openapi.js";
import { apiRoute } from "../components/api-route.js";
import { h } from "../components/dom.js";
import "../components/site-header.js";

const about = document.getElementById("about");
const routes = document.getElementById("routes");

try {
  const response = await fetch("/api/v1/openapi.json");
  const description = await response.json();
  const all = routesOf(description);
  about?.append(
    ...String(description.info.description ?? "").split("\n\n").slice(1).map((text) => h("p", {}, text)),
    h("ul", { class: "api-index" }, ...all.map(({ id, method, path, summary }) => h("li", {}, h("a", { href: `#${id}` }, `${method} ${path.replace("/api/v1", "")}`), ` ${summary}`))),
  );
  routes?.replaceChildren(...all.map(apiRoute));
  document.getElementById(location.hash.slice(1))?.scrollIntoView();
} catch {
  routes?.replaceChildren(h("p", { class: "empty" }, "The description could not be loaded. Is the server still running?"));
}
