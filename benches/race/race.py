#!/usr/bin/env python3
"""The race: emitted Rust against C that CasADi generates, in one process.

    python3 -m venv .venv && .venv/bin/pip install casadi numpy mpmath
    .venv/bin/python benches/race/race.py [--models puma560,tulip] [--functions mass_matrix] [-o FILE]
    .venv/bin/pip install pin && .venv/bin/python benches/race/race.py --pinocchio

Both sides get the same model files (shipped ones without their drives and springs: rigid bodies),
with all values folded in, and the same inputs. Each of CasADi's functions is compiled by gcc and by
clang, -O3 -march=native; ours by rustc for the native processor. Results are compared before anything
is timed: with each other and, on four inputs, with 60 digits. A round times every variant once, in
turns: calls one after the other, and calls in a chain, each of which waits for the result of the
last one. Tables have medians over rounds of the nanoseconds of a call, and of ratios within a round, of
which CasADi's better compiler counts. With `--pinocchio` its algorithms run beside; they are compiled by clang,
which takes minutes. It runs on x86-64 alone, as it calls our functions by the way in
which C returns arrays there.
"""
import argparse
import ctypes
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

import casadi
import mpmath
import numpy

import rigid_body

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MODELS = ["puma560", "tulip_leg6", "iiwa", "tulip"]
C_FLAGS = ["-O3", "-march=native", "-shared", "-fPIC"]
# Name, arguments, outputs as fields of our result, and CasADi's expression.
ARGUMENTS = {
    "inverse_dynamics": ["q", "qd", "qdd"],
    "mass_matrix": ["q"],
    "forward_dynamics": ["q", "qd", "tau"],
    "dynamics_terms": ["q", "qd"],
    "gravity_vector": ["q"],
    "centroidal_momentum_matrix": ["q"],
    "regressor": ["q", "qd", "qdd"],
    "inverse_dynamics_derivatives": ["q", "qd", "qdd"],
    "base_regressor": ["q", "qd", "qdd"],
}
# Ours alone, for many samples: CasADi has no base parameters.
ALONE = "base_regressor"
FIELDS = {
    "dynamics_terms": ["mass_matrix", "coriolis_matrix", "gravity_vector"],
    "inverse_dynamics_derivatives": ["dtau_dq", "dtau_dqd"],
}
# Ours: how a module is emitted.
FLAVOURS = {"baked": ["--baked", "--fused"], "tunable": ["--fused"],
            "sparse": ["--sparse", "--fused"], "plain": ["--baked"]}
# A parameter that is always 0 has no column.
ALL_COLUMNS = ["regressor", ALONE]
# Ours on many samples: how many at a time, and whether results are stored or used and forgotten.
BATCHES = {"x4": (4, False), "x8": (8, False), "stored": (4, True), "stored8": (8, True)}
CASADI, OURS, OUR_BATCH = range(3)
# Boost's variants of this many joints, as Pinocchio wants them.
PINOCCHIO_FLAGS = ["-std=c++17", "-DNDEBUG", "-w", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
                   "-DBOOST_FUSION_INVOKE_MAX_ARITY=12", "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
                   "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30"]
INPUTS, ROUNDS = 64, 21


def run(command, **options):
    return subprocess.run(command, check=True, text=True, **options)


def rigid_model(name, folder):
    """A shipped model without drives, springs and dampers: what both sides read."""
    document = json.loads((ROOT / "models" / f"{name}.json").read_text())
    document.pop("drives", None)
    for link in document["links"]:
        for key in ("spring", "damping", "friction"):
            link["joint"].pop(key, None)
    path = folder / f"{name}.json"
    path.write_text(json.dumps(document, indent=1))
    return path


def dense(rows):
    matrix = casadi.SX.zeros(len(rows), len(rows[0]))
    for i, row in enumerate(rows):
        for j, entry in enumerate(row):
            matrix[i, j] = entry
    return matrix


