"""A cluster of Ray of two nodes on this machine: the same rows whatever dies, and what it costs.

    python benches/studies/cluster.py [--cases 40] [--seconds 1.0 | --battery] [--no-single]

Needs the package with its extra `ray`. Starts a head and a second node, runs a study undisturbed,
then again while a worker is killed and then the second node, each by its process id, and compares
the files byte by byte. Then measures overhead and speed-up: the same cases in this process, on one
core of Ray and on two. With `--battery` cases hide effects in simulated arms, and diagnose them.
`--no-single` leaves out the runs on one core.
"""

from __future__ import annotations

import argparse
import os
import secrets
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from denavit import studies
from denavit.studies.here import in_process
from denavit.studies.on_ray import on_ray

PORT = 6399


@studies.rows(value=float, pid=int)
def busy(case: studies.Case) -> studies.Row:
    """Keeps a core busy for so many seconds of its own time."""
    until = time.process_time() + case.options["seconds"]
    random = case.random()
    value = float(random.uniform())
    while time.process_time() < until:
        random.uniform(size=1000).sum()
    return {"value": value, "pid": os.getpid() if case.options.get("tells_pid") else None}


def started(*arguments: str) -> None:
    """Starts a node."""
    ray = Path(sys.executable).with_name("ray")
    command = [str(ray), "start", *arguments, "--num-cpus=1"]
    command += ["--disable-usage-stats", "--object-store-memory=100000000"]
    command += ["--node-ip-address=127.0.0.1"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def cluster() -> int:
    """Starts a head and a second node; the process id of the second one's raylet."""
    # a token of this cluster alone, which its nodes and drivers inherit: the head listens to all
    os.environ["RAY_AUTH_MODE"] = "token"
    os.environ["RAY_AUTH_TOKEN"] = secrets.token_hex(32)
    started("--head", f"--port={PORT}", "--include-dashboard=false")
    before = raylets()
    started(f"--address=127.0.0.1:{PORT}")
    (second,) = raylets() - before
    return second


def raylets() -> set[int]:
    """Process ids of the nodes that run here."""
    found = subprocess.run(["pgrep", "-x", "raylet"], capture_output=True, text=True)
    return {int(line) for line in found.stdout.split()}


def workers() -> list[int]:
    """Process ids of what computes a row now."""
    found = subprocess.run(["pgrep", "-f", "^ray::_row"], capture_output=True, text=True)
    return [int(line) for line in found.stdout.split()]


def killed_in_the_middle(second: int, seconds: float) -> None:
    """Kills a worker, then a node, as soon as rows are computed."""
    while not workers():
        time.sleep(0.05)
    time.sleep(seconds)
    victim = workers()[:1]
    for pid in victim:
        os.kill(pid, signal.SIGKILL)
    time.sleep(3 * seconds)
    os.kill(second, signal.SIGKILL)
    print(f"killed worker {victim} and node {second}")


def timed(study: studies.Study, folder: Path, name: str, runner: studies.here.Runner) -> float:
    """Seconds of a run, which has to be a new one."""
    began = time.monotonic()
    assert studies.run(study, folder / name, runner=runner) == study.count
    return time.monotonic() - began


def main() -> None:
    """Prints what was found; a difference is an error."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--battery", action="store_true")
    parser.add_argument("--no-single", action="store_true")
    given = parser.parse_args()
    options = {"seconds": given.seconds}
    study = studies.Study("busy", busy, given.cases, seed=1, options=options)
    if given.battery:
        study = studies.Study("battery", studies.ready.battery, given.cases, seed=1)
    # workers import the study's function from here
    paths = [str(Path(__file__).parent), os.environ.get("PYTHONPATH")]
    os.environ["PYTHONPATH"] = os.pathsep.join(path for path in paths if path)
    with tempfile.TemporaryDirectory() as inside:
        folder = Path(inside)
        took = measured(study, folder, given.seconds, has_single=not given.no_single)
        if given.battery:
            rows = studies.read_part(folder / "two.parquet").to_pylist()
            print(f"{sum(row['is_right'] for row in rows)} of {len(rows)} right")
        contents = {(folder / f"{name}.parquet").read_bytes() for name in took}
    assert len(contents) == 1, "rows differ"
    kind = "a battery" if given.battery else f"{given.seconds} s"
    print(f"{given.cases} cases of {kind}: the same bytes in all {len(took)} runs")
    print(f"two cores {took['two']:.1f} s, disturbed {took['disturbed']:.1f} s")
    if not given.no_single:
        here, one = took["here"], took["one"]
        share, each = 100 * (one / here - 1), 1000 * (one - here) / given.cases
        print(f"here {here:.1f} s, one core of Ray {one:.1f} s: {share:.1f} % more")
        print(f"that is {each:.1f} ms a case")
        print(f"two cores are {here / took['two']:.2f} times as fast")


def measured(
    study: studies.Study, folder: Path, seconds: float, has_single: bool
) -> dict[str, float]:
    """Seconds of each run."""
    took = {}
    if has_single:
        took["here"] = timed(study, folder, "here.parquet", in_process)
    try:
        second = cluster()
        runner = on_ray(f"127.0.0.1:{PORT}")
        took["two"] = timed(study, folder, "two.parquet", runner)
        killer = threading.Thread(target=killed_in_the_middle, args=(second, seconds))
        killer.start()
        took["disturbed"] = timed(study, folder, "disturbed.parquet", runner)
        killer.join()
        if has_single:
            took["one"] = timed(study, folder, "one.parquet", runner)
    finally:
        ray = str(Path(sys.executable).with_name("ray"))
        subprocess.run([ray, "stop", "--force"], stdout=subprocess.DEVNULL)
    return took


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    # the function is of a module that workers can import, not of `__main__`
    import cluster as itself

    itself.main()
