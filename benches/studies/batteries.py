"""The blind battery and the foreign bench as studies: a case is an index.

    export PYTHONPATH=benches/studies
    python -m denavit study run blind.json --ray auto -o blind.parquet
    python benches/studies/batteries.py blind.parquet

The study files name ``batteries:blind`` or ``batteries:foreign`` and, as files, the programs: those
in ``target/release`` of the repository, and for the foreign bench ``foreign/generator``, its folder,
and ``foreign/venv``, an environment as benches/foreign/run makes. The key of a study has their
content: rows of another build are another study. The second command prints the figures of a Parquet
file as Markdown, for docs/evidence.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from denavit import studies
from denavit.errors import Error, Fault
from denavit.studies.content import digest_of_path
from scipy.special import betaincinv

FOREIGN = Path(__file__).parents[1] / "foreign"


def _build(path: str) -> str:
    """Which build answered."""
    return digest_of_path(path)[:12]


def _run(command: list[str], **more: Any) -> str:
    """What a program prints; one that fails is a row that says so."""
    done = subprocess.run(command, capture_output=True, text=True, **more)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no words"])[-1]
        cause = f"ended with {done.returncode}: {last}"
        raise Error([Fault(command[0], None, None, cause, None)])
    return done.stdout


def _answered(found: dict[str, Any]) -> dict[str, Any]:
    """What a diagnosis says, for a row."""
    effects = found.get("effects") or []
    gap = (found.get("gap") or {}).get("validate") or {}
    return {
        "verdict": found.get("verdict"),
        "named": [f"{one['effect']} at {one['at']}" for one in effects],
        "log_odds": [float(one["log_odds"]) for one in effects],
        "before": gap.get("before"),
        "after": gap.get("after"),
        "floor": gap.get("floor"),
    }


@studies.rows(
    number=int,
    robot=str,
    strength=str,
    kind=str,
    hidden=list[str],
    is_right=bool,
    verdict=str,
    named=list[str],
    log_odds=list[float],
    before=float,
    after=float,
    floor=float,
    build=str,
)
def blind(case: studies.Case) -> studies.Row:
    """A case of the blind battery. Files: ``battery`` and ``denavit``, the programs. Option:
    ``first``, the number of index 0.
    """
    battery, denavit = case.files["battery"], case.files["denavit"]
    number = int(case.options["first"]) + case.index
    with tempfile.TemporaryDirectory() as inside:
        command = [battery, "--case", str(number), "--out", inside, "--diagnose", denavit]
        said = _run(command)
        folder = Path(inside) / str(number)
        answer = json.loads((folder / "answer.json").read_text())
        found = json.loads((folder / "said.json").read_text())
    hidden = [f"{one['name']} at {', '.join(one['joints'])}" for one in answer["effects"]]
    return {
        "number": number,
        "robot": answer["robot"],
        "strength": answer["strength"],
        "kind": answer["kind"],
        "hidden": hidden,
        "is_right": said.strip().endswith(": right"),
        "build": _build(denavit),
    } | _answered(found)


@studies.rows(
    name=str,
    robot=str,
    strength=str,
    kind=str,
    hidden=list[str],
    counted=list[str],
    closed=list[float],
    errors=list[float],
    verdict=str,
    named=list[str],
    log_odds=list[float],
    before=float,
    after=float,
    floor=float,
    build=str,
)
def foreign(case: studies.Case) -> studies.Row:
    """A case of the foreign bench. Files: ``generator``, its folder; ``denavit``, the command;
    ``venv``, an environment that has MuJoCo and Pinocchio. The seed is that of the study.
    """
    denavit, generator = case.files["denavit"], case.files["generator"]
    with tempfile.TemporaryDirectory() as inside:
        told = {"JOBS": "1", "ONLY": str(case.index), "VENV": case.files["venv"]}
        command = [str(FOREIGN / "run"), generator, str(case.seed), inside, denavit]
        _run(command, env=os.environ | told)
        python = str(Path(case.files["venv"]) / "bin" / "python")
        figures = [python, str(FOREIGN / "figures.py"), "record", generator, inside]
        found = json.loads(_run(figures))
        out = Path(inside)
        truth = json.loads((out / "truth.json").read_text())["cases"]
        (file,) = (out / "answers").glob("*/diagnosis.json")
        name, text = file.parent.name, file.read_text()
    own = truth[name]
    return {
        "name": name,
        "robot": own["robot"],
        "strength": own["strength"],
        "kind": own["kind"],
        "hidden": [f"{one['effect']} at {one['joint']}" for one in own["effects"]],
        # no times: they are others in every run
        "counted": [f"{key}: {hits} of {of}" for key, (hits, of) in found["counts"].items()],
        "closed": [round(share, 6) for share in found["closed"]],
        "errors": [round(error, 6) for error in found["errors"]],
        "build": _build(denavit),
    } | _answered(json.loads(text) if text else {})


def summed(rows: list[dict[str, Any]]) -> list[str]:
    """Lines of a table of Markdown: the counts of all cases of the foreign bench."""
    hits: Counter[str] = Counter()
    counts: Counter[str] = Counter()
    for row in rows:
        for line in row["counted"]:
            name, _, numbers = line.rpartition(": ")
            hit, _, count = numbers.partition(" of ")
            hits[name] += int(hit)
            counts[name] += int(count)
    lines = ["| what | cases | of | interval of 95 % |", "|---|---:|---:|---|"]
    lines += [_line(name, hits[name], count) for name, count in counts.items() if count]
    for name, column in (("share closed", "closed"), ("error over stated error", "errors")):
        numbers = [number for row in rows for number in row[column]]
        if numbers:
            lines += ["", f"Median {name}: {statistics.median(numbers):.2f} of {len(numbers)}."]
    return lines


def _line(name: str, hits: int, count: int) -> str:
    low, high = interval(hits, count)
    return f"| {name} | {hits} | {count} | {100 * low:.0f} to {100 * high:.0f} % |"


def interval(hits: int, count: int) -> tuple[float, float]:
    """Exact interval of 95 % of a share (Clopper, Pearson 1934), as of all other pages."""
    low = float(betaincinv(hits, count - hits + 1, 0.025)) if hits else 0.0
    high = float(betaincinv(hits + 1, count - hits, 0.975)) if hits < count else 1.0
    return low, high


def figures(rows: Iterable[dict[str, Any]], key: str) -> list[str]:
    """Lines of a table of Markdown: how many rows are right, by the values of a column."""
    counts: Counter[str] = Counter()
    right: Counter[str] = Counter()
    for row in rows:
        for name in (str(row[key]), "all"):
            counts[name] += 1
            right[name] += bool(row["is_right"])
    lines = [f"| {key} | right | of | interval of 95 % |", "|---|---:|---:|---|"]
    names = sorted(counts, key=lambda one: (one == "all", one))
    return lines + [_line(name, right[name], counts[name]) for name in names]


def main() -> None:
    """Prints the figures of a Parquet file."""
    rows = studies.read_part(sys.argv[1]).to_pylist()
    failed = [row for row in rows if row["failure"]]
    good = [row for row in rows if not row["failure"]]
    if good and "counted" in good[0]:
        lines = summed(good)
    else:
        lines = figures(good, "kind" if good and "kind" in good[0] else "hidden")
    print("\n".join(lines))
    print(f"\n{len(rows)} rows, {len(failed)} failed")


if __name__ == "__main__":
    main()
