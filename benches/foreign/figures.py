#!/usr/bin/env python3
"""What benches/foreign/run needs beside the generator's own scripts.

figures.py gather GENERATOR OUT CASE..   answers of the command to OUT/results.json, by adapt.py
figures.py figures GENERATOR OUT         what is asked of a run, with exact intervals of 95 %
figures.py record GENERATOR OUT          the same as JSON, for runs that are added up

The score of a case is score.py's own (its verbose lines); counted here are what it does not print:
intervals, answers that nothing is missing, values against their stated errors, and times.
"""
import ast
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

# (effect, parameter) of the command: effect and parameter of the truth, value, its slope
VALUES = {
    ("viscous", "fv"): ("viscous", "fv", lambda x: (x, 1)),
    ("coulomb", "fc"): ("coulomb", "fc", lambda x: (x, 1)),
    ("quadratic_drag", "c"): ("quadratic_drag", "c", lambda x: (x, 1)),
    ("load_friction", "mu"): ("load_dependent_coulomb", "mu", lambda x: (x, 1)),
    ("load_dependent_friction", "mu"): ("load_dependent_coulomb", "mu", lambda x: (x, 1)),
    ("rotor_inertia", "ia"): ("rotor_inertia", "Jr", lambda x: (x, 1)),
    ("spring", "k"): ("joint_spring", "k", lambda x: (x, 1)),
    ("one_sided_spring", "k"): ("one_sided_spring", "k", lambda x: (x, 1)),
    ("one_sided_spring_below", "k"): ("one_sided_spring", "k", lambda x: (x, 1)),
    # the generator pushes the joint; the drive's torque has as much less
    ("torque_offset", "c"): ("torque_offset", "tau0", lambda x: (-x, 1)),
    ("payload", "mass"): ("payload", "mass", lambda x: (x, 1)),
    ("payload_point", "mass"): ("payload", "mass", lambda x: (x, 1)),
    ("joint_zero", "dq"): ("zero_offset", "dq", lambda x: (-x, 1)),
    ("torque_delay", "delay"): ("torque_delay", "delay", lambda x: (-x, 1)),
    ("torque_gain", "g"): ("torque_gain", "gain", lambda x: (1 / (1 + x), 1 / (1 + x) ** 2)),
    ("torque_saturation", "inverse_limit"): ("saturation", "tau_max", lambda x: (1 / x, 1 / x**2)),
    ("play", "gap"): ("backlash", "gap", lambda x: (x, 1)),
}


def interval(hits, count):
    """Exact interval of 95 % (Clopper, Pearson 1934)."""
    def at_most(k, p):
        return sum(math.comb(count, i) * p**i * (1 - p) ** (count - i) for i in range(k + 1))

    def bisect(is_low):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if is_low(middle) else (low, middle)
        return low

    lower = bisect(lambda p: 1 - at_most(hits - 1, p) < 0.025) if hits else 0.0
    upper = bisect(lambda p: at_most(hits, p) > 0.025) if hits < count else 1.0
    return lower, upper


def line(name, hits, count):
    if count:
        low, high = interval(hits, count)
        print(f"{name:48s} {hits:3d} of {count:3d}  {100 * hits / count:5.1f} %"
              f"  ({100 * low:.1f} .. {100 * high:.1f})")


def gather(generator, out, cases):
    sys.path.insert(0, generator)
    import adapt

    # the generator reads the number of a joint, also where most is left at a joint's spring
    with tempfile.TemporaryDirectory() as folder:
        for case in cases:
            read = pathlib.Path(folder, case)
            read.mkdir()
            for name in ("diagnosis.json", "stderr"):
                own = out / "answers" / case / name
                text = own.read_text() if own.exists() else ""
                (read / name).write_text(text.replace('"joint": "spring of ', '"joint": "'))
        results = {case: adapt.read(case, folder) for case in cases}
    (out / "results.json").write_text(json.dumps(results, indent=1) + "\n")


