// SPDX-License-Identifier: Apache-2.0
// Light or dark, before anything is drawn: `data-theme` of the page is one of the two. Only this file knows where the choice
// is kept; "auto" is what the system says.
"use strict";
window.axisgateTheme = (() => {
  const choices = ["auto", "light", "dark"];
  const system = matchMedia("(prefers-color-scheme: dark)");
  let choice = "auto";
  try {
    choice = localStorage.getItem("axisgate-theme") ?? choice;
  } catch { /* a browser that keeps nothing */ }
  if (!choices.includes(choice)) choice = "auto";
  function show() {
    document.documentElement.dataset.theme = choice === "auto" ? (system.matches ? "dark" : "light") : choice;
    window.dispatchEvent(new Event("themechange"));
  }
  system.addEventListener("change", show);
  show();
  return {
    chosen: () => choice,
    choose(next) {
      choice = next;
      try {
        localStorage.setItem("axisgate-theme", choice);
      } catch { /* it holds for this page alone */ }
      show();
    },
    next() {
      this.choose(choices[(choices.indexOf(choice) + 1) % choices.length]);
    },
  };
})();
