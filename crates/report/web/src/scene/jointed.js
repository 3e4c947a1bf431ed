// A robot whose joints are moved here: the rows of its table as transforms at zero, with turns
// about, or ways along, the z axes of the joints.
import { Quaternion, Vector3 } from "three";

const Z = new Vector3(0, 0, 1);

/** Places and turns of all links for positions of the joints. */
export function posesOf(data, q) {
  const poses = [];
  for (const link of data.links) {
    const [origin, turn] = link.carrier < 0
      ? [new Vector3(...data.base), new Quaternion()]
      : poses[link.carrier].map(part => part.clone());
    const [x, y, z, ...zero] = link.zero;
    const value = link.joint < 0 ? 0 : q[link.joint];
    const move = () => {
      if (link.joint < 0) return;
      if (link.slides) origin.addScaledVector(Z.clone().applyQuaternion(turn), value);
      else turn.multiply(new Quaternion().setFromAxisAngle(Z, value));
    };
    // a standard row turns before it is gone along, a modified one after
    if (!data.is_modified) move();
    origin.add(new Vector3(x, y, z).applyQuaternion(turn));
    turn.multiply(new Quaternion(...zero));
    if (data.is_modified) move();
    poses.push([origin, turn]);
  }
  return poses;
}

/** Positions of the joints at a time between frames. */
export function positionsAt(data, [frame, share], q = data.q) {
  const count = data.joints.length;
  return data.joints.map((_, joint) => {
    const first = q[frame * count + joint];
    return share > 0 ? first + share * (q[(frame + 1) * count + joint] - first) : first;
  });
}

export function startOf(data) {
  return data.joints.map(joint => joint.start);
}

/** The centre of mass; none of a robot without masses. */
export function centerOf(data, poses) {
  const sum = new Vector3();
  let mass = 0;
  data.links.forEach((link, place) => {
    const [origin, turn] = poses[place];
    const com = new Vector3(...link.com).applyQuaternion(turn).add(origin);
    sum.addScaledVector(com, link.mass);
    mass += link.mass;
  });
  return mass > 0 ? sum.divideScalar(mass) : null;
}