def casadi_outputs(function, model, q, v, a):
    """The dense outputs, transposed, so that CasADi's columns are our rows."""
    robot = rigid_body.Dynamics(model, casadi.sin, casadi.cos)
    n = robot.n
    positions, rates, last = ([x[i] for i in range(n)] for x in (q, v, a))
    if function == "inverse_dynamics":
        return [dense([robot.inverse_dynamics(positions, rates, last)]).T]
    if function == "gravity_vector":
        return [dense([robot.gravity_vector(positions)]).T]
    if function == "mass_matrix":
        return [dense(robot.mass_matrix(positions))]
    if function == "centroidal_momentum_matrix":
        return [dense(robot.centroidal_momentum_matrix(positions)).T]
    if function == "forward_dynamics":
        return [dense([robot.forward_dynamics(positions, rates, last)]).T]
    if function == "regressor":
        return [dense(robot.regressor(positions, rates, last, model.bodies)).T]
    if function == "inverse_dynamics_derivatives":
        torques = dense([robot.inverse_dynamics(positions, rates, last)])
        return [casadi.densify(casadi.jacobian(torques, x)).T for x in (q, v)]
    mass = dense(robot.mass_matrix(positions))
    slopes = [casadi.reshape(casadi.jacobian(casadi.vec(mass), q[k]), n, n) for k in range(n)]
    coriolis = casadi.SX.zeros(n, n)
    for i in range(n):
        for j in range(n):
            coriolis[i, j] = sum(
                (0.5 * (slopes[k][i, j] + slopes[j][i, k] - slopes[i][j, k]) * v[k]
                 for k in range(n)), casadi.SX(0))
    gravity = dense([robot.gravity_vector(positions)]).T
    return [mass, coriolis.T, gravity]


def operations(function):
    silent = {casadi.OP_INPUT, casadi.OP_OUTPUT, casadi.OP_CONST, casadi.OP_PARAMETER}
    steps = range(function.n_instructions())
    return sum(function.instruction_id(k) not in silent for k in steps)


def build_casadi(name, function, model, folder):
    """C of a function, compiled by each compiler: libraries by compiler, and its operations."""
    n = len(model.joints)
    q, v, a = (casadi.SX.sym(x, n) for x in "qva")
    outputs = casadi_outputs(function, model, q, v, a)
    # One dense output, so that nobody pays for more pointers than the other.
    joined = casadi.cse(casadi.vertcat(*[casadi.vec(output) for output in outputs]))
    symbol = f"{name}_{function}"
    compiled = casadi.Function(symbol, [q, v, a], [casadi.densify(joined)])
    generator = casadi.CodeGenerator(f"{symbol}.c")
    generator.add(compiled)
    generator.generate(f"{folder}/")
    libraries = {}
    for compiler in ("gcc", "clang"):
        library = folder / f"{symbol}.{compiler}.so"
        run([compiler, *C_FLAGS, folder / f"{symbol}.c", "-o", library, "-lm"])
        libraries[compiler] = library
    return libraries, operations(compiled), compiled.sz_iw(), compiled.sz_w()


def build_pinocchio(folder):
    """Pinocchio's algorithms as a library, made of the headers for the native processor."""
    source, library = HERE / "pinocchio.cpp", folder / "pinocchio.so"
    if not library.exists() or library.stat().st_mtime < source.stat().st_mtime:
        print("compiling Pinocchio, which takes minutes", file=sys.stderr, flush=True)
        packages = pathlib.Path(casadi.__file__).parent
        unfinished = folder / "pinocchio.unfinished.so"
        run(["clang++", *C_FLAGS, *PINOCCHIO_FLAGS,
             "-I", packages.parent / "cmeel.prefix" / "include",
             "-isystem", packages / "include" / "eigen3", source, "-o", unfinished])
        unfinished.rename(library)
    return ctypes.CDLL(str(library))


def told(pinocchio, model):
    """Tells Pinocchio which robot is meant."""
    joints = [[joint.parent, joint.is_revolute, *sum(joint.turn, []), *joint.shift,
               joint.matter[0], *joint.matter[1], *sum(joint.matter[2], [])]
              for joint in model.joints]
    joints, gravity = (numpy.array(rows, dtype=float) for rows in (joints, model.gravity))
    pinocchio.robot_of(address(joints), len(model.joints), address(gravity))


def compare_pinocchio(pinocchio, variant, timing, function, model, arguments, theirs):
    """The largest difference between Pinocchio's results and CasADi's for these arguments."""
    n, worst = len(model.joints), 0.0
    bodies = [10 * body.joint + k for body in model.bodies for k in range(10)]
    found = numpy.full(10 * n * n + 2 * n * n + n, numpy.nan)
    for vectors, expected in zip(arguments, theirs):
        timing.evaluate(ctypes.byref(variant), address(vectors), address(vectors), 1, n)
        pinocchio.results(function.encode(), address(found))
        values = found[:10 * n * n].reshape(n, -1)[:, bodies].ravel() if function == "regressor" \
            else found[:len(expected)]
        worst = max(worst, abs(values - expected).max() / abs(expected).max())
    return worst


