// Sets the theme before anything is drawn, the chosen one or the system's; all else waits for the
// modules.
(() => {
  // A page that was opened as a file may not load modules; a line in it says what to do.
  if (location.protocol === "file:") document.documentElement.dataset.opened = "file";
  const darkSystem = matchMedia("(prefers-color-scheme: dark)");
  const show = () => {
    let theme;
    try {
      ({ theme } = JSON.parse(localStorage.getItem("yehu") ?? "{}"));
    } catch {
      // Nothing is kept here.
    }
    const isChosen = theme === "dark" || theme === "light";
    document.documentElement.dataset.theme = isChosen
      ? theme
      : darkSystem.matches
        ? "dark"
        : "light";
  };
  darkSystem.addEventListener("change", show);
  show();
})();
