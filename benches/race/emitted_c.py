#!/usr/bin/env python3
"""The race of emitted C and C++ against emitted Rust, in one process.

    cargo build --release && python3 benches/race/emitted_c.py [--models puma560,tulip] \
        [--clang COMMAND --clangxx COMMAND] [-o FILE]

The same model, flavour and functions are emitted in each language. C is compiled by gcc and by
clang, C++ by g++ and clang++: -O3 -march=native; Rust for the native processor, with the runtime's
feature `fma` where products are fused. Results are compared before anything is timed: bit by bit,
but for zeros of fused products, whose sign gcc 12 may turn. A round times every variant once, in
turns; tables have medians over rounds of the nanoseconds of a call, and of ratios to Rust within a
round. It runs on x86-64 alone, as it calls Rust by the way in which C returns arrays there.

Languages are compared, and not ages of compilers, where clang has the LLVM of rustc (`rustc -vV`):
PyPI's ziglang has a new one (`--clang "python -m ziglang cc -fno-sanitize=undefined"`).
"""
import argparse
import ctypes
import os
import pathlib
import random
import shlex
import shutil
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MODELS = ["puma560", "tulip_leg6", "iiwa", "tulip"]
ARGUMENTS = {
    "inverse_dynamics": ["q", "qd", "qdd"],
    "mass_matrix": ["q"],
    "forward_dynamics": ["q", "qd", "tau"],
    "dynamics_terms": ["q", "qd"],
    "gravity_vector": ["q"],
    "inverse_dynamics_derivatives": ["q", "qd", "qdd"],
}
# How a module is emitted; whether its parameters are set at run time, and its products fused.
FLAVOURS = {
    "baked": (["--baked"], False, False),
    "tunable": ([], True, False),
    "fused": (["--baked", "--fused"], False, True),
}
COMPILERS = {"gcc": ("c", "-std=c99"), "clang": ("c", "-std=c99"),
             "g++": ("cpp", "-std=c++17"), "clang++": ("cpp", "-std=c++17")}
C_FLAGS = ["-O3", "-march=native", "-shared", "-fPIC"]
OURS, INPUTS, ROUNDS = 1, 64, 21

RUST = """
#[unsafe(no_mangle)]
pub extern "C" fn {symbol}({arguments}) -> Returned<{kind}> {{
    Returned({module}::{function}(&{parameters}, {values}))
}}
"""


def run(command, **options):
    return subprocess.run(command, check=True, text=True, **options)


def shapes_of(function, n):
    """The shapes of the results."""
    matrix = (n, n)
    return {"dynamics_terms": [matrix, matrix, (n,)], "mass_matrix": [matrix],
            "inverse_dynamics_derivatives": [matrix, matrix]}.get(function, [(n,)])


def size_of(function, n):
    return sum(n if len(shape) == 1 else n * n for shape in shapes_of(function, n))


def emit(denavit, model, options, output):
    run([denavit, "emit", model, *options, "--functions", ",".join(ARGUMENTS), "-o", output],
        stdout=subprocess.DEVNULL)


def joints_of(module):
    return int(module.split("pub const DOF: usize = ")[1].split(";")[0])