WRAPPER = """
/// `{function}` of `{model}`, as C calls a function that returns a struct.
#[unsafe(no_mangle)]
pub extern "C" fn {symbol}({arguments}) -> Returned<{kind}> {{
    Returned({module}::{function}(&{parameters}, {values}))
}}
"""

BATCH = """
/// `{function}` of `{model}` on many samples, {lanes} at a time.
///
/// # Safety
/// `columns` holds 3 * {n} columns of `count` numbers, `results` has room for {entries} columns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn {symbol}(results: *mut f64, columns: *const f64, count: i64) {{
    // SAFETY: as the contract above says.
    let (columns, results) = unsafe {{
        (std::slice::from_raw_parts(columns, 3 * {n} * count as usize),
         std::slice::from_raw_parts_mut(results, {entries} * count as usize))
    }};
    let columns: Vec<&[f64]> = columns.chunks(count as usize).collect();
    let mut results: Vec<&mut [f64]> = results.chunks_mut(count as usize).collect();
    let [{values}] = [{parts}].map(|part| &columns[part * {n}..][..{n}]);
    type Input = [wide::f64x{lanes}; {n}];
    {call}
}}
"""


def shapes_of(function, n, columns):
    """The shapes of the outputs."""
    return {
        "dynamics_terms": [(n, n), (n, n), (n,)],
        "inverse_dynamics_derivatives": [(n, n), (n, n)],
        "mass_matrix": [(n, n)],
        "centroidal_momentum_matrix": [(6, n)],
        "regressor": [(n, columns)],
        ALONE: [(n, columns)],
    }.get(function, [(n,)])


def wrapper(name, module, function, symbol, n, columns):
    shapes = shapes_of(function, n, columns)
    entries = sum(int(numpy.prod(shape)) for shape in shapes)
    kind = "f64"
    for length in reversed(shapes[0]):
        kind = f"[{kind}; {length}]"
    if function in FIELDS:
        kind = f"{module}::{''.join(word.title() for word in function.split('_'))}<f64>"
    baked = not module.endswith(("tunable", "sparse"))
    return entries, WRAPPER.format(
        function=function, model=name, symbol=symbol, module=module, kind=kind, values=", ".join(ARGUMENTS[function]),
        parameters=f"{module}::Parameters::default()" if baked
        else f"*PARAMETERS_{module.upper()}",
        arguments=", ".join(f"{x}: &[f64; {n}]" for x in ARGUMENTS[function]))


def batch(name, module, function, symbol, n, columns, lanes, is_stored):
    values = ", ".join(ARGUMENTS[function])
    entries = sum(int(numpy.prod(shape)) for shape in shapes_of(function, n, columns))
    fields = ", ".join(f"result.{field}" for field in FIELDS.get(function, []))
    result = f"({fields})" if fields else "result"
    computed = f"{module}::{function}(&{module}::Parameters::default(), {values})"
    pattern = f"[{values}]: [&Input; {len(ARGUMENTS[function])}]"
    call = (f"denavit_runtime::map_packs([{values}], &mut results, |{pattern}| {{ let result = "
            f"{computed}; {result} }}).unwrap();" if is_stored else
            f"let _ = &mut results; denavit_runtime::for_each_pack([{values}], count as usize, "
            f"|_, {pattern}| {{ std::hint::black_box(&{computed}); }}).unwrap();")
    return BATCH.format(
        function=function, model=name, lanes=lanes, n=n, symbol=symbol, module=module,
        entries=entries,
        values=values, parts=", ".join(str(row) for row in range(len(ARGUMENTS[function]))),
        call=call)


def base_columns(module):
    """How many base parameters an emitted module has."""
    return int(re.search(r"fn base_regressor.*?-> \[\[S; (\d+)\]; DOF\]", module, re.DOTALL)[1])


