"""Pages of files whose names and words are script and markup.

    python tests/pages/hostile.py DENAVIT FOLDER

Writes FOLDER/hostile_*.html: of a run, a model, an identification and a diagnosis. check.py opens
them, and finds whether anything of that was run or became an element.
"""

import json
import subprocess
import sys
from pathlib import Path

ATTACK = "</script><script>window.hit = 1</script><img src=x onerror='window.hit = 1'><!--{{7*7}}"
# names of files have no slash
FILE = "<img src=x onerror=window.hit=1>&lt;{{7*7}}.csv"


def rod(damping):
    joint = {"type": "revolute", "a": 0.5}
    if damping:
        joint["damping"] = damping
    return {
        "format": "denavit-model/1", "name": "rod", "description": ATTACK, "source": ATTACK,
        "assumptions": [ATTACK], "convention": "standard", "gravity": [0, -9.81, 0],
        "constants": {"l": {"value": 0.5, "unit": "m", "doc": ATTACK}},
        "links": [{
            "name": "rod", "joint": joint,
            "limits": {"position": [-1.4, 1.4], "velocity": 4, "acceleration": 20,
                       "torque": [-60, 60]},
            "body": {"mass": 2, "com": [-0.2, 0, 0], "about": "com",
                     "inertia": {"xx": 0.001, "yy": 0.05, "zz": 0.05, "xy": 0, "xz": 0, "yz": 0}},
        }],
    }


def scenario(model, phase):
    fourier = {"frequencies_rad_s": [1.3, 2.9], "offset": 0.0, "sines": [0.4 * phase, 0.15],
               "cosines": [0.0, 0.1 * phase]}
    return {
        "format": "denavit-scenario/1", "name": "rod", "description": ATTACK, "model": model,
        "duration_s": 12, "initial": {"on_reference": True},
        "control": {"period_s": 0.001, "compensation": "gravity",
                    "joints": {"rod": {"kp": 400, "kd": 12, "reference": {"fourier": fourier}}}},
        "measurement": {"resolution": 1e-5, "logged": True, "torque_noise": 0.02},
    }


def main():
    denavit, folder = sys.argv[1], Path(sys.argv[2])
    inside = folder / "hostile"
    inside.mkdir(parents=True, exist_ok=True)

    def run(*words, codes=(0,)):
        done = subprocess.run([denavit, *words], cwd=inside, stdout=subprocess.DEVNULL, check=False)
        assert done.returncode in codes, (words, done.returncode)

    files = {"rod": rod(None), "truth": rod(0.5), "train": scenario("truth.json", 1.0),
             "validate": scenario("truth.json", 0.7)}
    for name, content in files.items():
        (inside / f"{name}.json").write_text(json.dumps(content), encoding="utf-8")
    run("simulate", "train.json", "-o", FILE)
    run("simulate", "validate.json", "--beside", FILE, "-o", "v" + FILE,
        "--html", "../hostile_run.html")
    run("inspect", "rod.json", "--html", "../hostile_model.html")
    # a comment of the log is a header that pages may show
    log = inside / FILE
    log.write_text(f"# note: {ATTACK}\n" + log.read_text(encoding="utf-8"), encoding="utf-8")
    run("identify", "rod.json", "--train", FILE, "--validate", "v" + FILE, "--html",
        "../hostile_found.html", codes=(0, 1))
    run("diagnose", "rod.json", "--train", FILE, "--validate", "v" + FILE, "--out", "found",
        codes=(0, 1))
    (inside / "found" / "report.html").rename(folder / "hostile_diagnosis.html")


if __name__ == "__main__":
    main()
