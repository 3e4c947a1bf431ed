// What holds between two frames of a run: places in between on straight lines, turns on arcs.
import { Quaternion, Vector3 } from "three";

/** The frame before a time, and the share of the way to the next. */
export function between(times, time) {
  let [low, high] = [0, times.length - 1];
  if (high <= 0 || time <= times[0]) return [0, 0];
  if (time >= times[high]) return [high, 0];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return [low, (time - times[low]) / (times[high] - times[low] || 1)];
}

/** A place of a list of triples per frame; none where one of its ends is missing. */
export function place(list, [frame, share], stride = 1, offset = 0) {
  const at = which => {
    const from = 3 * (which * stride + offset);
    const triple = list.slice(from, from + 3);
    return triple.length < 3 || triple.includes(null) ? null : new Vector3(...triple);
  };
  const first = at(frame);
  const second = share > 0 ? at(frame + 1) : first;
  return first && second ? first.lerp(second, share) : null;
}

/**
 * Places and turns of all links, of a list of seven numbers per frame and link; none where one of
 * the frames has none.
 */
export function posesOfList(list, count, [frame, share]) {
  const isKnown = which => (list[7 * which * count] ?? null) !== null;
  if (!isKnown(frame) || (share > 0 && !isKnown(frame + 1))) return null;
  return Array.from({ length: count }, (_, link) => pose(list, count, [frame, share], link));
}

function pose(list, count, [frame, share], link) {
  const at = which => {
    const from = 7 * (which * count + link);
    const [x, y, z, a, b, c, d] = list.slice(from, from + 7);
    return [new Vector3(x, y, z), new Quaternion(a, b, c, d)];
  };
  const [origin, turn] = at(frame);
  if (share > 0) {
    const [nextOrigin, nextTurn] = at(frame + 1);
    origin.lerp(nextOrigin, share);
    turn.slerp(nextTurn, share);
  }
  return [origin, turn];
}
