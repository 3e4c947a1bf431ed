// What a motion passes, and from how near all of it is seen.
import { Vector3 } from "three";
import { place, posesOfList } from "./frames.js";
import { positionsAt, posesOf } from "./jointed.js";
import { endsOf } from "./shapes.js";

/** Postures that are looked at: the same ones every time. */
const POSTURES = 120;
/** What is seen is by so much larger than what must be. */
const ROOM = 1.18;
/** The least that is seen, of the size of the robot; one that is a point has that of its way. */
const CLOSEST = { still: 0.3, followed: 0.9 };
/** No wider than that is a picture filled, in its heights. */
const WIDEST = 2;

/** A posture of a robot whose joints are moved by hand. */
function posture(data, number) {
  return data.joints.map((joint, place) => {
    if (!joint.is_shown || number === 0) return joint.start;
    // evenly spread, each joint by another irrational step
    const share = (number * Math.sqrt(place + 2)) % 1;
    return joint.low + share * (joint.high - joint.low);
  });
}

/** Places and turns of the links in some frame, of the robot and of what is beside it. */
function posesIn(data, frame) {
  if (!data.joints) {
    const lists = [data.poses, data.beside].filter(Boolean);
    const all = lists.map(list => posesOfList(list, data.links.length, [frame, 0]));
    return all.filter(Boolean);
  }
  if (data.t.length === 0) return [posesOf(data, posture(data, frame))];
  const lists = [data.q, data.beside].filter(Boolean);
  return lists.map(list => posesOf(data, positionsAt(data, [frame, 0], list)));
}

/** Where the parts of a robot end. */
function ends(data, poses) {
  const bodies = data.links.flatMap((link, at) => {
    if (!link.is_body && !link.radius) return [];
    const [origin] = poses[at];
    const wide = link.radius ?? 0;
    // a body begins where what carries it is
    const begins = link.is_body && link.carrier >= 0 ? [poses[link.carrier][0].clone()] : [];
    return wide === 0 ? [origin, ...begins] : [-wide, wide].flatMap(away =>
      [0, 1, 2].map(axis => origin.clone().setComponent(axis, origin.getComponent(axis) + away)));
  });
  const points = [...data.tips, ...data.contacts].map(({ link, at }) => {
    const [origin, turn] = poses[link];
    return new Vector3(...at).applyQuaternion(turn).add(origin);
  });
  return [...bodies, ...points, ...endsOf(data, poses)];
}

/** The points that a motion passes, from what the camera looks at, which stays in their middle. */
export function passed(data) {
  const frames = data.t.length > 0 ? data.t.length : POSTURES;
  const follows = data.follows && !data.joints;
  const first = follows ? place(data.com, [0, 0]) : null;
  const points = follows ? [] : [new Vector3(...data.base)];
  const step = Math.max(1, Math.floor(frames / POSTURES));
  for (let frame = 0; frame < frames; frame += step) {
    // the camera goes along with the centre of mass
    const gone = follows ? place(data.com, [frame, 0])?.sub(first) : new Vector3();
    if (!gone) continue;
    for (const poses of posesIn(data, frame)) {
      points.push(...ends(data, poses).map(point => point.sub(gone)));
    }
  }
  const known = points.filter(point => point.toArray().every(Number.isFinite));
  if (known.length === 0) return [];
  const [low, high] = ["min", "max"].map(of =>
    known.reduce((end, point) => end[of](point), known[0].clone()));
  const middle = high.add(low).multiplyScalar(0.5);
  data.center = middle.toArray();
  return known.map(point => point.sub(middle));
}

/** How far a camera is that looks along a direction and sees so much about its target. */
export function distance(data, points, { away, up, tan, aspect }) {
  const right = up.clone().cross(away);
  if (right.lengthSq() < 1e-9) right.set(1, 0, 0);
  right.normalize();
  const above = away.clone().cross(right);
  const wide = Math.max(1, Math.min(aspect, WIDEST));
  const closest = data.follows && !data.joints ? CLOSEST.followed : CLOSEST.still;
  let far = (closest * data.size) / (2 * tan);
  for (const point of points) {
    const [x, y] = [right, above].map(axis => Math.abs(point.dot(axis)));
    far = Math.max(far, point.dot(away) + (ROOM * Math.max(y, x / wide)) / tan);
  }
  return far;
}