def build_ours(models, functions, folder, denavit, flags):
    """One library with every function of every model, baked and tunable."""
    source = folder / "ours" / "src"
    source.mkdir(parents=True, exist_ok=True)
    text = ["//! Emitted functions behind C's calling convention.", "",
            "/// A result in C's layout.", "#[repr(C)]", "pub struct Returned<T>(T);", "",
            "use denavit_runtime::wide;", ""]
    sizes = {}
    for name, (path, model) in models.items():
        for flavour, options in FLAVOURS.items():
            module = f"{name}_{flavour}"
            emitted = source / f"{module}.rs"
            run([denavit, "emit", path, *options, "--functions", ",".join([*functions, ALONE]), "-o",
                 emitted], stdout=subprocess.DEVNULL)
            # So that the fields of a result stand where CasADi's entries do.
            emitted.write_text(emitted.read_text().replace("pub struct", "#[repr(C)]\npub struct"))
            text.append(f"#[allow(dead_code)]\nmod {module};")
            if flavour in ("tunable", "sparse"):
                text.append(
                    f"static PARAMETERS_{module.upper()}: std::sync::LazyLock<"
                    f"{module}::Parameters<f64>> = std::sync::LazyLock::new("
                    f"{module}::Parameters::default);")
            for function in [*functions, ALONE]:
                if flavour == "sparse" and function in ALL_COLUMNS:
                    continue
                symbol = f"{module}_{function}"
                columns = base_columns(emitted.read_text()) if function == ALONE \
                    else 10 * len(model.bodies)
                size, code = wrapper(name, module, function, symbol, len(model.joints), columns)
                sizes[name, function] = size
                text.append(code)
                if flavour == "baked":
                    text += [batch(name, module, function, f"{name}_{label}_{function}",
                                   len(model.joints), columns, lanes, is_stored)
                             for label, (lanes, is_stored) in BATCHES.items()]
    (source / "lib.rs").write_text("\n".join(text))
    (folder / "ours" / "Cargo.toml").write_text(
        '[package]\nname = "ours"\nversion = "0.0.0"\nedition = "2024"\n'
        '[lib]\ncrate-type = ["cdylib"]\n'
        f'[dependencies]\ndenavit-runtime = {{ path = "{ROOT}/codegen/runtime", features = ["fma", "wide"] }}\n'
        "[profile.release]\ncodegen-units = 1\npanic = \"abort\"\n[workspace]\n")
    environment = {**os.environ, "RUSTFLAGS": flags,
                   "CARGO_TARGET_DIR": str(folder / "ours" / "target")}
    run(["cargo", "build", "--release", "--quiet"], cwd=folder / "ours", env=environment)
    return ctypes.CDLL(str(folder / "ours/target/release/libours.so")), sizes


class Variant(ctypes.Structure):
    """A function that can be called and timed: `variant` of timing.c."""

    _fields_ = [("function", ctypes.c_void_p), ("kind", ctypes.c_int64),
                ("chained", ctypes.c_int64),
                ("outputs", ctypes.c_void_p), ("integers", ctypes.c_void_p),
                ("work", ctypes.c_void_p)]

    @classmethod
    def new(cls, label, library, symbol, size, kind, integers=0, numbers=0, is_chained=False):
        """CasADi's functions have memory of their own, so they come with its size."""
        variant = cls()
        variant.label, variant.result = label, numpy.zeros(INPUTS * size)
        memory = [numpy.zeros(max(integers, 1), dtype=numpy.int64),
                  numpy.zeros(max(numbers, 1))]
        variant.kept = library, memory
        variant.function = ctypes.cast(getattr(library, symbol), ctypes.c_void_p)
        variant.kind, variant.outputs = kind, variant.result.ctypes.data
        variant.size = size
        variant.chained = size if is_chained else 0
        variant.integers, variant.work = (array.ctypes.data for array in memory)
        return variant

    def evaluate(self, timing, vectors, n):
        """The results of one input, or of all of them for a batch."""
        self.result[:] = numpy.nan
        inputs = INPUTS if self.kind == OUR_BATCH else 1
        columns = columns_of(vectors)  # an address does not keep an array
        timing.evaluate(ctypes.byref(self), address(vectors), address(columns), inputs, n)
        results = self.result[:inputs * self.size].reshape(-1, inputs).T.copy()
        if not numpy.isfinite(results).all():
            sys.exit(f"{self.label}: results that are missing, or not finite")
        return results


