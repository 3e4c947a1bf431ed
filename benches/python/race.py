#!/usr/bin/env python3
"""The Python package against Pinocchio, in one run: many samples, and one call.

    python3 -m venv .venv && .venv/bin/pip install ./python pin casadi
    .venv/bin/python benches/python/race.py [--samples 100000] [--rounds 7]

The robot is the shipped PUMA 560 without its drives: rigid bodies, as Pinocchio has them, by way of
the URDF that `denavit export` writes. Results are compared before anything is timed. Pinocchio's
loop in C++ is compiled by clang for the native processor and runs on one core, as a loop does; `pin` is
called from Python for each sample. denavit has all cores, in machine code made at run time. A round
times each once, in turns; figures are medians over rounds, ratios medians of the rounds' ratios.
Other work on the machine slows what has all cores most: the processor's time is told beside.
"""
import argparse
import ctypes
import pathlib
import statistics
import subprocess
import sys
import time

import casadi
import numpy
import pin_of_model
import pinocchio

import denavit

HERE = pathlib.Path(__file__).resolve().parent
BUILT = HERE.parent.parent / "target" / "race"
FLAGS = ["-O3", "-march=native", "-shared", "-fPIC", "-std=c++17", "-DNDEBUG", "-w",
         "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
         "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30"]


def built():
    """Pinocchio's loop as a library, compiled where it is not there yet."""
    source, library = HERE / "pinocchio_batch.cpp", BUILT / "pinocchio_batch.so"
    if library.exists() and library.stat().st_mtime > source.stat().st_mtime:
        return called(library)
    print("compiling Pinocchio, which takes minutes", file=sys.stderr, flush=True)
    BUILT.mkdir(parents=True, exist_ok=True)
    # of its packages for Python: the headers, with Eigen those of CasADi
    packages = pathlib.Path(casadi.__file__).parent
    prefix = packages.parent / "cmeel.prefix"
    unfinished = BUILT / "pinocchio_batch.unfinished.so"
    subprocess.run(["clang++", *FLAGS, "-I", prefix / "include",
                    "-isystem", packages / "include" / "eigen3",
                    source, "-o", unfinished], check=True)
    unfinished.rename(library)
    return called(library)


def called(library):
    function = ctypes.CDLL(str(library)).inverse_dynamics
    function.restype = ctypes.c_double
    return function


def loop(function, robot, q, qd, qdd):
    """The torques of Pinocchio's loop in C++."""
    joints = range(1, robot.njoints)
    assert all(robot.joints[k].shortname() == "JointModelRZ" for k in joints)
    places = numpy.array([numpy.r_[robot.jointPlacements[k].rotation.ravel(),
                                   robot.jointPlacements[k].translation] for k in joints])
    bodies = numpy.array([numpy.r_[body.mass, body.lever, body.inertia.ravel()]
                          for body in (robot.inertias[k] for k in joints)])
    gravity = numpy.array(robot.gravity.linear)
    tau = numpy.empty_like(q)
    arrays = (places, bodies, gravity, q, qd, qdd, tau)
    address = [ctypes.c_void_p(one.ctypes.data) for one in arrays]
    function(*address[:3], ctypes.c_int(robot.nv), *address[3:],
                       ctypes.c_long(len(q)))
    return tau


def timed(call):
    """Seconds that a call took, and those of the processor."""
    started, used = time.perf_counter(), time.process_time()
    call()
    return time.perf_counter() - started, time.process_time() - used


def repeated(call, times=20):
    """The same of one of several calls in a row: as long as what others take for theirs."""

    def several():
        for _ in range(times):
            call()

    return tuple(seconds / times for seconds in timed(several))


def one_call(model, q, qd, qdd, calls=20_000):
    """Seconds of one call of one sample, at best over parts of the calls."""
    part = calls // 20

    def several():
        for _ in range(part):
            model.inverse_dynamics(q, qd, qdd)

    return min(timed(several)[0] for _ in range(20)) / part


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    model, robot = pin_of_model.rigid("puma560")
    random = numpy.random.default_rng(1)
    q, qd, qdd = random.uniform(-2, 2, (3, options.samples, model.dof))
    function = built()
    expected = loop(function, robot, q, qd, qdd)
    found = model.inverse_dynamics(q, qd, qdd)
    error = numpy.abs(found - expected).max() / numpy.abs(expected).max()
    print(f"largest relative difference of the torques: {error:.1e}")
    assert error < 1e-9
    data = robot.createData()

    def from_python():
        for at in range(options.samples):
            pinocchio.rnea(robot, data, q[at], qd[at], qdd[at])

    rounds = []
    for _ in range(options.rounds):
        rounds.append((repeated(lambda: model.inverse_dynamics(q, qd, qdd)),
                       timed(lambda: loop(function, robot, q, qd, qdd)),
                       timed(from_python)))
    names = ("denavit, one call", "Pinocchio, loop in C++", "pin, loop in Python")
    for at, name in enumerate(names):
        told = [name.ljust(24)]
        for kind, what in enumerate(("ns a sample", "ns of the processor")):
            seconds = statistics.median(row[at][kind] for row in rounds)
            ratio = statistics.median(row[at][kind] / row[0][kind] for row in rounds)
            nanoseconds = 1e9 * seconds / options.samples
            told.append(f"{nanoseconds:8.1f} {what}, {ratio:5.1f} times denavit")
        print("; ".join(told))
    single = one_call(model, q[0], qd[0], qdd[0])
    print(f"one sample by one call: {1e6 * single:.2f} us in all")


if __name__ == "__main__":
    main()
