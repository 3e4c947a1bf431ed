"""Rigid-body dynamics of a model file as CasADi expressions, numbers folded in.

The text is the one that is fast for generated code: Newton and Euler's equations in body frames,
composite inertias, an L^T D L factorisation that knows which branches couple. It shares nothing with
denavit but the model file, so that agreement of numbers means something.
"""
import json
import math

ZERO3 = [0.0, 0.0, 0.0]


def is_number(x):
    return isinstance(x, (int, float))


def mul(a, b):
    """a b, with zeros and ones folded."""
    if is_number(a) and is_number(b):
        return a * b
    if is_number(b):
        a, b = b, a
    if is_number(a):
        if a == 0:
            return 0.0
        if a == 1:
            return b
        if a == -1:
            return -b
    return a * b


def add(*terms):
    total = 0.0
    for term in terms:
        if is_number(term) and term == 0:
            continue
        total = term if is_number(total) and total == 0 else total + term
    return total


def sub(a, b):
    if is_number(b) and b == 0:
        return a
    return -b if is_number(a) and a == 0 else a - b


def plus(*vectors):
    return [add(*entries) for entries in zip(*vectors)]


def scaled(factor, vector):
    return [mul(factor, x) for x in vector]


def cross(a, b):
    return [sub(mul(a[(k + 1) % 3], b[(k + 2) % 3]), mul(a[(k + 2) % 3], b[(k + 1) % 3]))
            for k in range(3)]


def times(matrix, vector):
    return [add(*[mul(row[k], vector[k]) for k in range(3)]) for row in matrix]


def transposed(matrix):
    return [list(row) for row in zip(*matrix)]


def product(a, b):
    columns = [times(a, column) for column in transposed(b)]
    return transposed(columns)


class Joint:
    """A moving joint: where its axis frame stands in its parent's, and what it carries."""

    def __init__(self, name, parent, is_revolute, turn, shift):
        self.name, self.parent, self.is_revolute = name, parent, is_revolute
        self.turn, self.shift = turn, shift
        # m, the first moment and the inertia about the origin of the axis frame.
        self.matter = [0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)]]


class Body:
    """A body's own frame in the axis frame of the joint that carries it, and its ten parameters."""

    def __init__(self, link, joint, turn, shift, mass, moment, inertia):
        self.link, self.joint, self.turn, self.shift = link, joint, turn, shift
        self.mass, self.moment, self.inertia = mass, moment, inertia

    def in_axis_frame(self):
        return moved(self.turn, self.shift, self.mass, self.moment, self.inertia)


def moved(turn, shift, mass, moment, inertia):
    """Mass, first moment and inertia, seen from the frame in which theirs stands."""
    turned = times(turn, moment)
    central = product(product(turn, inertia), transposed(turn))
    dot = sum(s * (2 * t + mass * s) for s, t in zip(shift, turned))
    rows = [[central[i][j] + (dot if i == j else 0.0)
             - shift[i] * turned[j] - turned[i] * shift[j] - mass * shift[i] * shift[j]
             for j in range(3)] for i in range(3)]
    return mass, [t + mass * s for s, t in zip(shift, turned)], rows


