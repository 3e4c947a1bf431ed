// The controls of a run: play, time, speed, what is shown, events.
import { Vector3 } from "three";
import { Arcs } from "./arcs.js";
import { between, place, posesOfList } from "./frames.js";
import { Hints } from "./hints.js";
import { centerOf, posesOf, positionsAt, startOf } from "./jointed.js";
import { Marks } from "./marks.js";
import { Robot } from "./robot.js";
import { Stage } from "./stage.js";
import { colour, onTheme } from "../theme.js";

const NEAR_S = 0.08;

class Player {
  constructor(figure, data) {
    this.data = data;
    // joints that are moved here, or poses that were computed beforehand
    this.isJointed = Boolean(data.joints);
    this.stage = new Stage(figure.querySelector("canvas"), data);
    this.robot = new Robot(data);
    this.marks = new Marks(data);
    this.hints = new Hints(figure, data, this.robot, this.stage);
    this.arcs = new Arcs(data, this.robot.radius);
    // the same robot in another motion
    this.ghost = data.beside ? new Robot(data, true) : null;
    this.isGhostShown = true;
    this.stage.scene.add(this.robot.group, this.marks.group, this.hints.group, this.arcs.group);
    if (this.ghost) this.stage.scene.add(this.ghost.group);
    const find = name => figure.querySelector(name);
    this.slider = find(".line input");
    this.clock = find(".controls output");
    this.button = find(".play");
    this.speed = find("select");
    this.now = find(".now");
    this.time = data.t[0];
    this.last = null;
    this.q = this.isJointed ? startOf(data) : null;
    this.isFollowing = data.follows && !this.isJointed;
    this.shift = new Vector3(...data.center);
    if (data.com?.length > 2) this.shift.sub(new Vector3(...data.com.slice(0, 3)));
    if (!this.isFollowing) this.stage.follow(new Vector3(...data.center));
    this.listen(figure);
    if (this.button) {
      this.listenToTime();
      this.showEvents(find(".ticks"));
    }
    this.paint();
  }

  listen(figure) {
    figure.querySelector(".home").addEventListener("click", () => {
      this.stage.home();
      this.stage.draw();
    });
    figure.querySelectorAll(".marks input").forEach(box => {
      box.addEventListener("change", () => {
        if (box.value === "frames") this.hints.toggle(box.checked);
        if (box.value === "beside") this.isGhostShown = box.checked;
        if (box.value === "shapes") {
          for (const one of [this.robot, this.ghost]) if (one) one.shapes.isShown = box.checked;
        }
        this.marks.toggle(box.value, box.checked);
        this.arcs.toggle(box.value, box.checked);
        this.show(this.time);
      });
    });
    const joints = [...figure.querySelectorAll(".joints input")];
    const read = input => {
      const joint = this.data.joints.findIndex(one => one.name === input.dataset.joint);
      this.q[joint] = Number(input.value);
      const text = `${Number(input.value).toFixed(3)} ${input.dataset.unit}`;
      input.parentNode.querySelector("output").textContent = text;
      input.setAttribute("aria-valuetext", text);
    };
    joints.forEach(input => {
      read(input);
      input.addEventListener("input", () => {
        read(input);
        this.show(this.time);
      });
    });
    figure.querySelector(".zero")?.addEventListener("click", () => {
      joints.forEach(input => {
        input.value = input.getAttribute("value");
        read(input);
      });
      this.show(this.time);
    });
    new ResizeObserver(() => this.stage.resize()).observe(this.stage.canvas);
    onTheme(() => this.paint());
  }

  listenToTime() {
    const { t } = this.data;
    this.slider.addEventListener("input", () => {
      this.pause();
      this.show(Number(this.slider.value));
    });
    this.button.addEventListener("click", () => (this.last === null ? this.play() : this.pause()));
    this.slider.min = t[0];
    this.slider.max = t[t.length - 1];
    this.slider.step = "any";
  }

  /** Marks of the events above the slider. */
  showEvents(box) {
    const { t, events } = this.data;
    const over = t[t.length - 1] - t[0] || 1;
    for (const event of events) {
      const mark = document.createElement("i");
      mark.style.left = `${(100 * (event.t - t[0])) / over}%`;
      mark.title = `${event.t.toFixed(3)} s: ${event.text}`;
      box.append(mark);
    }
  }

  paint() {
    const parts = [this.robot, this.ghost, this.marks, this.hints, this.arcs, this.stage];
    for (const part of parts) part?.paint(colour);
    this.show(this.time);
  }

  /** Where the links are at a time. */
  poses(at) {
    const { data } = this;
    if (!this.isJointed) return posesOfList(data.poses, data.links.length, at);
    return posesOf(data, this.button ? positionsAt(data, at) : this.q);
  }

  /** The other motion, where there is any at that time. */
  showGhost(at) {
    const { data, ghost } = this;
    const poses = this.isJointed
      ? posesOf(data, positionsAt(data, at, data.beside))
      : posesOfList(data.beside, data.links.length, at);
    ghost.group.visible = this.isGhostShown && poses !== null;
    if (poses) ghost.show(poses);
  }

  show(time) {
    const { data } = this;
    this.time = time;
    const at = this.button ? between(data.t, time) : [0, 0];
    const poses = this.poses(at);
    this.robot.show(poses);
    if (this.ghost) this.showGhost(at);
    this.arcs.show(at, this.robot);
    this.hints.show(poses);
    if (this.isJointed) this.marks.stay(centerOf(data, poses));
    else this.marks.show(at, poses);
    if (this.isFollowing) {
      const center = place(data.com, at);
      if (center) this.stage.follow(center.add(this.shift));
    }
    if (this.button) this.tell(time);
    this.stage.draw();
  }

  /** The time, and what happened just before it. */
  tell(time) {
    this.slider.value = time;
    this.slider.setAttribute("aria-valuetext", `${time.toFixed(2)} s`);
    this.clock.textContent = `${time.toFixed(2)} s`;
    const past = this.data.events.filter(event => event.t <= time + 1e-9).pop();
    const isNear = past && time - past.t < NEAR_S * 5;
    this.now.textContent = isNear ? `${past.t.toFixed(3)} s: ${past.text}` : "";
  }

  play() {
    const { t } = this.data;
    const end = t[t.length - 1];
    if (this.time >= end) this.time = t[0];
    this.last = performance.now();
    this.button.textContent = "Pause";
    const tick = now => {
      if (this.last === null) return;
      const passed = ((now - this.last) / 1000) * Number(this.speed.value);
      this.last = now;
      this.show(Math.min(end, this.time + Math.max(0, passed)));
      if (this.time >= end) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.last = null;
    this.button.textContent = "Play";
  }
}

export function makePlayer(figure, data) {
  let player;
  try {
    player = new Player(figure, data);
  } catch (error) {
    // a browser without WebGL: the rest of the page is as useful
    figure.querySelector(".now").textContent = `Nothing is drawn in 3D: ${error.message}`;
    return;
  }
  player.stage.resize();
}
