// What takes time is made when a reader comes near it, one after the other, and after the page is
// painted: until then the page answers.
import { onPaper } from "./theme.js";

/** How near: about a screen below what is seen. */
const NEAR = "400px";

/**
 * Makes each of these figures once, when it is near. The page says by `data-NAME` whether all that
 * are near are made.
 */
export function makeWhenSeen(figures, name, make) {
  const left = new Set(figures);
  const next = [];
  let isBusy = false;
  const root = document.documentElement;
  const finish = figure => {
    if (left.delete(figure)) make(figure);
    figure.dataset.made = "yes";
  };
  const work = () => {
    const figure = next.shift();
    isBusy = next.length > 0;
    // the others are made whatever becomes of this one
    if (isBusy) afterPaint(work);
    if (figure) finish(figure);
    root.dataset[name] = isBusy ? "no" : "yes";
  };
  const observer = new IntersectionObserver(entries => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      observer.unobserve(target);
      next.push(target);
    }
    if (isBusy) return;
    isBusy = true;
    root.dataset[name] = "no";
    afterPaint(work);
  }, { rootMargin: NEAR });
  for (const figure of left) observer.observe(figure);
  if (left.size === 0) root.dataset[name] = "yes";
  onPaper(() => [...left].forEach(finish));
}

/** A task of its own after the next picture of the page. */
function afterPaint(task) {
  // a page in the background is not painted
  if (document.hidden) setTimeout(task, 0);
  else requestAnimationFrame(() => setTimeout(task, 0));
}
