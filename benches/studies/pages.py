"""The page of the project's own studies, made from their Parquet files.

    export PYTHONPATH=benches/studies
    python -m denavit study run benches/studies/push.json -o docs/evidence/studies/push.parquet
    python benches/studies/pages.py [--check]

Writes docs/evidence/studies.md of the Parquet files in docs/evidence/studies; `--check` says whether
it is what they make. Each study is described by the JSON file of its name beside this script.
"""

from __future__ import annotations

import statistics
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import batteries
from denavit import studies

HERE = Path(__file__).parent
EVIDENCE = HERE.parents[1] / "docs" / "evidence"
Rows = list[dict[str, Any]]


def coverage(rows: Rows) -> list[str]:
    """How many intervals hold the true values, and how long deviations are."""
    hits = sum(row["inside"] for row in rows)
    count = sum(row["identified"] for row in rows)
    largest = statistics.median(row["largest_deviation"] for row in rows)
    low, high = batteries.interval(hits, count)
    return [
        "| parameters of all seeds | inside their interval of 95 % | share | by chance |",
        "|---:|---:|---:|---|",
        f"| {count} | {hits} | {100 * hits / count:.1f} % | {100 * low:.1f} to {100 * high:.1f} % |",
        "",
        f"The largest deviation of a seed is {largest:.2f} standard errors in the median.",
    ]


def basin(rows: Rows) -> list[str]:
    """Which starts walk on."""
    outcomes = Counter(row["outcome"] for row in rows)
    lines = ["| outcome | starts |", "|---|---:|"]
    lines += [f"| {name} | {count} |" for name, count in sorted(outcomes.items())]
    walks = sum(row["walks"] for row in rows)
    low, high = batteries.interval(walks, len(rows))
    share = f"{100 * low:.0f} to {100 * high:.0f} %"
    return [*lines, "", f"{walks} of {len(rows)} starts walk on ({share})."]


def push(rows: Rows) -> list[str]:
    """The least pushes over the time in the step."""
    names = rows[0]["directions"]
    head = " | ".join(f"{name} [N s]" for name in names)
    lines = [f"| time [s] | {head} |", "|---:|" + "---:|" * len(names)]
    for row in rows:
        least = dict(zip(row["felled"], row["least_ns"]))
        cells = (f"{least[name]:.2f}" if name in least else "none" for name in names)
        lines.append(f"| {row['at_s']:.3f} | {' | '.join(cells)} |")
    return lines


def battery(rows: Rows) -> list[str]:
    """What is hidden, and named."""
    return batteries.figures(rows, "hidden")


def blind(rows: Rows) -> list[str]:
    """Cases by what is hidden, and the effects by how strong they are."""
    numbers = [row["number"] for row in rows]
    hidden = [row for row in rows if row["hidden"]]
    return [
        f"Numbers {min(numbers)} to {max(numbers)}, build {' '.join(builds(rows))}.",
        "",
        *batteries.figures(rows, "kind"),
        "",
        *batteries.figures(hidden, "strength"),
    ]


def foreign(rows: Rows) -> list[str]:
    """What is asked of the foreign bench."""
    return [f"Build {' '.join(builds(rows))}.", "", *batteries.summed(rows)]


def builds(rows: Rows) -> list[str]:
    """Which builds answered."""
    return sorted({row["build"] for row in rows})


SECTIONS: dict[str, tuple[str, str, Callable[[Rows], list[str]]]] = {
    "coverage": (
        "Intervals of identification",
        "The leg of TUlip moves as in section 3.3.3 of the thesis (tables 3.4 to 3.6), with white "
        "noise of positions\n(1e-5 rad) and torques (0.05 N m) of each seed. Its true values are "
        "those of the model. The controller holds its\ntorques for 1 ms, so they stand half a "
        "millisecond late in the log, in which their beginnings are. That biases every\nseed "
        "alike: the log without noise misses viscous friction of the knee by four of these "
        "errors. It is proportional to\nthe time of the hold.",
        coverage,
    ),
    "coverage_fast": (
        "Intervals of identification, with a controller at 10 kHz",
        "The same leg, seeds and noise, but torques are held for 0.1 ms.",
        coverage,
    ),
    "battery": (
        "Effects hidden in simulated arms",
        "Arms of two joints, logs of 5 s, strong effects; a row is right if the surest name and its "
        "joint are, or\nrightly none.",
        battery,
    ),
    "blind": (
        "The blind battery",
        "Arms and legs made without the engine and the catalogue "
        "([what is simulated](battery.md)); `Nothing` has\nnothing hidden.",
        blind,
    ),
    "blind_real": (
        "The blind battery under conditions of real logs",
        "Formats of numbers, irregular stamps, missing rows, unrecorded torques, friction that is "
        "far off\n([conditions](battery-conditions.md)).",
        blind,
    ),
    "foreign": (
        "The foreign bench",
        "Motions and torques of MuJoCo and Pinocchio ([how it is counted](foreign.md)), seed "
        "691.",
        foreign,
    ),
    "push": (
        "Least pushes that fell a gait",
        "The planar biped on its limit cycle, pushed at the hip at twelve times of its step; `none` "
        "where 20 N s do not\nfell it within 4 s.",
        push,
    ),
    "basin": (
        "Starts around a cycle",
        "The compass gait walker down its slope, with noise of 0.05 rad/s in the velocities of its "
        "start; ten steps\ncount as walking on.",
        basin,
    ),
}


def section(name: str) -> list[str]:
    """A study with its figures; nothing where there is no Parquet of it."""
    file = EVIDENCE / "studies" / f"{name}.parquet"
    if not file.is_file():
        return []
    title, says, figures = SECTIONS[name]
    rows = studies.read_part(file).to_pylist()
    good = [row for row in rows if not row["failure"]]
    lines = ["", f"## {title}", "", says, ""]
    lines += figures(good) if good else ["No row has an answer."]
    failed, count = len(rows) - len(good), studies.read_study(HERE / f"{name}.json").count
    told = f"{len(rows)} rows" if len(rows) == count else f"{len(rows)} of {count} rows"
    lines += ["", f"{told}, {failed} without an answer (`benches/studies/{name}.json`)."]
    return lines


def page() -> str:
    """The page."""
    lines = [
        "# Studies of the project",
        "",
        "This page is made by `benches/studies/pages.py` of the [studies](../guide/studies.md)' "
        "Parquet files,",
        "which stand in `docs/evidence/studies`.",
    ]
    for name in SECTIONS:
        lines += section(name)
    return "\n".join(lines) + "\n"


def main() -> None:
    """Writes or checks the page."""
    path, made = EVIDENCE / "studies.md", page()
    if sys.argv[1:] == ["--check"]:
        if not path.is_file() or path.read_text() != made:
            raise SystemExit(f"{path} is not what its Parquet files make: {sys.argv[0]} writes it")
        return
    path.write_text(made)


if __name__ == "__main__":
    main()
