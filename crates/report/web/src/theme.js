// Colours of the page's style sheet, for what is drawn on a canvas.

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Calls back when colours change: another scheme, or paper, which is always light. */
export function onTheme(redraw) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  const paper = isPaper => () => {
    document.documentElement.classList.toggle("paper", isPaper);
    redraw();
  };
  addEventListener("beforeprint", paper(true));
  addEventListener("afterprint", paper(false));
}
