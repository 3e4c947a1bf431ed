// Colours of the page's style sheet, for what is drawn on a canvas.

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

const drawn = [];

/** Calls back when colours change: another scheme, or paper, which is always light. */
export function onTheme(redraw) {
  drawn.push(redraw);
}

export function isPaper() {
  return document.documentElement.classList.contains("paper");
}

/** What is drawn before all else is drawn for paper: paper has what was not yet looked at. */
export function onPaper(finish) {
  finishing.push(finish);
}

const finishing = [];
const paper = isNow => () => {
  document.documentElement.classList.toggle("paper", isNow);
  if (isNow) for (const finish of finishing) finish();
  for (const redraw of drawn) redraw();
};
addEventListener("beforeprint", paper(true));
addEventListener("afterprint", paper(false));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  for (const redraw of drawn) redraw();
});