class Model:
    """A model file of standard Denavit-Hartenberg rows."""

    def __init__(self, path):
        with open(path) as file:
            document = json.load(file)
        if document["convention"] != "standard":
            raise ValueError("only standard rows are read")
        names = {"pi": math.pi, "sqrt": math.sqrt}
        for name, constant in document.get("constants", {}).items():
            names[name] = self.number(constant["value"], names)
        self.names = names
        self.gravity = [self.value(g) for g in document["gravity"]]
        links = list(document["links"])
        if document.get("base", "fixed") != "fixed":
            links = virtual_chain(document["base"]) + links
        self.joints, self.bodies, last = [], [], None
        ends = {None: (-1, [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]], list(ZERO3))}
        for link in links:
            parent = link.get("parent", last)
            ends[link["name"]] = self.link(link, ends[parent])
            last = link["name"]
        for body in self.bodies:
            matter = self.joints[body.joint].matter
            mass, moment, inertia = body.in_axis_frame()
            matter[0] += mass
            matter[1] = [a + b for a, b in zip(matter[1], moment)]
            matter[2] = [[a + b for a, b in zip(*rows)] for rows in zip(matter[2], inertia)]
        for joint in self.joints:
            mass, moment, inertia = joint.matter
            joint.matter = [clean(mass), [clean(x) for x in moment],
                            [[clean(x) for x in row] for row in inertia]]

    def number(self, text, names):
        return float(text) if is_number(text) else float(eval(text.replace("^", "**"), {}, names))

    def value(self, text):
        return self.number(text, self.names)

    def link(self, link, end):
        """Adds a row; where the link's frame stands in the axis frame of its joint."""
        row = link["joint"]
        a, alpha, d, theta = (self.value(row.get(key, 0)) for key in ("a", "alpha", "d", "theta"))
        parent, turn, shift = end
        before = product(turn, about_z(theta)), \
            [s + t for s, t in zip(shift, times(turn, [0.0, 0.0, d]))]
        after = about_x(alpha), [a, 0.0, 0.0]
        if row["type"] == "fixed":
            place = product(before[0], after[0]), \
                [s + t for s, t in zip(before[1], times(before[0], after[1]))]
            joint = parent
        else:
            is_revolute = row["type"] == "revolute"
            turn = [[clean(x) for x in r] for r in before[0]]
            shift = [clean(x) for x in before[1]]
            self.joints.append(Joint(link["name"], parent, is_revolute, turn, shift))
            joint, place = len(self.joints) - 1, after
        if "body" in link:
            self.bodies.append(self.body(link, joint, place))
        return joint, *place

    def body(self, link, joint, place):
        body = link["body"]
        value = lambda entry: self.value(entry["value"] if isinstance(entry, dict) else entry)
        mass = value(body.get("mass", 0))
        com = [value(x) for x in body.get("com", ZERO3)]
        tensor = {key: value(x) for key, x in body.get("inertia", {}).items()}
        inertia = [[tensor.get("".join(sorted(i + j)), 0.0) for j in "xyz"] for i in "xyz"]
        if body.get("about", "com") == "com":
            square = sum(c * c for c in com)
            inertia = [[inertia[i][j] + mass * ((square if i == j else 0.0) - com[i] * com[j])
                        for j in range(3)] for i in range(3)]
        return Body(link["name"], joint, *place, mass, [mass * c for c in com], inertia)


def virtual_chain(base):
    kind = base if isinstance(base, str) else base["type"]
    if kind != "floating":
        raise ValueError("only fixed and floating bases are read")
    row = {"alpha": "pi/2", "theta": "pi/2"}
    chain = [{"name": f"base_{axis}", "joint": {"type": "prismatic", **row}} for axis in "zxy"]
    chain += [{"name": f"base_{turn}", "joint": {"type": "revolute", **row}}
              for turn in ("yaw", "roll", "pitch")]
    if not isinstance(base, str) and "body" in base:
        chain[-1]["body"] = base["body"]
    chain.append({"name": "base", "joint": {"type": "fixed"}})
    return chain


def clean(x):
    return 0.0 if abs(x) < 1e-13 else (round(x) if abs(x - round(x)) < 1e-14 else x) + 0.0


def about_z(angle):
    c, s = clean(math.cos(angle)), clean(math.sin(angle))
    return [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]


def about_x(angle):
    c, s = clean(math.cos(angle)), clean(math.sin(angle))
    return [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]


