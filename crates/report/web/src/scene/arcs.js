// What models leave of the torques of joints: arcs about joints that turn, bars along those that
// slide, before and after effects were found.
import {
  ConeGeometry, Curve, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, TubeGeometry,
  Vector3,
} from "three";

/** The arc of the largest of all: three quarters of a turn. */
const WHOLE = 1.5 * Math.PI;
const PARTS = 72;
const ROUND = 8;
/** Radius, thickness and colour of each, in radii of links. */
const LOOKS = { before: [4.4, 0.5, "before"], after: [6, 0.5, "measured"] };
const Z = new Vector3(0, 0, 1);
const UP = new Vector3(0, 1, 0);

class Arc extends Curve {
  constructor(radius) {
    super();
    this.radius = radius;
  }

  getPoint(share, target = new Vector3()) {
    const angle = share * WHOLE;
    return target.set(this.radius * Math.cos(angle), this.radius * Math.sin(angle), 0);
  }
}

/** An arrow that goes about the z axis. */
class Turn {
  constructor(radius, thick, material) {
    this.radius = radius;
    this.tube = new Mesh(new TubeGeometry(new Arc(radius), PARTS, thick, ROUND), material);
    this.head = new Mesh(new ConeGeometry(2.2 * thick, 5 * thick, 2 * ROUND), material);
    this.group = new Group().add(this.tube, this.head);
  }

  put(share) {
    const parts = Math.round(Math.abs(share) * PARTS);
    this.group.visible = parts > 0;
    this.tube.geometry.setDrawRange(0, 6 * ROUND * parts);
    const angle = (parts / PARTS) * WHOLE;
    this.head.position.set(this.radius * Math.cos(angle), this.radius * Math.sin(angle), 0);
    this.head.rotation.z = angle;
    this.group.scale.y = share < 0 ? -1 : 1;
  }
}

/** A bar along the z axis, beside it. */
class Bar {
  constructor(radius, thick, material) {
    this.long = 4 * radius;
    this.bar = new Mesh(new CylinderGeometry(thick, thick, 1, ROUND), material);
    this.bar.position.x = radius;
    this.bar.quaternion.setFromUnitVectors(UP, Z);
    this.group = new Group().add(this.bar);
  }

  put(share) {
    const length = Math.abs(share) * this.long;
    this.group.visible = length > 0.01 * this.long;
    this.bar.scale.y = Math.max(length, 1e-9);
    this.bar.position.z = 0.5 * share * this.long;
  }
}

export class Arcs {
  constructor(data, radius) {
    this.data = data;
    this.group = new Group();
    this.isShown = { before: true, after: true };
    this.materials = {};
    this.signs = [];
    if (!data.left) return;
    for (const [key, [away, thick]] of Object.entries(LOOKS)) {
      const material = new MeshBasicMaterial();
      this.materials[key] = material;
      data.links.forEach((link, place) => {
        if (link.joint < 0 || !link.is_joint) return;
        const Sign = link.slides ? Bar : Turn;
        const sign = new Sign(away * radius, thick * radius, material);
        this.signs.push({ key, sign, place, link });
        this.group.add(sign.group);
      });
    }
  }

  paint(colour) {
    for (const [key, material] of Object.entries(this.materials)) {
      material.color.set(colour(LOOKS[key][2]));
    }
  }

  toggle(key, isShown) {
    if (key in this.isShown) this.isShown[key] = isShown;
  }

  /** At a frame, where the joints of a robot are. */
  show([frame], robot) {
    const { left, joints } = this.data;
    for (const { key, sign, place, link } of this.signs) {
      const value = left[key][frame * joints.length + link.joint];
      const [foot, turn] = robot.seats[place];
      sign.put((value ?? 0) / (link.slides ? left.full_n : left.full_nm));
      sign.group.position.copy(foot);
      sign.group.quaternion.copy(turn ?? new Quaternion());
      sign.group.visible &&= this.isShown[key];
    }
  }
}
