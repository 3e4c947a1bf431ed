"""A model against Pinocchio's reading of the same URDF."""

import json
import os
import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pinocchio as pin

STATES = 20
QUARTER = np.pi / 2


class NotComparable(Exception):
    pass


def base(robot):
    return robot[:robot.index("robots") + len("robots")] if "robots" in robot else os.path.dirname(robot)


def meant(text):
    """The angle that the importer reads: quarter turns where a decimal is one, rounded."""
    value = float(text)
    turns = round(value / QUARTER)
    off = abs(value - turns * QUARTER)
    if abs(turns) > 8 or value == 0:
        return value
    mantissa, _, exponent = text.lower().lstrip("+-").partition("e")
    places = len(mantissa.partition(".")[2]) - int(exponent or 0)
    digit = 10.0 ** -places
    cut = abs(value) < abs(turns) * QUARTER and off < digit
    if off <= 2e-7 or (turns and places >= 2 and (off <= digit / 2 or cut)):
        return turns * QUARTER
    return value


def near_planes(axis):
    """An axis within rounding of a coordinate axis or plane lies there."""
    x, y, z = axis
    across = np.hypot(x, y)
    if across <= 2e-7 * abs(z):
        return [0.0, 0.0, z]
    if abs(z) <= 2e-7 * across:
        z = 0.0
    if abs(y) <= 2e-7 * abs(x):
        y = 0.0
    if abs(x) <= 2e-7 * abs(y):
        x = 0.0
    return [x, y, z]


def aligned(robot, folder):
    """The same URDF, its rounded quarter turns as Pinocchio has to read them to be compared."""
    tree = ElementTree.parse(robot)
    for element in tree.iter():
        if "rpy" in element.attrib:
            element.set("rpy", " ".join(repr(meant(text)) for text in element.get("rpy").split()))
        if element.tag == "axis" and "xyz" in element.attrib:
            axis = near_planes([float(text) for text in element.get("xyz").split()])
            element.set("xyz", " ".join(repr(x) for x in axis))
    for element in list(tree.getroot()):
        if element.tag in ("gazebo", "transmission") or not isinstance(element.tag, str):
            tree.getroot().remove(element)
    path = os.path.join(folder, "aligned.urdf")
    tree.write(path)
    return path


def row_name(name):
    plain = re.sub(r"[^A-Za-z0-9]", "_", name)
    return plain if plain[:1].isalpha() else "n" + plain


def chain(joint, name):
    """The model's joints for one of Pinocchio, with what makes q and v of it."""
    kind = joint.shortname()
    if "FreeFlyer" in kind and name == "root_joint":
        return "base"
    if "FreeFlyer" in kind:
        return "free"
    if "Planar" in kind:
        return "planar"
    return "one"


def rotation(axis, angle):
    return pin.AngleAxis(angle, np.eye(3)[axis]).matrix()


def turned(axes, angles, rates, accelerations):
    """A turn of turns about x (0), y, z, with its angular velocity and acceleration in its own axes."""
    matrix, omega, alpha = np.eye(3), np.zeros(3), np.zeros(3)
    for axis, angle, rate, acceleration in zip(axes, angles, rates, accelerations):
        step, unit = rotation(axis, angle), np.eye(3)[axis]
        moved = step.T @ omega
        alpha = step.T @ alpha + unit * acceleration + np.cross(moved, unit * rate)
        omega = moved + unit * rate
        matrix = matrix @ step
    return matrix, omega, alpha


class Mapping:
    """States of the model as states of Pinocchio."""

    def __init__(self, model, names):
        self.model, self.names = model, names
        at = {name: place for place, name in enumerate(names)}
        self.parts = []
        for joint, name in zip(list(model.joints)[1:], list(model.names)[1:]):
            kind = chain(joint, name)
            plain = row_name(name)
            if kind == "base":
                rows = [at[k] for k in ("base_x", "base_y", "base_z", "base_yaw", "base_roll",
                                        "base_pitch")]
                self.parts.append((joint, "free", rows, (2, 0, 1)))
            elif kind == "free":
                ends = ("x", "y", "z", "yaw", "pitch", "roll")
                self.parts.append((joint, "free", [at[f"{plain}_{k}"] for k in ends], (2, 1, 0)))
            elif kind == "planar":
                raise NotComparable("planar joint")
            elif plain in at:
                self.parts.append((joint, kind, [at[plain]], None))
            else:
                raise NotComparable(f"no row for joint {name}")

    def state(self, q, qd, qdd):
        model = self.model
        position, rate, acceleration = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        by_rate = np.zeros((model.nv, len(self.names)))
        for joint, kind, rows, axes in self.parts:
            p, v = slice(joint.idx_q, joint.idx_q + joint.nq), slice(joint.idx_v, joint.idx_v + joint.nv)
            if kind == "free":
                turn, omega, alpha = turned(axes, q[rows[3:]], qd[rows[3:]], qdd[rows[3:]])
                quaternion = pin.Quaternion(turn).coeffs()
                position[p] = np.concatenate([q[rows[:3]], quaternion])
                linear = turn.T @ qd[rows[:3]]
                rate[v] = np.concatenate([linear, omega])
                spatial = turn.T @ qdd[rows[:3]] - np.cross(omega, linear)
                acceleration[v] = np.concatenate([spatial, alpha])
                first = joint.idx_v
                by_rate[first:first + 3, rows[:3]] = turn.T
                for place, row in enumerate(rows[3:]):
                    unit = np.eye(3)[place]
                    by_rate[first + 3:first + 6, row] = turned(axes, q[rows[3:]], unit, unit)[1]
            else:
                row = rows[0]
                turns = joint.nq == 2
                position[p] = [np.cos(q[row]), np.sin(q[row])] if turns else q[row]
                rate[v], acceleration[v] = qd[row], qdd[row]
                by_rate[joint.idx_v, row] = 1
        return position, rate, acceleration, by_rate