def in_own_frames(model, regressor):
    """A regressor for parameters in the frames of joints, for those in the frames of bodies."""
    columns = regressor.reshape(len(model.joints), 10 * len(model.bodies)).copy()
    for row, body in enumerate(model.bodies):
        block = slice(10 * row, 10 * row + 10)
        columns[:, block] = columns[:, block] @ numpy.array(rigid_body.axis_frame_columns(body)).T
    return columns.ravel()


def difference(function, model, ours, theirs):
    """The largest difference, relative to the largest entry."""
    if function == "regressor":
        theirs = in_own_frames(model, theirs)
    return abs(ours - theirs).max() / abs(theirs).max()


def address(array):
    return ctypes.c_void_p(array.ctypes.data)


def columns_of(arguments):
    """Inputs as columns with a number for each of them."""
    return numpy.ascontiguousarray(arguments.reshape(len(arguments), -1).T)


def exact(function, model, q, v, a):
    """The result to some 40 digits, slopes by differences: of 60 digits they take 20."""
    robot = rigid_body.Dynamics(model, mpmath.sin, mpmath.cos)
    step = mpmath.mpf(10) ** -20

    def slope(of, x, k):
        ahead, behind = ([y + sign * step * (row == k) for row, y in enumerate(x)]
                         for sign in (1, -1))
        return [(f - b) / (2 * step) for f, b in zip(of(ahead), of(behind))]

    flat = lambda rows: [x for row in rows for x in row]
    n = robot.n
    if function == "mass_matrix":
        return flat(robot.mass_matrix(q))
    if function == "gravity_vector":
        return robot.gravity_vector(q)
    if function == "centroidal_momentum_matrix":
        return flat(robot.centroidal_momentum_matrix(q))
    if function == "regressor":
        return flat(robot.regressor(q, v, a, model.bodies))
    if function == "inverse_dynamics_derivatives":
        by_position = [slope(lambda x: robot.inverse_dynamics(x, v, a), q, k) for k in range(n)]
        by_rate = [slope(lambda x: robot.inverse_dynamics(q, x, a), v, k) for k in range(n)]
        return flat(zip(*by_position)) + flat(zip(*by_rate))
    if function == "dynamics_terms":
        slopes = [slope(lambda x: flat(robot.mass_matrix(x)), q, k) for k in range(n)]
        coriolis = [sum((slopes[k][n * i + j] + slopes[j][n * i + k] - slopes[i][n * j + k])
                        * v[k] / 2 for k in range(n)) for i in range(n) for j in range(n)]
        return flat(robot.mass_matrix(q)) + coriolis + robot.gravity_vector(q)
    return getattr(robot, function)(q, v, a)


def errors(function, model, variants, timing, arguments, n):
    """The largest error of each variant, in parts of the largest entry, against 60 digits."""
    mpmath.mp.dps = 60
    worst = [0.0] * len(variants)
    for vectors in arguments[:16]:
        truth = exact(function, model,
                      *([mpmath.mpf(float(x)) for x in vector] for vector in vectors))
        own = in_own_frames(model, numpy.array(truth)) if function == "regressor" else truth
        largest = max(abs(x) for x in own)
        for row, variant in enumerate(variants):
            found = variant.evaluate(timing, vectors[None], n)[0]
            right = truth if variant.kind == CASADI else own
            off = max(abs(mpmath.mpf(float(x)) - y) for x, y in zip(found, right))
            worst[row] = max(worst[row], float(off / largest))
    return worst


def timed(timing, variants, arguments, n):
    """Nanoseconds of a call: a row for each round, a column for each variant."""
    together = (Variant * len(variants))(*variants)

    columns = columns_of(arguments)

    def race(rounds, repeats):
        results = numpy.zeros((rounds, len(variants)))
        timing.race(together, len(variants), rounds, repeats, address(arguments),
                    address(columns), INPUTS, n, address(results))
        return results

    return race(ROUNDS, max(1, int(1e6 / (INPUTS * race(1, 4).max()))))


