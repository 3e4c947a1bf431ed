// Runs in three dimensions: poses that were computed beforehand, played back.
import { makePlayer } from "./scene/player.js";

document.querySelectorAll("figure.scene").forEach(figure => {
  const source = figure.querySelector("script[type='application/json']").textContent;
  makePlayer(figure, JSON.parse(source));
});
document.documentElement.dataset.scene = "yes";
