"""A diagnosis with rivals: what two effects do is the same in these small motions.

    python tests/pages/rivals.py DENAVIT FOLDER

An arm of two joints has viscous friction at its first one that the model does not know. It hardly
moves about one posture, where its load is nearly constant: friction that grows with the load would
do as well. Writes FOLDER/found/report.html, which has a motion that would tell them apart.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

# a lap, and the shares of the sines that a joint follows [s]
LAP_S = 5.0
SHARES = (1.0, 0.5, 0.3)
# how far joints go about their posture [rad]
SIZE = 0.02
HIDDEN_NMS = 4.0


def link(name, length, mass, inertia):
    return {
        "name": name,
        "joint": {"type": "revolute", "a": length},
        "limits": {"position": [-1.4, 1.4], "velocity": 4, "acceleration": 20, "torque": [-60, 60]},
        "body": {
            "mass": {"value": mass, "std": 0.005 * mass},
            "com": [{"value": -0.45 * length, "std": 0.001}, 0, 0],
            "about": "com",
            "inertia": {"xx": 0.001, "yy": inertia, "zz": {"value": inertia, "std": 0.001},
                        "xy": 0, "xz": 0, "yz": 0},
        },
    }


def model(damping):
    links = [link("shoulder", 0.5, 2.0, 0.05), link("elbow", 0.4, 1.2, 0.02)]
    if damping:
        links[0]["joint"]["damping"] = damping
    return {"format": "denavit-model/1", "name": "bench_arm", "convention": "standard",
            "gravity": [0, -9.81, 0], "links": links}


def reference(about, phase):
    angles = [k * phase for k in range(1, len(SHARES) + 1)]
    return {"fourier": {
        "frequencies_rad_s": [2 * math.pi * k / LAP_S for k in range(1, len(SHARES) + 1)],
        "offset": about,
        "sines": [SIZE * share * math.cos(angle) for share, angle in zip(SHARES, angles)],
        "cosines": [SIZE * share * math.sin(angle) for share, angle in zip(SHARES, angles)],
    }}


def scenario(name, phase, seed):
    joint = lambda about, own: {"kp": 400, "kd": 12, "reference": reference(about, own)}
    return {
        "format": "denavit-scenario/1", "name": name,
        "description": "Small motions about a posture.",
        "model": "truth.json", "duration_s": 20, "initial": {"on_reference": True},
        "control": {"period_s": 0.001, "compensation": "gravity",
                    "joints": {"shoulder": joint(0.0, phase),
                               "elbow": joint(0.3, 0.7 + 1.9 * phase)}},
        "measurement": {"resolution": 1e-6, "logged": True, "torque_noise": 0.02},
        "seed": seed,
    }


def main():
    denavit, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    files = {"arm": model(None), "truth": model(HIDDEN_NMS),
             "train": scenario("train", 0.0, 1), "validate": scenario("validate", 1.1, 2)}
    for name, text in files.items():
        (folder / f"{name}.json").write_text(json.dumps(text, indent=1), encoding="utf-8")
    for name in ("train", "validate"):
        command = [denavit, "simulate", f"{name}.json", "-o", f"{name}.csv"]
        subprocess.run(command, cwd=folder, check=True)
    found = subprocess.run(
        [denavit, "diagnose", "arm.json", "--train", "train.csv", "--validate", "validate.csv",
         "--out", "found"], cwd=folder, check=False)
    # rivals are an answer of their own: the command says 1 where it cannot tell
    assert found.returncode in (0, 1), f"denavit diagnose ended with {found.returncode}"
    page = (folder / "found" / "report.html").read_text(encoding="utf-8")
    for text in ("Rivals: effects that would do in its place", "The separating experiment"):
        assert text in page, f"the page has no `{text}`"


if __name__ == "__main__":
    main()