def scored(generator, out):
    """The records of score.py: one for each case with one or two effects that are known."""
    words = [sys.executable, os.path.join(generator, "score.py"), str(out / "truth.json"),
             str(out / "results.json"), "--verbose"]
    text = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    lines = (line for line in text.splitlines() if " truth [" in line and "{" in line)
    return {line.split()[0]: ast.literal_eval("{" + line.rsplit("{", 1)[1]) for line in lines}


def errors_of_values(truth, out):
    """|value - truth| over the stated error, of effects that are there and named."""
    for case, true in truth.items():
        path = out / "answers" / case / "diagnosis.json"
        text = path.read_text() if path.exists() else ""
        for effect in json.loads(text)["effects"] if text.strip() else []:
            joint = effect["at"].split()[0].removeprefix("j")
            for name, entry in effect["parameters"].items():
                known = VALUES.get((effect["effect"], name))
                if known is None or not entry.get("std"):
                    continue
                for hidden in true["effects"]:
                    is_it = hidden["effect"] == known[0] and known[1] in hidden["params"]
                    if is_it and (known[0] == "payload" or str(hidden["joint"]) == joint):
                        value, slope = known[2](entry["value"])
                        wrong = abs(value - hidden["params"][known[1]])
                        yield wrong / (entry["std"] * abs(slope))


def measured(generator, out):
    """Counts (hits, cases) by name, and the numbers whose medians are told."""
    truth = json.loads((out / "truth.json").read_text())["cases"]
    results = json.loads((out / "results.json").read_text())
    records = scored(generator, out)
    counts = {}
    groups = [("strong and medium", ("strong", "medium")),
              ("weak", ("weak",)), ("all", ("strong", "medium", "weak"))]
    for name, strengths in groups:
        these = [record for case, record in records.items() if truth[case]["strength"] in strengths]
        hits = sum(bool(record["top_ej"]) for record in these)
        counts[f"{name}: effect and joint"] = hits, len(these)
    counts["a wrong extra name"] = sum(r["extra"] for r in records.values()), len(records)
    controls = [case for case in truth if truth[case]["kind"] == "none"]

    def is_false(case):
        may = {"unknown"} | ({"inertial_mismatch"} if truth[case]["variant"] == "perturbed" else set())
        return any(effect["effect"] not in may for effect in results[case]["effects"])

    counts["nothing hidden: a name"] = sum(map(is_false, controls)), len(controls)
    clean = [case for case in controls if results[case].get("verdict") == "nothing_missing"]
    counts["nothing hidden: nothing missing, it says"] = len(clean), len(controls)
    outside = [case for case in truth if truth[case]["kind"] == "outside"]
    unnamed = [case for case in outside
               if all(effect["effect"] == "unknown" for effect in results[case]["effects"])]
    counts["outside the catalogue: refused or unnamed"] = len(unnamed), len(outside)
    errors = list(errors_of_values(truth, out))
    counts["values within 3 stated errors"] = sum(error <= 3 for error in errors), len(errors)
    closed = [record["cl"] for record in records.values() if record["cl"] is not None]
    paths = [out / "answers" / case / "seconds" for case in truth]
    seconds = sorted(float(path.read_text()) for path in paths if path.exists())
    return {"counts": counts, "closed": closed, "errors": errors, "seconds": seconds}


def figures(generator, out):
    found = measured(generator, out)
    for name, (hits, count) in found["counts"].items():
        line(name, hits, count)
    if found["closed"]:
        print(f"median share closed                              "
              f"{statistics.median(found['closed']):.3f}")
    if found["errors"]:
        print(f"median of error over stated error                "
              f"{statistics.median(found['errors']):.2f}")
    if found["seconds"]:
        print(f"seconds a case                                   median "
              f"{statistics.median(found['seconds']):.1f}, most {found['seconds'][-1]:.1f}")


if __name__ == "__main__":
    what, generator, out, *cases = sys.argv[1:]
    if what == "gather":
        gather(generator, pathlib.Path(out), cases)
    elif what == "record":
        print(json.dumps(measured(generator, pathlib.Path(out))))
    else:
        figures(generator, pathlib.Path(out))
