// Runs in three dimensions: poses that were computed beforehand, played back.
import { makePlayer } from "./scene/player.js";

// the rest of the page is there first: where no graphics card is, the first picture takes a second
setTimeout(() => {
  document.querySelectorAll("figure.scene").forEach(figure => {
    const source = figure.querySelector("script[type='application/json']").textContent;
    makePlayer(figure, JSON.parse(source));
  });
  document.documentElement.dataset.scene = "yes";
}, 0);