def compete(name, function, model, libraries, folder):
    """A row of the table."""
    ours, sizes, timing, pinocchio = libraries
    n, size = len(model.joints), sizes[name, function]
    built, count, integers, numbers = build_casadi(name, function, model, folder)
    variants = [Variant.new(flavour, ours, f"{name}_{flavour}_{function}", size, OURS)
                for flavour in FLAVOURS if flavour != "sparse" or function not in ALL_COLUMNS]
    compared = len(variants)
    variants += [Variant.new(label, ours, f"{name}_{label}_{function}", size, OUR_BATCH)
                 for label in BATCHES]
    first = len(variants)
    variants += [Variant.new(compiler, ctypes.CDLL(str(path)), f"{name}_{function}",
                             size, CASADI, integers, numbers) for compiler, path in built.items()]
    generator = numpy.random.default_rng(7)
    arguments = generator.uniform(-1, 1, (INPUTS, 3, n))
    worst, expected = 0.0, []
    batches = [variant.evaluate(timing, arguments, n) for variant in variants[compared:first] if BATCHES[variant.label][1]]
    for row, vectors in enumerate(arguments):
        theirs = variants[first].evaluate(timing, vectors[None], n)[0]
        expected.append(theirs)
        results = [variant.evaluate(timing, vectors[None], n)[0] for variant in variants[:compared]]
        for result in results + [batch[row] for batch in batches]:
            worst = max(worst, difference(function, model, result, theirs))
    peers = {}
    if pinocchio:
        told(pinocchio, model)
        peer = Variant.new("pinocchio", pinocchio, function, size, OURS)
        peers["Pinocchio's"] = compare_pinocchio(pinocchio, peer, timing, function, model, arguments, expected)
    for side, found in {"ours": worst, **peers}.items():
        # Solving on a floating base loses some digits on either side.
        if not found < (1e-9 if function == "forward_dynamics" else 1e-12):
            sys.exit(f"{name} {function}: {side} and CasADi's differ by {found:.1e}")
    single = variants[:compared] + variants[first:]
    error = dict(zip([v.label for v in single],
                     errors(function, model, single, timing, arguments, n)))
    chained = len(variants)
    variants += [Variant.new("chained", ours, f"{name}_baked_{function}", size, OURS, is_chained=True)]
    variants += [Variant.new(f"chained_{v.label}", v.kept[0], f"{name}_{function}", size, CASADI,
                             integers, numbers, is_chained=True) for v in variants[first:chained]]
    if pinocchio:
        variants.append(peer)
    times = timed(timing, variants, arguments, n)
    best = times[:, first:chained].min(axis=1)
    latency = times[:, chained]
    median = lambda column: statistics.median(column.tolist())
    own = {v.label: times[:, row] for row, v in enumerate(variants)}
    nothing = numpy.full(ROUNDS, numpy.nan)
    sparse, slowest = (own.get(label, nothing) for label in ("sparse", "pinocchio"))
    return {
        "model": name, "function": function,
        **{f"{v.label}_ns": median(times[:, row]) for row, v in enumerate(variants)},
        "ratio": median(times[:, 0] / best), "tunable_ratio": median(own["tunable"] / own["baked"]),
        "sparse_ratio": median(sparse / own["baked"]),
        "chained_ratio": median(latency / times[:, chained + 1:chained + 3].min(axis=1)),
        "pinocchio_ns": median(slowest), "pinocchio_ratio": median(times[:, 0] / slowest),
        "batch_ratio": median(times[:, compared] / times[:, 0]),
        "latency_ratio": median(times[:, compared] / latency),
        "casadi_operations": count, "difference": worst,
        **{f"{label}_error": value for label, value in error.items()},
    }


def alone(name, model, libraries):
    """A row of the table of base regressors."""
    ours, sizes, timing, _ = libraries
    n, size = len(model.joints), sizes[name, ALONE]
    variants = [Variant.new("baked", ours, f"{name}_baked_{ALONE}", size, OURS)]
    variants += [Variant.new(label, ours, f"{name}_{label}_{ALONE}", size, OUR_BATCH)
                 for label in BATCHES]
    arguments = numpy.random.default_rng(7).uniform(-1, 1, (INPUTS, 3, n))
    stored = [v.evaluate(timing, arguments, n) for v in variants[1:] if BATCHES[v.label][1]]
    for row, vectors in enumerate(arguments):
        single = variants[0].evaluate(timing, vectors[None], n)[0]
        if not all(numpy.array_equal(single, batch[row]) for batch in stored):
            sys.exit(f"{name} {ALONE}: a pack has other numbers")
    times = timed(timing, variants, arguments, n)
    return {"model": name, "function": ALONE, "columns": size // n,
            **{f"{v.label}_ns": statistics.median(times[:, row].tolist())
               for row, v in enumerate(variants)}}


