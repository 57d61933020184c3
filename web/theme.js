// Sets the chosen theme before anything is drawn; all else waits for the modules.
(() => {
  try {
    const { theme } = JSON.parse(localStorage.getItem("yehu") ?? "{}");
    if (theme === "dark" || theme === "light") document.documentElement.dataset.theme = theme;
  } catch {
    // Nothing is kept here: the system's theme.
  }
})();
