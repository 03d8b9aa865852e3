/** `<site-header current="workbench">`: the head of every page, with skip link, navigation and theme. */

import { h, svg } from "./dom.js";
import { icon } from "./icons.js";
import { chooseTheme, themeChoice } from "./theme.js";

const PAGES = [
  { id: "home", href: "/", label: "Home" },
  { id: "workbench", href: "/workbench", label: "Workbench" },
  { id: "plants", href: "/plants", label: "Plants" },
  { id: "experiments", href: "/experiments", label: "Experiments" },
  { id: "design", href: "/design", label: "Design" },
  { id: "labs", href: "/labs", label: "Labs" },
];

const PEEK = 28;

/** @type {Record<import("./theme.js").ThemeChoice, {icon: string, label: string, next: import("./theme.js").ThemeChoice}>} */
const THEMES = {
  auto: { icon: "auto", label: "Theme: as the system has it", next: "light" },
  light: { icon: "sun", label: "Theme: light", next: "dark" },
  dark: { icon: "moon", label: "Theme: dark", next: "auto" },
};

export class SiteHeader extends HTMLElement {
  connectedCallback() {
    if (this.firstChild) return;
    const current = this.getAttribute("current");
    const theme = h("button", { type: "button", class: "icon-button theme-toggle" });
    const show = () => {
      const now = THEMES[themeChoice()];
      theme.replaceChildren(icon(now.icon));
      theme.setAttribute("aria-label", `${now.label}. Change`);
      theme.title = now.label;
    };
    theme.addEventListener("click", () => {
      chooseTheme(THEMES[themeChoice()].next);
      show();
    });
    show();
    const nav = h("nav", { "aria-label": "Pages" }, ...PAGES.map(({ id, href, label }) => h("a", { href, "aria-current": id === current ? "page" : null }, label)));
    this.append(
      h("a", { class: "skip-link", href: "#main" }, "Skip to content"),
      h(
        "header",
        { class: "site-header" },
        h("a", { class: "brand", href: "/", "aria-label": "looplab, home" }, brandMark(), h("span", {}, "looplab")),
        nav,
        theme,
      ),
    );
    // On a narrow screen the page that is shown may be out of sight; a piece of the next one tells that there is more.
    const here = /** @type {HTMLElement | null} */ (nav.querySelector("[aria-current]"));
    if (here) nav.scrollLeft = here.offsetLeft + here.offsetWidth + PEEK - nav.offsetLeft - nav.clientWidth;
  }
}

/** A step response in a circle. */
function brandMark() {
  return svg("svg", { viewBox: "0 0 24 24", class: "brand-mark", "aria-hidden": "true", focusable: "false" }, svg("path", { d: "M2 20c4 0 4-15 8-15s3 8.5 6 8.5 2-3 6-3" }));
}

customElements.define("site-header", SiteHeader);
