"""A model against MuJoCo's reading of the same MJCF."""

import mujoco
import numpy as np

from compare_urdf import NotComparable, relative, row_name, turned, with_terms

STATES = 20


def base(robot):
    return robot[:robot.index("site-packages") + len("site-packages")]


def full_names(read):
    """Names of bodies and joints, with those that the importer gives to what has none."""
    bodies, joints, unnamed = {}, {}, 0
    for body in range(1, read.nbody):
        name = read.body(body).name
        if not name:
            unnamed += 1
            name = f"body{unnamed}"
        bodies[body] = name
        first, count = read.body_jntadr[body], read.body_jntnum[body]
        for place in range(count):
            joint = first + place
            plain = read.joint(joint).name
            joints[joint] = plain or f"{name}_joint{place + 1 if count > 1 else ''}"
    return bodies, joints


class Mapping:
    """States of the model as states of MuJoCo."""

    def __init__(self, read, joints, names):
        self.read, self.names, self.parts = read, names, []
        at = {name: place for place, name in enumerate(names)}
        for joint, name in joints.items():
            kind, plain = read.jnt_type[joint], row_name(name)
            turns = [f"{plain}_{end}" for end in ("yaw", "pitch", "roll")]
            if kind == mujoco.mjtJoint.mjJNT_FREE:
                rows = [f"{plain}_{end}" for end in ("x", "y", "z")] + turns
                axes = (2, 1, 0)
                if rows[0] not in at:
                    rows = ["base_x", "base_y", "base_z", "base_yaw", "base_roll", "base_pitch"]
                    axes = (2, 0, 1)
            elif kind == mujoco.mjtJoint.mjJNT_BALL:
                rows, axes = turns, (2, 1, 0)
            else:
                rows, axes = [plain], None
            if any(row not in at for row in rows):
                raise NotComparable(f"no row for joint {name}")
            self.parts.append((joint, [at[row] for row in rows], axes))

    def state(self, q, qd, qdd):
        read = self.read
        position, rate, acceleration = read.qpos0.copy(), np.zeros(read.nv), np.zeros(read.nv)
        by_rate = np.zeros((read.nv, len(self.names)))
        for joint, rows, axes in self.parts:
            p, v = read.jnt_qposadr[joint], read.jnt_dofadr[joint]
            if axes is None:
                position[p], rate[v], acceleration[v] = q[rows[0]], qd[rows[0]], qdd[rows[0]]
                by_rate[v, rows[0]] = 1
                continue
            if len(rows) == 6:
                slides, rows = rows[:3], rows[3:]
                position[p:p + 3] = q[slides]
                rate[v:v + 3], acceleration[v:v + 3] = qd[slides], qdd[slides]
                by_rate[[v, v + 1, v + 2], slides] = 1
                p, v = p + 3, v + 3
            turn, omega, alpha = turned(axes, q[rows], qd[rows], qdd[rows])
            quaternion = np.zeros(4)
            mujoco.mju_mat2Quat(quaternion, turn.flatten())
            position[p:p + 4] = quaternion
            rate[v:v + 3], acceleration[v:v + 3] = omega, alpha
            for place, row in enumerate(rows):
                unit = np.eye(3)[place]
                by_rate[v:v + 3, row] = turned(axes, q[rows], unit, unit)[1]
        return position, rate, acceleration, by_rate


def differences(robot, model, folder, options):
    try:
        read = mujoco.MjModel.from_xml_path(robot)
    except Exception as error:
        raise NotComparable(f"MuJoCo: {str(error).splitlines()[0]}")
    read.opt.density = read.opt.viscosity = 0
    data = mujoco.MjData(read)
    bodies, joints = full_names(read)
    names = model.names()
    mapping = Mapping(read, joints, names)
    rows = {row["name"] for row in model.text["links"]}
    rng = np.random.default_rng(7)
    n = len(names)
    states = [{key: list(rng.uniform(-1, 1, n)) for key in ("q", "qd", "qdd")} for _ in range(STATES)]
    whole = model.evaluate(states, ["inverse_dynamics"])
    with_terms(model.path, ["inertia", "coriolis", "gravity", "rotor"])
    functions = ["inverse_dynamics", "mass_matrix", "gravity_vector", "link_jacobian"]
    answer = model.evaluate(states, functions)
    worst = dict.fromkeys(("tau", "all", "D", "G", "J"), 0.0)
    note = lambda key, value: worst.__setitem__(key, max(worst[key], value))
    for state, found, with_all in zip(states, answer["states"], whole["states"]):
        q, qd, qdd = (np.array(state[key]) for key in ("q", "qd", "qdd"))
        position, rate, acceleration, by_rate = mapping.state(q, qd, qdd)
        data.qpos[:], data.qvel[:] = position, 0
        mujoco.mj_forward(read, data)
        gravity = by_rate.T @ data.qfrc_bias
        data.qvel[:] = rate
        mujoco.mj_forward(read, data)
        mass = np.zeros((read.nv, read.nv))
        mujoco.mj_fullM(read, data, mass)
        force = mass @ acceleration + data.qfrc_bias
        tau = by_rate.T @ force
        note("tau", relative(np.array(found["inverse_dynamics"]["tau"]), tau))
        everything = force - data.qfrc_passive + read.dof_frictionloss * np.sign(rate)
        note("all", relative(np.array(with_all["inverse_dynamics"]["tau"]), by_rate.T @ everything))
        note("D", relative(np.array(found["mass_matrix"]["mass_matrix"]), by_rate.T @ mass @ by_rate))
        scale = max(np.max(np.abs(gravity)), 1e-9 * np.max(np.abs(tau)), 1e-300)
        note("G", float(np.max(np.abs(np.array(found["gravity_vector"]["gravity_vector"]) - gravity)) / scale))
        for body, name in bodies.items():
            row = frame_row(read, body, name, joints, rows)
            if row is None:
                continue
            place, turn = np.zeros((3, read.nv)), np.zeros((3, read.nv))
            mujoco.mj_jacBody(read, data, place, turn, body)
            wanted = np.vstack([place, turn]) @ by_rate
            note("J", relative(np.array(found[f"link_jacobian_{row}"]["link_jacobian"]), wanted))
    return worst, n


def frame_row(read, body, name, joints, rows):
    """The row of a body's frame: that of its name, or that of its only joint."""
    plain, count = row_name(name), read.body_jntnum[body]
    own = {row_name(joint) for joint in joints.values()}
    if plain in own or plain == "base":
        plain = f"{plain}_link"
    if plain in rows:
        return plain
    if count and read.jnt_type[read.body_jntadr[body]] > 1:
        last = row_name(joints[read.body_jntadr[body] + count - 1])
        return last if last in rows else None
    return None
