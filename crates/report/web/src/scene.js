// Runs in three dimensions: poses that were computed beforehand, played back.
import { makePlayer } from "./scene/player.js";
import { makeWhenSeen } from "./seen.js";

makeWhenSeen(document.querySelectorAll("figure.scene"), "scene", figure => {
  const source = figure.querySelector("script[type='application/json']").textContent;
  makePlayer(figure, JSON.parse(source));
});