def relative(found, wanted):
    scale = max(np.max(np.abs(wanted), initial=0), 1e-300)
    return float(np.max(np.abs(found - wanted), initial=0) / scale) if wanted.size else 0.0


def frame_rows(robot, text):
    """The row of each link's frame: that of its name, or that of the joint that carries it."""
    rows = {row["name"]: row["joint"]["type"] for row in text["links"]}
    joints, links = {}, []
    for element in ElementTree.parse(robot).getroot():
        if element.tag == "joint" and element.find("child") is not None:
            joints[element.find("child").get("link")] = element
        if element.tag == "link":
            links.append(element.get("name"))
    moving = {row_name(joint.get("name")) for joint in joints.values() if joint.get("type") != "fixed"}
    found = {}
    for link in links:
        name = row_name(link)
        if name in moving:
            name = f"{name}_link"
        if name == "base":
            name = "base_link"
        joint = joints.get(link)
        if name in rows:
            found[link] = name
        elif joint is not None and joint.get("type") not in ("fixed", "floating", "planar"):
            found[link] = row_name(joint.get("name"))
    return found


def with_terms(path, terms):
    """The model with these terms alone: friction and springs are no part of the functions compared."""
    text = open(path).read()
    convention = '"convention": "modified",'
    open(path, "w").write(text.replace(convention, f'{convention} "terms": {json.dumps(terms)},'))


def round_trip(robot, model, folder, floats):
    """Inverse dynamics by Pinocchio of the URDF that the model is written to (to 1e-12: times 1e3)."""
    path = os.path.join(folder, "back.urdf")
    model.run("export", model.path, "-o", path)
    # what has not changed leaves the user's own file as it is
    model.run("export", model.path, "--into", robot, "-o", os.path.join(folder, "same.urdf"))
    same = open(os.path.join(folder, "same.urdf"), "rb").read()
    if same != open(robot, "rb").read():
        raise RuntimeError("values that have not changed were written")
    read = pin.buildModelFromUrdf(path, pin.JointModelFreeFlyer()) if floats else pin.buildModelFromUrdf(path)
    data, mapping = read.createData(), Mapping(read, model.names())

    def torques(q, qd, qdd):
        position, rate, acceleration, by_rate = mapping.state(q, qd, qdd)
        return by_rate.T @ pin.rnea(read, data, position, rate, acceleration)

    return torques


def differences(robot, model, folder, options):
    floats = "floating" in options
    path = aligned(robot, folder)
    try:
        root = pin.JointModelFreeFlyer() if floats else None
        read = pin.buildModelFromUrdf(path, root) if floats else pin.buildModelFromUrdf(path)
    except Exception as error:
        raise NotComparable(f"Pinocchio: {str(error).splitlines()[0]}")
    data = read.createData()
    with_terms(model.path, ["inertia", "coriolis", "gravity"])
    names = model.names()
    mapping = Mapping(read, names)
    rng = np.random.default_rng(7)
    n = len(names)
    states = [{key: list(rng.uniform(-1, 1, n)) for key in ("q", "qd", "qdd")} for _ in range(STATES)]
    if n == 0:
        raise NotComparable("nothing moves")
    again = round_trip(robot, model, folder, floats)
    frames = frame_rows(robot, model.text)
    functions = ["inverse_dynamics", "mass_matrix", "gravity_vector", "link_jacobian"]
    answer = model.evaluate(states, functions)
    worst = {"tau": 0.0, "D": 0.0, "G": 0.0, "J": 0.0, "back": 0.0}
    for state, found in zip(states, answer["states"]):
        q, qd, qdd = (np.array(state[key]) for key in ("q", "qd", "qdd"))
        position, rate, acceleration, by_rate = mapping.state(q, qd, qdd)
        tau = by_rate.T @ pin.rnea(read, data, position, rate, acceleration)
        note = lambda key, value: worst.__setitem__(key, max(worst[key], value))
        note("tau", relative(np.array(found["inverse_dynamics"]["tau"]), tau))
        note("back", 1e3 * relative(again(q, qd, qdd), tau))
        mass = pin.crba(read, data, position)
        mass = np.triu(mass) + np.triu(mass, 1).T
        note("D", relative(np.array(found["mass_matrix"]["mass_matrix"]), by_rate.T @ mass @ by_rate))
        gravity = by_rate.T @ pin.computeGeneralizedGravity(read, data, position)
        mass_scale = max(np.max(np.abs(tau)), 1e-300)
        off = np.max(np.abs(np.array(found["gravity_vector"]["gravity_vector"]) - gravity), initial=0)
        note("G", float(off / max(np.max(np.abs(gravity), initial=0), 1e-9 * mass_scale, 1e-300)))
        pin.forwardKinematics(read, data, position)
        pin.computeJointJacobians(read, data, position)
        pin.updateFramePlacements(read, data)
        for link, row in frames.items():
            frame = read.getFrameId(link, pin.FrameType.BODY)
            wanted = pin.getFrameJacobian(read, data, frame, pin.LOCAL_WORLD_ALIGNED) @ by_rate
            note("J", relative(np.array(found[f"link_jacobian_{row}"]["link_jacobian"]), wanted))
    return worst, n
