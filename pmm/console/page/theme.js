// Light or dark: as the system says, until somebody chooses.
(() => {
  const key = "pmm-theme";
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const asked = new URLSearchParams(location.search).get("theme");
  const apply = () => {
    const theme = asked || localStorage.getItem(key) || (dark.matches ? "dark" : "light");
    document.documentElement.dataset.theme = theme;
    dispatchEvent(new Event("pmm-theme"));
  };
  dark.addEventListener("change", apply);
  addEventListener("DOMContentLoaded", () => {
    const button = document.getElementById("theme");
    if (button) button.addEventListener("click", () => {
      const now = document.documentElement.dataset.theme;
      localStorage.setItem(key, now === "dark" ? "light" : "dark");
      apply();
    });
  });
  apply();
})();
