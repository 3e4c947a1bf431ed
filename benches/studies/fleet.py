"""A fleet on a cluster of Ray of two nodes on this machine: what is found, and what survives.

    python benches/studies/fleet.py [--robots 50] [--nights 4] [--changed 6] [--out DIR]

Needs the package with its extra `ray`. Simulates a fleet in which some robots acquire an effect in
the third night. Judges it on two nodes; then again, while a worker is killed in the middle, then
the second node, and then the process that drives the fleet, each by its process id, and it is
started anew. Compares all files byte by byte, and the alarms with what was hidden.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import pyarrow.parquet as pq
from cluster import PORT, cluster, workers

FILES = ("fleet.parquet", "parameters.parquet", "drift.parquet", "index.html")


def command(folder: Path, out: Path, diagnose: str) -> list[str]:
    """The command that judges the fleet on the cluster."""
    found = [sys.executable, "-m", "denavit", "fleet", str(folder / "logs")]
    found += ["--model-by", str(folder / "arm.json"), "-o", str(out), "--diagnose", diagnose]
    return [*found, "--ray", f"127.0.0.1:{PORT}"]


def noted(out: Path) -> int:
    """How many rows are kept: those of whole parts, and of journals."""
    rows = sum(int(pq.read_metadata(path).num_rows) for path in (out / "rows").glob("*.parquet"))
    for path in (out / "rows").glob("*.rows"):
        rows += max(0, path.read_text().count("\n") - 1)
    return rows


def until(condition: Callable[[], bool]) -> None:
    """Waits."""
    began = time.monotonic()
    while not condition():
        assert time.monotonic() - began < 1200, "nothing happens"
        time.sleep(0.05)


def disturbed(run: list[str], out: Path, second: int, most: int) -> None:
    """Kills a worker, a node and the driver, a quarter of the rows apart; starts anew."""
    process = subprocess.Popen(run, stdout=subprocess.DEVNULL)
    until(lambda: noted(out) >= most // 4 and bool(workers()))
    victim = workers()[0]
    os.kill(victim, signal.SIGKILL)
    until(lambda: noted(out) >= most // 2)
    os.kill(second, signal.SIGKILL)
    until(lambda: noted(out) >= 3 * most // 4)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = noted(out)
    print(f"killed worker {victim}, node {second}, driver {process.pid} at {kept} of {most} rows")
    subprocess.run(run, stdout=subprocess.DEVNULL, check=False)


def contents(out: Path) -> dict[str, bytes]:
    """All that was written for readers."""
    pages = sorted((out / "reports").glob("*"))
    return {path.name: path.read_bytes() for path in [*(out / name for name in FILES), *pages]}


def judged(folder: Path, out: Path) -> None:
    """Compares alarms with what was hidden."""
    answer = json.loads((folder / "answer.json").read_text())
    rows = pq.read_table(out / "fleet.parquet").to_pylist()
    named, alarmed, false = set(), set(), set()
    for row in rows:
        hidden = answer.get(row["robot"])
        is_there = hidden is not None and row["night"] >= hidden["since"]
        if row["is_alarm"] and is_there:
            alarmed.add(row["robot"])
            if (row["effect"], row["joint"]) == (hidden["effect"], hidden["at"]):
                named.add(row["robot"])
        elif row["is_alarm"]:
            false.add(row["robot"])
    others = len({row["robot"] for row in rows}) - len(answer)
    print(f"alarmed {len(alarmed)} of {len(answer)}, named with joint {len(named)}")
    print(f"false alarms: {len(false)} of {others} other robots, in any night")
    for row in rows:
        if row["is_alarm"]:
            odds = row["log10_odds"]
            told = row["robot"], row["night"], row["effect"], row["joint"], row["value"]
            print(" ", *told, f"p {row['p']:.1e}", f"odds 10^{odds or 0:.0f}")


def main() -> None:
    """Prints what was found; a difference is an error."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, default in (("robots", 50), ("nights", 4), ("changed", 6), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--diagnose", default="all")
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as inside:
        folder = given.out or Path(inside)
        made = [sys.executable, "-m", "denavit", "fleet-example", str(folder)]
        for name in ("robots", "nights", "changed", "seed"):
            made += [f"--{name}", str(getattr(given, name))]
        began = time.monotonic()
        subprocess.run(made, check=True)
        print(f"simulated in {time.monotonic() - began:.1f} s", flush=True)
        outs = [folder / name for name in ("undisturbed", "disturbed")]
        try:
            second = cluster()
            began = time.monotonic()
            run = command(folder, outs[0], given.diagnose)
            subprocess.run(run, stdout=subprocess.DEVNULL, check=False)
            print(f"undisturbed: {time.monotonic() - began:.1f} s", flush=True)
            judged(folder, outs[0])
            began, most = time.monotonic(), noted(outs[0])
            disturbed(command(folder, outs[1], given.diagnose), outs[1], second, most)
            print(f"disturbed: {time.monotonic() - began:.1f} s", flush=True)
        finally:
            ray = str(Path(sys.executable).with_name("ray"))
            subprocess.run([ray, "stop", "--force"], stdout=subprocess.DEVNULL, check=False)
        first, other = (contents(out) for out in outs)
        assert first.keys() == other.keys() and first == other, "files differ"
        print(f"{len(first)} files: the same bytes")


if __name__ == "__main__":
    main()
