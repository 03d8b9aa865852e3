// A classic script in the head: the theme is set before anything is painted, so that a dark page never flashes white.
// components/theme.js keeps it up to date afterwards.
(() => {
  let choice = null;
  try {
    choice = localStorage.getItem("looplab-theme");
  } catch {
    // no storage: follow the system
  }
  const dark = choice === "dark" || (choice !== "light" && matchMedia("(prefers-color-scheme: dark)").matches);
  document.documentElement.dataset["theme"] = dark ? "dark" : "light";
})();
