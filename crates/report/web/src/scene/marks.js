// What is shown beside the robot: forces, balance points, the support polygon, the trail.
import {
  ArrowHelper, BufferGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial, Mesh,
  MeshBasicMaterial, SphereGeometry, Vector3,
} from "three";
import { place } from "./frames.js";

/** Names of marks, each with the colour of the style sheet. */
const COLOURS = { com: "computed", zmp: "before", capture: "capture", support: "good", force: "force" };

function line() {
  return new Line(new BufferGeometry(), new LineBasicMaterial());
}

function setPoints(of, points) {
  of.geometry.dispose();
  of.geometry = new BufferGeometry();
  of.geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
}

export class Marks {
  constructor(data) {
    this.data = data;
    this.isShown = true;
    const dot = (radius = 0.02) =>
      new Mesh(new SphereGeometry(radius * data.view, 16, 12), new MeshBasicMaterial());
    this.parts = { com: new Group(), zmp: new Group(), capture: new Group(), support: new Group(),
      force: new Group() };
    this.com = dot(0.022);
    // thin lines along the path of the centre of mass, up to now
    this.trail = line();
    this.parts.com.add(this.com, this.trail);
    this.trail.frustumCulled = false;
    this.zmp = dot();
    this.parts.zmp.add(this.zmp);
    this.capture = dot();
    this.parts.capture.add(this.capture);
    this.support = line();
    this.support.frustumCulled = false;
    this.parts.support.add(this.support);
    this.arrows = data.contacts.map(() => new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1));
    if (this.arrows.length > 0) this.parts.force.add(...this.arrows);
    this.group = new Group().add(...Object.values(this.parts));
    if (data.com) setPoints(this.trail, data.com);
  }

  paint(colour) {
    for (const [name, group] of Object.entries(this.parts)) {
      group.traverse(part => part.material?.color.set(colour(COLOURS[name])));
    }
  }

  toggle(name, isShown) {
    if (!this.parts[name]) return;
    if (name === "com") this.isShown = isShown;
    this.parts[name].visible = isShown;
  }

  /** The centre of mass of a robot whose joints are moved by hand. */
  stay(center) {
    this.group.children.forEach(part => { part.visible = part === this.parts.com && this.isShown; });
    this.com.visible = Boolean(center);
    this.trail.visible = false;
    if (center) this.com.position.copy(center);
  }

  show(at, poses) {
    const { data } = this;
    const put = (mesh, list) => {
      const point = list && place(list, at);
      mesh.visible = Boolean(point);
      if (point) mesh.position.copy(point);
    };
    put(this.com, data.com);
    put(this.zmp, data.zmp);
    put(this.capture, data.capture);
    this.trail.geometry.setDrawRange(0, at[0] + 1);
    const polygon = data.support?.[at[0]] ?? [];
    this.support.visible = polygon.length >= 6;
    // closed, and drawn a little above the ground
    if (this.support.visible) setPoints(this.support, [...polygon, ...polygon.slice(0, 3)]);
    this.arrows.forEach((arrow, contact) => this.push(arrow, contact, at, poses));
  }

  push(arrow, contact, at, poses) {
    const { data } = this;
    const force = data.forces && place(data.forces, at, data.contacts.length, contact);
    // impacts are larger than a picture
    const share = force ? Math.min(2, force.length() / data.force_n) : 0;
    const length = share * 0.5 * data.size;
    arrow.visible = length > 0.01 * data.size;
    if (!arrow.visible) return;
    const { link, at: point } = data.contacts[contact];
    const [origin, turn] = poses[link];
    arrow.position.copy(new Vector3(...point).applyQuaternion(turn).add(origin));
    arrow.setDirection(force.normalize());
    arrow.setLength(length, Math.min(0.3 * length, 0.06 * data.size), 0.035 * data.size);
  }
}
