// What links look like: triangles of a description, each shape in the frame of its link.
import { BufferGeometry, Float32BufferAttribute, Mesh, Quaternion, Vector3 } from "three";

function numbers(text, Kind) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  return new Kind(bytes.buffer);
}

function geometry({ low, high, corners, triangles, is_wide: isWide }) {
  const steps = numbers(corners, Uint16Array);
  const places = Float32Array.from(steps, (step, at) =>
    low[at % 3] + (high[at % 3] - low[at % 3]) * step / 65535);
  const made = new BufferGeometry();
  made.setAttribute("position", new Float32BufferAttribute(places, 3));
  made.setIndex([...numbers(triangles, isWide ? Uint32Array : Uint16Array)]);
  return made;
}

export class Shapes {
  constructor(data, material) {
    this.data = data;
    this.isShown = true;
    this.all = (data.shapes ?? []).map(shape => {
      const mesh = new Mesh(geometry(shape), material);
      if (shape.link >= 0) mesh.userData.link = shape.link;
      return mesh;
    });
  }

  /** Whether they stand in place of the rows of the table. */
  get isWhole() {
    return this.isShown && this.all.length > 0 && this.data.shapes_whole;
  }

  show(poses) {
    this.all.forEach((mesh, at) => {
      const { link } = this.data.shapes[at];
      const [origin, turn] = poses[link] ?? [new Vector3(...this.data.base), new Quaternion()];
      mesh.visible = this.isShown;
      mesh.position.copy(origin);
      mesh.quaternion.copy(turn);
    });
  }
}

/** The ends of all shapes for one posture. */
export function endsOf(data, poses) {
  return (data.shapes ?? []).flatMap(({ link, low, high }) => {
    const [origin, turn] = poses[link] ?? [new Vector3(...data.base), new Quaternion()];
    return Array.from({ length: 8 }, (_, at) => {
      const end = [0, 1, 2].map(axis => ((at >> axis) & 1 ? high : low)[axis]);
      return new Vector3(...end).applyQuaternion(turn).add(origin);
    });
  });
}
