// What is read off a scene: names where frames are, and words of the link that is pointed at.
import {
  ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, Raycaster, Vector2,
  Vector3,
} from "three";

const AXES = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
const UP = new Vector3(0, 1, 0);
/** Red, green, blue of frames, as the style sheet has them. */
const COLOURS = ["x", "y", "z"];
const APART = 14;
/** How near a frame the pointer must be, in pixels. */
const REACH = 24;

/** An arrow from the origin along y, of length 1: its shaft and its head. */
function arrowParts() {
  const [thick, wide, head] = [0.035, 0.1, 0.28];
  const shaft = new CylinderGeometry(thick, thick, 1 - head, 8).translate(0, 0.5 * (1 - head), 0);
  return [shaft, new ConeGeometry(wide, head, 12).translate(0, 1 - 0.5 * head, 0)];
}

export class Hints {
  constructor(figure, data, robot, stage) {
    Object.assign(this, { data, robot, stage });
    this.now = figure.querySelector(".now");
    this.box = figure.querySelector(".labels");
    this.group = new Group();
    // seen through what stands around them: a joint is thicker than a frame is long
    this.axes = AXES.map(() => new MeshBasicMaterial({ depthTest: false, transparent: true }));
    this.parts = arrowParts();
    this.frames = data.frames ? data.links.map(link => this.frame(link)) : [];
    this.labels = data.links.map(link => this.label(link));
    this.ray = new Raycaster();
    stage.canvas.addEventListener("pointermove", event => this.point(event));
    stage.onDraw = () => this.place();
  }

  frame(link) {
    if (!link.is_body) return null;
    const length = 5 * this.robot.radius;
    const group = new Group();
    AXES.forEach((axis, place) => {
      for (const part of this.parts) {
        const mesh = new Mesh(part, this.axes[place]);
        mesh.quaternion.copy(new Quaternion().setFromUnitVectors(UP, axis));
        mesh.scale.setScalar(length);
        mesh.renderOrder = 1;
        group.add(mesh);
      }
    });
    this.group.add(group);
    return group;
  }

  label(link) {
    const isNamed = this.data.frames ? link.is_body : link.is_marked || link.is_joint_marked;
    if (!isNamed) return null;
    const label = document.createElement("span");
    label.textContent = link.name;
    this.box.append(label);
    return label;
  }

  toggle(isShown) {
    this.group.visible = isShown;
    this.box.classList.toggle("away", !isShown);
  }

  paint(colour) {
    this.axes.forEach((material, axis) => material.color.set(colour(COLOURS[axis])));
  }

  /** Where the links are now. */
  show(poses) {
    this.poses = poses;
    this.frames.forEach((frame, link) => {
      frame?.position.copy(poses[link][0]);
      frame?.quaternion.copy(poses[link][1]);
    });
  }

  /** Puts names beside their joints or frames; of several in one place the others go below. */
  place() {
    if (!this.poses) return;
    const { clientWidth: wide, clientHeight: tall } = this.stage.canvas;
    const taken = [];
    const side = new Vector3().setFromMatrixColumn(this.stage.camera.matrixWorld, 0)
      .multiplyScalar(1.6 * this.robot.radius);
    const up = new Vector3().setFromMatrixColumn(this.stage.camera.matrixWorld, 1)
      .multiplyScalar(2.2 * this.robot.radius);
    this.labels.forEach((label, link) => {
      if (!label) return;
      const own = this.data.links[link];
      // the name of a link is that of its joint: it stands where the joint is
      const isJoint = own.is_joint && !own.is_marked || own.is_joint_marked;
      const at = isJoint ? this.robot.seats[link][0] : this.poses[link][0];
      // beside and above what is drawn there
      const wider = own.is_joint_marked ? 1.5 : 1;
      const seen = at.clone().addScaledVector(side, wider)
        .addScaledVector(up, wider).project(this.stage.camera);
      const middle = at.clone().project(this.stage.camera);
      label.hidden = seen.z > 1 || Math.abs(middle.x) > 1 || Math.abs(middle.y) > 1;
      if (label.hidden) return;
      const [long, high] = [label.offsetWidth, APART];
      // where it does not fit on the right it stands on the left, and never beyond the edge
      let x = (0.5 + 0.5 * seen.x) * wide + 5;
      if (x + long > wide) x = (0.5 + middle.x - 0.5 * seen.x) * wide - 5 - long;
      x = Math.max(2, Math.min(x, wide - long - 2));
      let y = Math.max(2, (0.5 - 0.5 * seen.y) * tall - 8);
      const meets = ([a, b, c]) => x < a + c && a < x + long && Math.abs(b - y) < APART;
      const first = y;
      while (taken.some(meets)) y += APART;
      // at the lower edge they go up instead
      if (y > tall - high) for (y = first; taken.some(meets);) y -= APART;
      taken.push([x, y, long]);
      // on paper, where the stage has another size, they stay beside what they name
      label.style.left = `${(100 * x / wide).toFixed(2)}%`;
      label.style.top = `${(100 * y / tall).toFixed(2)}%`;
    });
  }

  /** The link whose frame is seen next to the pointer. */
  nearest(event, frame) {
    let [found, least] = [undefined, REACH];
    this.data.links.forEach((link, place) => {
      if (!link.is_body || !this.poses) return;
      const seen = this.poses[place][0].clone().project(this.stage.camera);
      const x = (0.5 + 0.5 * seen.x) * frame.width + frame.left - event.clientX;
      const y = (0.5 - 0.5 * seen.y) * frame.height + frame.top - event.clientY;
      const away = Math.hypot(x, y);
      if (away < least) [found, least] = [place, away];
    });
    return found;
  }

  point(event) {
    if (event.buttons !== 0) return;
    const frame = this.stage.canvas.getBoundingClientRect();
    const at = new Vector2(
      (2 * (event.clientX - frame.left)) / frame.width - 1,
      1 - (2 * (event.clientY - frame.top)) / frame.height);
    this.ray.setFromCamera(at, this.stage.camera);
    const met = this.ray.intersectObject(this.robot.group, true)
      .find(one => one.object.userData.link !== undefined);
    const place = met ? met.object.userData.link : this.nearest(event, frame);
    if (place === undefined) return;
    const link = this.data.links[place];
    this.now.textContent = link.text || link.name || "";
  }
}