def build_rust(denavit, models, folder, is_fused):
    """A library with every function of every model, and the number of each model's joints."""
    package = folder / ("rust_fused" if is_fused else "rust_plain")
    source = package / "src"
    source.mkdir(parents=True, exist_ok=True)
    text = ["//! Emitted functions behind C's calling convention.", "",
            "/// A result in C's layout.", "#[repr(C)]", "pub struct Returned<T>(T);", ""]
    joints = {}
    for model in models:
        for flavour, (options, is_tunable, fuses) in FLAVOURS.items():
            if fuses != is_fused:
                continue
            module = f"{model}_{flavour}"
            path = source / f"{module}.rs"
            emit(denavit, model, options, path)
            code = path.read_text().replace("pub struct", "#[repr(C)]\npub struct")
            path.write_text(code)
            n = joints[model] = joints_of(code)
            text.append(f"#[allow(dead_code)]\nmod {module};")
            held = f"PARAMETERS_{module.upper()}"
            if is_tunable:
                text.append(f"static {held}: std::sync::LazyLock<{module}::Parameters<f64>> = "
                            f"std::sync::LazyLock::new({module}::Parameters::default);")
            for function, arguments in ARGUMENTS.items():
                kind = "f64"
                for length in shapes_of(function, n)[0]:
                    kind = f"[{kind}; {length}]"
                if len(shapes_of(function, n)) > 1:
                    struct = "".join(word.title() for word in function.split("_"))
                    kind = f"{module}::{struct}<f64>"
                text.append(RUST.format(
                    symbol=f"{module}_{function}", module=module, function=function, kind=kind,
                    parameters=f"*{held}" if is_tunable else f"{module}::Parameters::default()",
                    arguments=", ".join(f"{name}: &[f64; {n}]" for name in arguments),
                    values=", ".join(arguments)))
    (source / "lib.rs").write_text("\n".join(text))
    features = ', features = ["fma"]' if is_fused else ""
    (package / "Cargo.toml").write_text(
        '[package]\nname = "ours"\nversion = "0.0.0"\nedition = "2024"\n'
        '[lib]\ncrate-type = ["cdylib"]\n[dependencies]\n'
        f'denavit-runtime = {{ path = "{ROOT}/codegen/runtime"{features} }}\n'
        '[profile.release]\ncodegen-units = 1\npanic = "abort"\n[workspace]\n')
    environment = {**os.environ, "RUSTFLAGS": "-C target-cpu=native",
                   "CARGO_TARGET_DIR": str(package / "target")}
    run(["cargo", "build", "--release", "--quiet"], cwd=package, env=environment)
    return ctypes.CDLL(str(package / "target/release/libours.so")), joints


def build_c(denavit, model, flavour, compiler, command, n, folder):
    """A library with every function of a model, called as the Rust is."""
    language, standard = COMPILERS[compiler]
    options, is_tunable, _ = FLAVOURS[flavour]
    place = folder / f"{model}_{flavour}_{compiler.replace('+', 'p')}"
    place.mkdir(parents=True, exist_ok=True)
    is_cpp = language == "cpp"
    emit(denavit, model, options, place / ("model.hpp" if is_cpp else "model.c"))
    lines = ['#include "model.hpp"' if is_cpp else '#include "model.c"']
    if is_tunable and is_cpp:
        lines.append(f"static const auto held = {model}::default_parameters<double>();")
    elif is_tunable:
        lines += [f"static {model}_parameters held;", "__attribute__((constructor)) "
                  f"static void setup(void) {{ {model}_default_parameters(&held); }}"]
    for function, arguments in ARGUMENTS.items():
        # An array may overlap with no other, and the compiler of Rust knows it.
        given = ", ".join(["double *__restrict out"] + [f"const double *{a}" for a in arguments])
        passed = (["held" if is_cpp else "&held"] if is_tunable else []) + list(arguments)
        at = 0
        for shape in shapes_of(function, n):
            passed.append(f"out + {at}")
            at += n if len(shape) == 1 else n * n
        called = f"{model}::{function}" if is_cpp else f"{model}_{function}"
        start = 'extern "C" ' if is_cpp else ""
        lines.append(f"{start}void race_{function}({given}) {{ {called}({', '.join(passed)}); }}")
    wrapper = place / ("race.cpp" if is_cpp else "race.c")
    wrapper.write_text("\n".join(lines) + "\n")
    library = place / "race.so"
    run([*command, standard, *C_FLAGS, wrapper, "-o", library, "-lm"])
    return ctypes.CDLL(str(library))


class Variant(ctypes.Structure):
    """A function that can be called and timed: `variant` of timing.c."""

    _fields_ = [("function", ctypes.c_void_p), ("kind", ctypes.c_int64),
                ("chained", ctypes.c_int64), ("outputs", ctypes.c_void_p),
                ("integers", ctypes.c_void_p), ("work", ctypes.c_void_p)]

    @classmethod
    def new(cls, label, library, symbol, size):
        variant = cls()
        variant.label, variant.result = label, (ctypes.c_double * size)()
        variant.kept = library
        variant.function = ctypes.cast(getattr(library, symbol), ctypes.c_void_p)
        variant.kind, variant.outputs = OURS, ctypes.addressof(variant.result)
        return variant

    def evaluate(self, timing, vectors, n):
        timing.evaluate(ctypes.byref(self), vectors, vectors, 1, n)
        return list(self.result), bytes(self.result)


