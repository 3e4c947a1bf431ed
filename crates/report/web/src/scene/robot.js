// A robot as the rows of its Denavit-Hartenberg table: each link goes along the axis of its joint
// by d, then at a right angle by a, as a capsule each; joints are cylinders, slides are blocks.
import {
  BoxGeometry, BufferGeometry, CylinderGeometry, DoubleSide, Float32BufferAttribute, Group, Mesh,
  MeshLambertMaterial, Quaternion, SphereGeometry, Vector3,
} from "three";
import { Shapes } from "./shapes.js";

const UP = new Vector3(0, 1, 0);
const AXIS = new Vector3(0, 0, 1);
const ROUND = 20;
/** The radius of a link per size of what is seen. */
const THICK = 0.015;
/** A ghost is as much thicker, so that both are seen where they are in one place. */
const WIDER = 1.2;
/** What is marked has the colour of faults. */
const COLOURS = { marked: "bad" };

/** A cylinder with round ends, of length 1 until it is put between two points. */
class Capsule {
  constructor(radius, material) {
    this.rod = new Mesh(new CylinderGeometry(radius, radius, 1, ROUND, 1, true), material);
    const ball = new SphereGeometry(radius, ROUND, ROUND / 2);
    this.ends = [new Mesh(ball, material), new Mesh(ball, material)];
    this.group = new Group().add(this.rod, ...this.ends);
    this.least = 1e-3 * radius;
  }

  put(from, to) {
    const way = to.clone().sub(from);
    const length = way.length();
    this.group.visible = length > this.least;
    if (!this.group.visible) return;
    this.rod.position.copy(from).addScaledVector(way, 0.5);
    this.rod.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
    this.rod.scale.set(1, length, 1);
    this.ends[0].position.copy(from);
    this.ends[1].position.copy(to);
  }
}

function jointMesh(slides, radius, material) {
  const along = slides
    ? new BoxGeometry(3.3 * radius, 6 * radius, 3.3 * radius)
    : new CylinderGeometry(1.55 * radius, 1.55 * radius, 4.4 * radius, ROUND);
  return new Mesh(along, material);
}

/** A foot: all triangles of its contact points and its joint, of which the eye sees the hull. */
function footMesh(count, material) {
  const triangles = [];
  for (let a = 0; a < count; a++)
    for (let b = a + 1; b < count; b++) for (let c = b + 1; c < count; c++) triangles.push(a, b, c);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setIndex(triangles);
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

export class Robot {
  /** `ghost`: another motion of the same robot, through which the first is seen. */
  constructor(data, ghost = false) {
    this.data = data;
    this.ghost = ghost;
    this.group = new Group();
    const look = ghost ? { transparent: true, opacity: 0.45, depthWrite: false } : {};
    const material = () => new MeshLambertMaterial({ side: DoubleSide, ...look });
    this.materials = { link: material(), joint: material(), foot: material(), marked: material(),
      shape: material() };
    this.materials.shape.flatShading = true;
    // as many pixels in every picture, however far its joints reach
    const radius = THICK * data.view * (ghost ? WIDER : 1);
    this.radius = radius;
    this.seats = [];
    const { link: body, joint, foot, marked } = this.materials;
    this.links = data.links.map((link, place) => {
      const of = link.is_marked ? marked : body;
      const wide = link.is_marked ? 1.5 * radius : radius;
      const parts = {
        along: new Capsule(wide, of),
        across: new Capsule(wide, of),
        joint: link.is_joint
          ? jointMesh(link.slides, (link.is_joint_marked ? 1.5 : 1) * radius,
            link.is_joint_marked ? marked : joint)
          : null,
        ball: link.radius ? new Mesh(new SphereGeometry(link.radius, 24, 16), body) : null,
      };
      const all = [parts.along.group, parts.across.group, parts.joint, parts.ball];
      for (const part of all) part?.traverse(one => { one.userData.link = place; });
      return parts;
    });
    for (const one of this.links) {
      this.group.add(one.along.group, one.across.group);
      if (one.joint) this.group.add(one.joint);
      if (one.ball) this.group.add(one.ball);
    }
    this.tips = data.tips.map(() => new Capsule(radius, body));
    this.feet = data.feet.map(own => footMesh(own.points.length + 1, foot));
    this.spikes = data.feet.map(own => own.points.map(() => new Capsule(0.5 * radius, foot)));
    const capsules = [...this.tips, ...this.spikes.flat()].map(one => one.group);
    for (const part of [...capsules, ...this.feet]) this.group.add(part);
    this.rows = [...this.group.children];
    this.shapes = new Shapes(data, this.materials.shape);
    for (const mesh of this.shapes.all) this.group.add(mesh);
  }

  paint(colour) {
    for (const [name, material] of Object.entries(this.materials)) {
      material.color.set(colour(this.ghost ? "measured" : COLOURS[name] ?? name));
    }
  }

  /** Moves all parts to where the links are. */
  show(poses) {
    const { data } = this;
    const base = [new Vector3(...data.base), new Quaternion()];
    data.links.forEach((link, place) => {
      const [origin, own] = poses[place];
      const [from, turn] = link.carrier < 0 ? base : poses[link.carrier];
      const axis = AXIS.clone().applyQuaternion(data.is_modified ? own : turn);
      // along the axis of the joint, then at a right angle to it; a modified row the other way
      const [foot, head] = data.is_modified ? [origin, from] : [from, origin];
      const corner = foot.clone().addScaledVector(axis, head.clone().sub(foot).dot(axis));
      const parts = this.links[place];
      // where its joint is, with the frame that it turns in
      this.seats[place] = [foot, data.is_modified ? own : turn];
      if (link.is_body) {
        parts.along.put(from, corner);
        parts.across.put(corner, origin);
      }
      parts.along.group.visible &&= link.is_body;
      parts.across.group.visible &&= link.is_body;
      parts.ball?.position.copy(origin);
      if (parts.joint) {
        parts.joint.position.copy(foot);
        parts.joint.quaternion.setFromUnitVectors(UP, axis);
      }
    });
    const seen = (link, point) =>
      new Vector3(...point).applyQuaternion(poses[link][1]).add(poses[link][0]);
    data.tips.forEach((tip, place) => {
      this.tips[place].put(poses[tip.link][0], seen(tip.link, tip.at));
    });
    data.feet.forEach((foot, place) => this.stand(foot, place, poses, seen));
    this.shapes.show(poses);
    // what is put anew is seen again
    const isHidden = this.shapes.isWhole;
    if (isHidden || this.wasHidden) {
      for (const one of this.rows) {
        if (isHidden) one.visible = false;
        else if (!this.isPut(one)) one.visible = true;
      }
    }
    this.wasHidden = isHidden;
  }

  /** Whether a part says itself, whenever it is put, whether it is seen. */
  isPut(part) {
    const capsules = [...this.links.flatMap(one => [one.along, one.across]), ...this.tips,
      ...this.spikes.flat()];
    return capsules.some(one => one.group === part);
  }

  stand(foot, place, poses, seen) {
    const ankle = foot.carrier < 0 ? poses[foot.link][0] : poses[foot.carrier][0];
    const points = foot.points.map(point => seen(foot.link, point));
    const vertices = this.feet[place].geometry.getAttribute("position");
    [ankle, ...points].forEach((point, at) => vertices.setXYZ(at, point.x, point.y, point.z));
    vertices.needsUpdate = true;
    this.feet[place].geometry.computeVertexNormals();
    // a foot of one or two points has no area
    this.spikes[place].forEach((spike, at) => {
      if (points.length < 3) spike.put(ankle, points[at]);
      else spike.group.visible = false;
    });
  }
}