class Dynamics:
    """The functions, on any scalars: CasADi's symbols here."""

    def __init__(self, model, sin, cos):
        self.joints, self.gravity, self.sin, self.cos = model.joints, model.gravity, sin, cos
        self.matter = [joint.matter for joint in model.joints]
        self.n = len(self.joints)

    def place(self, q):
        self.turns = [(self.sin(q[i]), self.cos(q[i])) if joint.is_revolute else None
                      for i, joint in enumerate(self.joints)]
        self.offsets = [
            joint.shift if joint.is_revolute
            else plus(joint.shift, [mul(row[2], q[i]) for row in joint.turn])
            for i, joint in enumerate(self.joints)]

    def down(self, i, vector):
        """From the parent's frame to that of joint i."""
        x, y, z = times(transposed(self.joints[i].turn), vector)
        if self.turns[i] is None:
            return [x, y, z]
        s, c = self.turns[i]
        return [add(mul(c, x), mul(s, y)), sub(mul(c, y), mul(s, x)), z]

    def up(self, i, vector):
        """From the frame of joint i to its parent's."""
        if self.turns[i] is not None:
            s, c = self.turns[i]
            x, y, z = vector
            vector = [sub(mul(c, x), mul(s, y)), add(mul(s, x), mul(c, y)), z]
        return times(self.joints[i].turn, vector)

    def inverse_dynamics(self, q, v, a):
        self.place(q)
        moved = []
        base = (ZERO3, ZERO3, [-g for g in self.gravity], [ZERO3] * 3)
        for i, joint in enumerate(self.joints):
            w, wd, vd, spin = moved[joint.parent] if joint.parent >= 0 else base
            vd = self.down(i, plus(vd, times(spin, self.offsets[i])))
            w, wd = self.down(i, w), self.down(i, wd)
            if joint.is_revolute:
                wd = [add(wd[0], mul(w[1], v[i])), sub(wd[1], mul(w[0], v[i])), add(wd[2], a[i])]
                w = [w[0], w[1], add(w[2], v[i])]
            else:
                twice = mul(2.0, v[i])
                vd = [add(vd[0], mul(w[1], twice)), sub(vd[1], mul(w[0], twice)),
                      add(vd[2], a[i])]
            moved.append((w, wd, vd, spin_matrix(w, wd)))
        forces, moments = [], []
        for (w, wd, vd, spin), (mass, moment, inertia) in zip(moved, self.matter):
            forces.append(plus(scaled(mass, vd), times(spin, moment)))
            moments.append(plus(times(inertia, wd), cross(w, times(inertia, w)),
                                cross(moment, vd)))
        torques = [0.0] * self.n
        for i in reversed(range(self.n)):
            joint = self.joints[i]
            torques[i] = moments[i][2] if joint.is_revolute else forces[i][2]
            if joint.parent >= 0:
                force = self.up(i, forces[i])
                forces[joint.parent] = plus(forces[joint.parent], force)
                moments[joint.parent] = plus(moments[joint.parent], self.up(i, moments[i]),
                                             cross(self.offsets[i], force))
        return torques

    def gravity_vector(self, q):
        return self.inverse_dynamics(q, [0.0] * self.n, [0.0] * self.n)

    def mass_matrix(self, q):
        self.place(q)
        entries = [[0.0] * self.n for _ in range(self.n)]
        composite = [[m, list(h), [list(r) for r in inertia]] for m, h, inertia in self.matter]
        for i in reversed(range(self.n)):
            joint = self.joints[i]
            mass, moment, inertia = composite[i]
            if joint.is_revolute:
                force, torque = [sub(0.0, moment[1]), moment[0], 0.0], \
                    [inertia[0][2], inertia[1][2], inertia[2][2]]
            else:
                force, torque = [0.0, 0.0, mass], [moment[1], sub(0.0, moment[0]), 0.0]
            entries[i][i] = inertia[2][2] if joint.is_revolute else mass
            k = i
            while self.joints[k].parent >= 0:
                shifted = self.up(k, force)
                torque = plus(self.up(k, torque), cross(self.offsets[k], shifted))
                force, k = shifted, self.joints[k].parent
                entry = torque[2] if self.joints[k].is_revolute else force[2]
                entries[k][i] = entries[i][k] = entry
            if joint.parent >= 0:
                composite[joint.parent] = self.carried(i, composite[i], composite[joint.parent])
        return entries

    def centroidal_momentum_matrix(self, q):
        """Momentum of what each joint carries at a unit velocity: linear, then about the centre of mass."""
        self.place(q)
        composite = [[m, list(h), [list(r) for r in inertia]] for m, h, inertia in self.matter]
        for i in reversed(range(self.n)):
            parent = self.joints[i].parent
            if parent >= 0:
                composite[parent] = self.carried(i, composite[i], composite[parent])
        whole = [0.0, list(ZERO3), [list(ZERO3) for _ in range(3)]]
        # Axes of the joints' frames and their origins, in the world.
        axes, origins = [], []
        for i, joint in enumerate(self.joints):
            before = axes[joint.parent] if joint.parent >= 0 else \
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            turned = product(before, joint.turn)
            if self.turns[i] is not None:
                s, c = self.turns[i]
                turned = [[add(mul(c, x), mul(s, y)), sub(mul(c, y), mul(s, x)), z]
                          for x, y, z in turned]
            shift = times(before, self.offsets[i])
            axes.append(turned)
            origins.append(plus(origins[joint.parent], shift) if joint.parent >= 0 else shift)
            if joint.parent < 0:
                whole = self.carried(i, composite[i], whole)
        center = [x / whole[0] for x in whole[1]]
        columns = []
        for joint, (mass, moment, inertia), turn, origin in zip(self.joints, composite, axes, origins):
            if joint.is_revolute:
                force = [sub(0.0, moment[1]), moment[0], 0.0]
                torque = [inertia[0][2], inertia[1][2], inertia[2][2]]
            else:
                force, torque = [0.0, 0.0, mass], [moment[1], sub(0.0, moment[0]), 0.0]
            force = times(turn, force)
            lever = [sub(o, c) for o, c in zip(origin, center)]
            columns.append([*force, *plus(times(turn, torque), cross(lever, force))])
        return [list(row) for row in zip(*columns)]

    def carried(self, i, part, whole):
        """The composite `whole` with `part`, which stands on joint i."""
        mass, moment, inertia = part
        xx, xy, xz = inertia[0]
        yy, yz, zz = inertia[1][1], inertia[1][2], inertia[2][2]
        if self.turns[i] is not None:
            s, c = self.turns[i]
            square, mixed, difference = mul(s, s), mul(s, c), sub(yy, xx)
            change = sub(mul(square, difference), mul(2.0, mul(mixed, xy)))
            xy = sub(mul(sub(1.0, mul(2.0, square)), xy), mul(mixed, difference))
            xx, yy = add(xx, change), sub(yy, change)
            xz, yz = sub(mul(c, xz), mul(s, yz)), add(mul(s, xz), mul(c, yz))
        turn = self.joints[i].turn
        inertia = product(product(turn, [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
                          transposed(turn))
        moment, o = self.up(i, moment), self.offsets[i]
        g = [add(moment[k], mul(0.5, mul(mass, o[k]))) for k in range(3)]
        d = [mul(o[k], g[k]) for k in range(3)]
        rows = [[None] * 3 for _ in range(3)]
        for r in range(3):
            for k in range(r, 3):
                if r == k:
                    extra = mul(2.0, add(d[(r + 1) % 3], d[(r + 2) % 3]))
                    rows[r][r] = add(inertia[r][r], extra)
                else:
                    extra = add(mul(o[r], g[k]), mul(o[k], g[r]))
                    rows[r][k] = rows[k][r] = sub(inertia[r][k], extra)
        shifted = [add(moment[k], mul(mass, o[k])) for k in range(3)]
        return [add(whole[0], mass), plus(whole[1], shifted),
                [plus(a, b) for a, b in zip(whole[2], rows)]]

    def forward_dynamics(self, q, v, torque):
        parent = [joint.parent for joint in self.joints]
        lower = self.mass_matrix(q)
        bias = self.inverse_dynamics(q, v, [0.0] * self.n)
        x = [sub(t, b) for t, b in zip(torque, bias)]
        inverse = [None] * self.n
        for k in reversed(range(self.n)):
            inverse[k] = 1.0 / lower[k][k]
            i = parent[k]
            while i >= 0:
                factor, j = mul(lower[k][i], inverse[k]), i
                while j >= 0:
                    lower[i][j] = sub(lower[i][j], mul(factor, lower[k][j]))
                    j = parent[j]
                lower[k][i], i = factor, parent[i]
        for k in reversed(range(self.n)):
            i = parent[k]
            while i >= 0:
                x[i], i = sub(x[i], mul(lower[k][i], x[k])), parent[i]
        x = [mul(x[k], inverse[k]) for k in range(self.n)]
        for k in range(self.n):
            i = parent[k]
            while i >= 0:
                x[k], i = sub(x[k], mul(lower[k][i], x[i])), parent[i]
        return x

    def regressor(self, q, v, a, bodies):
        """Columns of m, the first moment and the inertia of each body, in its joint's frame."""
        kept, columns = self.matter, []
        for body in bodies:
            for unit in range(10):
                self.matter = [[0.0, ZERO3, [ZERO3] * 3] for _ in range(self.n)]
                self.matter[body.joint] = unit_matter(unit)
                columns.append(self.inverse_dynamics(q, v, a))
        self.matter = kept
        return transposed(columns)


# The order of columns: m, mx, my, mz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz.
INERTIA_PLACES = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]


def unit_matter(unit):
    moment, inertia = [0.0] * 3, [[0.0] * 3 for _ in range(3)]
    if 1 <= unit <= 3:
        moment[unit - 1] = 1.0
    if unit >= 4:
        i, j = INERTIA_PLACES[unit - 4]
        inertia[i][j] = inertia[j][i] = 1.0
    return [1.0 if unit == 0 else 0.0, moment, inertia]


def axis_frame_columns(body):
    """What a unit of each parameter in the body's own frame is in the axis frame: 10 columns."""
    columns = []
    for unit in range(10):
        mass, moment, inertia = moved(body.turn, body.shift, *unit_matter(unit))
        columns.append([mass, *moment, *(inertia[i][j] for i, j in INERTIA_PLACES)])
    return columns


def spin_matrix(w, wd):
    """wd x (.) + w x (w x (.))."""
    xx, yy, zz = (mul(x, x) for x in w)
    xy, xz, yz = mul(w[0], w[1]), mul(w[0], w[2]), mul(w[1], w[2])
    return [[sub(0.0, add(yy, zz)), sub(xy, wd[2]), add(xz, wd[1])],
            [add(xy, wd[2]), sub(0.0, add(xx, zz)), sub(yz, wd[0])],
            [sub(xz, wd[1]), add(yz, wd[0]), sub(0.0, add(xx, yy))]]