COLUMNS = {
    "times": [
        ("ours", "{baked_ns:.0f}"), ("without fusing", "{plain_ns:.0f}"),
        ("CasADi, gcc", "{gcc_ns:.0f}"), ("clang", "{clang_ns:.0f}"),
        ("ours / CasADi", "{ratio:.2f}"), ("tunable / baked", "{tunable_ratio:.2f}"),
        ("sparse / baked", "{sparse_ratio:.2f}"),
    ],
    "in a chain": [
        ("ours", "{chained_ns:.0f}"), ("CasADi, gcc", "{chained_gcc_ns:.0f}"),
        ("clang", "{chained_clang_ns:.0f}"), ("ours / CasADi", "{chained_ratio:.2f}"),
    ],
    "beside Pinocchio": [
        ("ours", "{baked_ns:.0f}"), ("Pinocchio", "{pinocchio_ns:.0f}"),
        ("ours / Pinocchio", "{pinocchio_ratio:.3f}"),
    ],
    "many samples": [
        ("one at a time", "{baked_ns:.0f}"), ("f64x4", "{x4_ns:.0f}"), ("f64x8", "{x8_ns:.0f}"),
        ("f64x4, stored", "{stored_ns:.0f}"), ("f64x8, stored", "{stored8_ns:.0f}"), ("f64x4 / one", "{batch_ratio:.2f}"),
        ("f64x4 / one in a chain", "{latency_ratio:.2f}"),
    ],
    "errors": [
        ("ours", "{baked_error:.1e}"), ("without fusing", "{plain_error:.1e}"),
        ("CasADi, gcc", "{gcc_error:.1e}"), ("ours and CasADi", "{difference:.1e}"),
    ],
    "base regressors": [
        ("columns", "{columns}"), ("one at a time", "{baked_ns:.0f}"), ("f64x4", "{x4_ns:.0f}"),
        ("f64x8", "{x8_ns:.0f}"), ("f64x4, stored", "{stored_ns:.0f}"), ("f64x8, stored", "{stored8_ns:.0f}"),
    ],
}


def table(rows, title):
    columns = COLUMNS[title]
    lines = ["| model | function | " + " | ".join(name for name, _ in columns) + " |",
             "|---|---|" + "---:|" * len(columns)]
    for row in rows:
        cells = " | ".join(cell.format(**row).replace("nan", "") for _, cell in columns)
        lines.append("| {model} | {function} | ".format(**row) + cells + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", default=",".join(MODELS))
    parser.add_argument("--functions", default=",".join(f for f in ARGUMENTS if f != ALONE))
    parser.add_argument("--denavit", default=str(ROOT / "target/release/denavit"))
    parser.add_argument("--folder", default=str(ROOT / "target/race"))
    parser.add_argument("--rustflags", default="-C target-cpu=native")
    parser.add_argument("--pinocchio", action="store_true", help="race Pinocchio, too")
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    folder = pathlib.Path(options.folder)
    folder.mkdir(parents=True, exist_ok=True)
    if not shutil.which("clang") or not shutil.which("gcc"):
        sys.exit("gcc and clang are needed")
    functions = options.functions.split(",")
    models = {}
    for name in options.models.split(","):
        path = rigid_model(name, folder)
        models[name] = path, rigid_body.Model(path)
    ours, sizes = build_ours(models, functions, folder, options.denavit, options.rustflags)
    run(["gcc", "-O2", "-shared", "-fPIC", HERE / "timing.c", "-o", folder / "timing.so"])
    timing = ctypes.CDLL(str(folder / "timing.so"))
    pinocchio = build_pinocchio(folder) if options.pinocchio else None
    libraries = ours, sizes, timing, pinocchio
    rows = []
    for name, (_, model) in models.items():
        for function in functions:
            row = compete(name, function, model, libraries, folder)
            rows.append(row)
            print(table([row], "times").splitlines()[-1], file=sys.stderr, flush=True)
    base = [alone(name, model, libraries) for name, (_, model) in models.items()]
    text = "\n\n".join(f"{title}\n\n{table(base if title == 'base regressors' else rows, title)}"
                       for title in COLUMNS
                       if pinocchio or title != "beside Pinocchio") + "\n"
    print(text)
    if options.output:
        pathlib.Path(options.output).write_text(text)


if __name__ == "__main__":
    main()