def compete(model, flavour, function, n, rust, libraries, timing):
    """Medians of the nanoseconds of each variant, and of the ratios to Rust."""
    size, is_fused = size_of(function, n), FLAVOURS[flavour][2]
    variants = [Variant.new("Rust", rust, f"{model}_{flavour}_{function}", size)]
    variants += [Variant.new(compiler, library, f"race_{function}", size)
                 for compiler, library in libraries.items()]
    generator = random.Random(7)
    numbers = [generator.uniform(-1, 1) for _ in range(INPUTS * 3 * n)]
    arguments = (ctypes.c_double * len(numbers))(*numbers)
    for row in range(INPUTS):
        vectors = (ctypes.c_double * (3 * n))(*numbers[3 * n * row:3 * n * (row + 1)])
        results = [variant.evaluate(timing, vectors, n)[not is_fused] for variant in variants]
        if any(result != results[0] for result in results):
            sys.exit(f"{model} {flavour} {function}: not the same numbers")
    together = (Variant * len(variants))(*variants)

    def race(rounds, repeats):
        results = (ctypes.c_double * (rounds * len(variants)))()
        timing.race(together, len(variants), rounds, repeats, arguments, arguments, INPUTS, n,
                    results)
        return [results[k * len(variants):(k + 1) * len(variants)] for k in range(rounds)]

    repeats = max(1, int(1e6 / (INPUTS * max(race(1, 4)[0]))))
    rounds = race(ROUNDS, repeats)
    times = [statistics.median(round[k] for round in rounds) for k in range(len(variants))]
    ratios = [statistics.median(round[k] / round[0] for round in rounds)
              for k in range(1, len(variants))]
    return times, ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", default=",".join(MODELS))
    parser.add_argument("--denavit", default=str(ROOT / "target/release/denavit"))
    parser.add_argument("--folder", default=str(ROOT / "target/race_c"))
    parser.add_argument("--clang", default="clang")
    parser.add_argument("--clangxx", default="clang++")
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    folder = pathlib.Path(options.folder)
    folder.mkdir(parents=True, exist_ok=True)
    given = {"clang": options.clang, "clang++": options.clangxx}
    commands = {compiler: shlex.split(given.get(compiler, compiler)) for compiler in COMPILERS}
    compilers = [compiler for compiler in COMPILERS if shutil.which(commands[compiler][0])]
    models = options.models.split(",")
    run(["gcc", "-O2", "-shared", "-fPIC", HERE / "timing.c", "-o", folder / "timing.so"])
    timing = ctypes.CDLL(str(folder / "timing.so"))
    rust = {fused: build_rust(options.denavit, models, folder, fused) for fused in (False, True)}
    lines = ["| model | function | flavour | Rust | " + " | ".join(compilers)
             + " | C / Rust | C++ / Rust |",
             "|---|---|---|---:|" + "---:|" * (len(compilers) + 2)]
    for model in models:
        for flavour, (_, _, is_fused) in FLAVOURS.items():
            library, joints = rust[is_fused]
            n = joints[model]
            libraries = {compiler: build_c(options.denavit, model, flavour, compiler,
                                           commands[compiler], n, folder)
                         for compiler in compilers}
            for function in ARGUMENTS:
                times, ratios = compete(model, flavour, function, n, library, libraries, timing)
                best = [min(ratio for ratio, compiler in zip(ratios, compilers)
                            if COMPILERS[compiler][0] == language) for language in ("c", "cpp")]
                cells = [f"{time:.0f}" for time in times] + [f"{ratio:.2f}" for ratio in best]
                lines.append(f"| {model} | {function} | {flavour} | " + " | ".join(cells) + " |")
                print(lines[-1], file=sys.stderr, flush=True)
    text = "\n".join(lines) + "\n"
    print(text)
    if options.output:
        pathlib.Path(options.output).write_text(text)


if __name__ == "__main__":
    main()
