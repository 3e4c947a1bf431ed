// Camera, lights, ground: what a robot stands in.
import {
  AmbientLight, DirectionalLight, GridHelper, Group, PerspectiveCamera, Quaternion, Scene, Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { distance, passed } from "./room.js";

/** From where a run is looked at: ahead, to its side, above. */
const EYE = [0.55, -1, 0.35];
/** How much is seen from top to bottom [deg]. */
const ANGLE = 35;

/** A direction given with z upwards, turned to where `up` is. */
function raised(direction, up) {
  const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), up);
  return new Vector3(...direction).normalize().applyQuaternion(turn);
}

export class Stage {
  constructor(canvas, data) {
    // kept, so that paper and screenshots have it
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true,
      alpha: true });
    this.canvas = canvas;
    this.scene = new Scene();
    const up = new Vector3(...data.up);
    this.camera = new PerspectiveCamera(ANGLE, 1);
    this.camera.up.copy(up);
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.copy(raised([0.5, -0.8, 1.4], up));
    this.scene.add(new AmbientLight(0xffffff, 1.3), sun);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.target = new Vector3();
    this.away = data.look
      ? new Vector3(...data.look).addScaledVector(up, 0.25).normalize()
      : raised(data.eye ?? EYE, up);
    const tan = Math.tan((ANGLE * Math.PI) / 360);
    const aspect = canvas.clientWidth / canvas.clientHeight || 1;
    const far = distance(data, passed(data), { away: this.away, up, tan, aspect });
    this.away.multiplyScalar(far);
    // a motion may pass much more than the robot is large
    this.camera.far = Math.max(200 * data.size, 20 * far);
    this.camera.near = Math.max(Math.min(0.01 * data.size, 0.005 * far), 5e-6 * this.camera.far);
    // what is drawn is as thick as the picture is large
    data.view = 2 * far * tan;
    this.ground = this.makeGround(data);
    this.home();
  }

  makeGround(data) {
    const group = new Group();
    this.scene.add(group);
    if (!data.ground) return group;
    const [point, normal] = data.ground.map(triple => new Vector3(...triple));
    const step = data.grid_m;
    const count = 2 * Math.ceil((1.2 * data.reach + data.size) / step);
    const grid = new GridHelper(count * step, count);
    grid.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), normal);
    const middle = new Vector3(...data.center);
    middle.addScaledVector(normal, point.clone().sub(middle).dot(normal));
    grid.position.copy(middle);
    group.add(grid);
    return group;
  }

  home() {
    this.controls.target.copy(this.target);
    this.camera.position.copy(this.target).add(this.away);
    this.controls.update();
  }

  /** The camera goes along with the robot. */
  follow(point) {
    const step = point.clone().sub(this.target);
    this.target.copy(point);
    this.camera.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
  }

  paint(colour) {
    this.ground.traverse(part => {
      if (!part.material) return;
      part.material.vertexColors = false;
      part.material.needsUpdate = true;
      part.material.color.set(colour("floor"));
    });
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // a narrow stage shows as much sideways
    this.camera.zoom = Math.min(1, this.camera.aspect);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
    this.onDraw?.();
  }
}
