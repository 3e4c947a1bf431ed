#!/usr/bin/env python3
"""Compares imported robots with Pinocchio (URDF) and MuJoCo (MJCF), outside CI.

    python -m venv venv && venv/bin/pip install pin mujoco example-robot-data dm_control gymnasium
    cargo build --release
    venv/bin/python benches/import/check.py [--only NAME] [--floating] [--urdf] [--mjcf]

For each robot: inverse dynamics, mass matrix, gravity, and the Jacobian of every link's frame, at 20
random states, as relative differences. Prints a table, and the reason of each refusal. For URDF,
`back` is the same of the model written as URDF again, a thousandfold: equal means 1e-12 there.
`rounded` are files whose turns were within rounding of quarter turns, which MuJoCo does not round.
"""

import argparse
import glob
import json
import os
import subprocess
import sys
import sysconfig
import tempfile
import time

sys.path.insert(0, os.path.dirname(__file__))
import compare_mjcf
import compare_urdf

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DENAVIT = os.environ.get("DENAVIT", os.path.join(ROOT, "target/release/denavit"))
LIMIT = 1e-9


class Model:
    """A model file, evaluated by the command."""

    def __init__(self, path):
        self.path = path
        self.text = json.load(open(path))

    def names(self):
        rows = self.text["links"]
        joints = [row["name"] for row in rows if row["joint"]["type"] != "fixed"]
        if self.text.get("base") == "floating":
            base = ["base_z", "base_x", "base_y", "base_yaw", "base_roll", "base_pitch"]
            joints = base + joints
        return joints

    def run(self, *arguments):
        done = subprocess.run([DENAVIT, *arguments], text=True, capture_output=True)
        if done.returncode:
            raise RuntimeError(done.stderr.strip())

    def evaluate(self, states, functions):
        command = [DENAVIT, "evaluate", self.path, "--at", "-", "--functions", ",".join(functions)]
        done = subprocess.run(command, input=json.dumps({"states": states}), text=True,
                              capture_output=True)
        if done.returncode:
            raise RuntimeError(done.stderr.strip())
        return json.loads(done.stdout)


def imported(robot, out, options):
    start = time.perf_counter()
    done = subprocess.run([DENAVIT, "import", robot, "-o", out, *options], text=True,
                          capture_output=True)
    took = time.perf_counter() - start
    reason = None
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "remark" not in line]
        reason = lines[0].replace(robot, "").lstrip(":") if lines else "?"
        if len(lines) > 2:
            reason += f" (and {sum(not line.startswith('  hint') for line in lines) - 1} more)"
    return took, reason


def check(robot, compare, options, rows):
    name = os.path.relpath(robot, compare.base(robot))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "model.json")
        took, reason = imported(robot, path, options)
        if reason:
            rows.append((name, "refused", reason, took))
            print(f"{name:62} refused  {reason}", flush=True)
            return
        try:
            worst, size = compare.differences(robot, Model(path), folder, options)
        except compare.NotComparable as why:
            rows.append((name, "not compared", str(why), took))
            print(f"{name:62} not compared: {why}", flush=True)
            return
        most = max(worst.values())
        rounds = any("within rounding" in said for said in json.load(open(path))["assumptions"])
        verdict = "equal" if most <= LIMIT else "DIFFERS"
        if verdict == "DIFFERS" and rounds and most < 1e-6 and compare is compare_mjcf:
            verdict = "rounded"
        rows.append((name, verdict, worst, took))
        shown = "  ".join(f"{key} {value:.0e}" for key, value in worst.items())
        print(f"{name:62} {verdict:8} {size:3} joints  {shown}  {took:.3f} s", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    parser.add_argument("--floating", action="store_true")
    parser.add_argument("--urdf", action="store_true")
    parser.add_argument("--mjcf", action="store_true")
    parser.add_argument("files", nargs="*")
    options = parser.parse_args()
    site = sysconfig.get_paths()["purelib"]
    both = options.urdf == options.mjcf
    rows = []
    if options.urdf or both:
        robots = os.path.join(site, "cmeel.prefix/share/example-robot-data/robots")
        files = sorted(glob.glob(os.path.join(robots, "**/*.urdf"), recursive=True))
        given = ["--mimic", "free"] + (["--base", "floating"] if options.floating else [])
        for robot in options.files or files:
            if options.only in robot:
                check(robot, compare_urdf, given, rows)
    if options.mjcf or both:
        files = [file for package in ("dm_control", "gymnasium")
                 for file in sorted(glob.glob(os.path.join(site, package, "**/*.xml"), recursive=True))
                 if "<mujoco" in open(file).read()]
        for robot in options.files or files:
            if options.only in robot:
                check(robot, compare_mjcf, [], rows)
    for verdict in ("equal", "rounded", "DIFFERS", "not compared", "refused"):
        print(f"{verdict}: {sum(row[1] == verdict for row in rows)}")
    if rows:
        print(f"longest import: {max(row[3] for row in rows):.3f} s")


if __name__ == "__main__":
    main()
