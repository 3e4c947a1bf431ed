"""One log that is larger than the memory: time and peak memory over its length.

    python benches/studies/long.py DENAVIT [--rows 1000000 3000000 30000000] [--parquet] [--ray 2]

Writes logs of an arm of two joints at 1 kHz (CSV for the command, Parquet for Python), identifies
each piece by piece in a process of its own, and prints seconds and the largest memory of that
process, as the kernel counted it. `--ray N` identifies the shortest log on Ray as well, and
compares the answers byte by byte.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow
import pyarrow.parquet as parquet

import denavit
from denavit.fleet import example

BLOCK = 250_000
WAVES = ((0.31, 0.57, 0.83), (0.41, 0.67, 1.03))
PYTHON = """
import json, resource, sys, time
from denavit.fleet import example
from denavit.long import identify_long
began = time.monotonic()
found = identify_long(example.NOMINAL, sys.argv[1], head=int(sys.argv[2]))
print(json.dumps(found.json, sort_keys=True))
"""


def block(model: denavit.Model, start: int, rows: int) -> dict[str, np.ndarray]:
    """Rows of the log from one on: sums of sines, torques with noise of their own block."""
    random = np.random.default_rng([7, start])
    t = 1e-3 * np.arange(start, start + rows)
    q, qd, qdd = (np.zeros((rows, 2)) for _ in range(3))
    for joint, waves in enumerate(WAVES):
        for hz, size in zip(waves, (0.6, 0.3, 0.2)):
            w = 2 * np.pi * hz
            q[:, joint] += size * np.sin(w * t + joint)
            qd[:, joint] += size * w * np.cos(w * t + joint)
            qdd[:, joint] -= size * w * w * np.sin(w * t + joint)
    tau = model.inverse_dynamics(q, qd, qdd) + 0.05 * random.standard_normal(q.shape)
    columns = {"t": t}
    for joint, name in enumerate(example.JOINTS):
        columns[f"q_{name}"] = q[:, joint] + 1e-5 * random.standard_normal(rows)
        columns[f"tau_{name}"] = tau[:, joint]
    return columns


def write(path: Path, rows: int) -> None:
    """A log, as text or as Parquet by the ending of its name, a block at a time."""
    model = denavit.load(example.NOMINAL)
    writer = None
    with open(path, "wb") as file:
        for start in range(0, rows, BLOCK):
            columns = block(model, start, min(BLOCK, rows - start))
            if path.suffix == ".parquet":
                table = pyarrow.table(columns)
                writer = writer or parquet.ParquetWriter(file, table.schema)
                writer.write_table(table)
                continue
            if start == 0:
                file.write((",".join(columns) + "\n").encode())
            np.savetxt(file, np.column_stack(list(columns.values())), "%.9g", ",")
        if writer is not None:
            writer.close()


def measured(command: list[str]) -> tuple[bytes, float, float, float]:
    """What a command printed, seconds by the clock and of the processor, and its memory [MB]."""
    with tempfile.TemporaryFile() as out:
        began = os.times()
        process = subprocess.Popen(command, stdout=out)
        _, status, used = os.wait4(process.pid, 0)
        seconds = os.times().elapsed - began.elapsed
        if os.waitstatus_to_exitcode(status) not in (0, 1):
            raise SystemExit(f"{command[0]} failed")
        out.seek(0)
        return out.read(), seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def main() -> None:
    """Prints a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("denavit")
    parser.add_argument("--rows", type=int, nargs="+", default=[1_000_000, 3_000_000, 30_000_000])
    parser.add_argument("--head", type=int, default=1 << 19)
    parser.add_argument("--parquet", action="store_true")
    parser.add_argument("--ray", type=int, metavar="CORES")
    given = parser.parse_args()
    print("| rows | log | clock | processor | memory |\n|---:|---|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as inside:
        folder = Path(inside)
        model = folder / "arm.json"
        model.write_text(json.dumps(example.NOMINAL))
        answers = {}
        for rows in given.rows:
            log = folder / ("log.parquet" if given.parquet else "log.csv")
            write(log, rows)
            if given.parquet:
                command = [sys.executable, "-c", PYTHON, str(log), str(given.head)]
            else:
                command = [given.denavit, "identify", str(model), "--train", str(log), "--long"]
                command += [f"--head={given.head}", "--json"]
            answers[rows], clock, used, memory = measured(command)
            size = log.stat().st_size / 1e6
            print(f"| {rows:.0e} | {size:.0f} MB | {clock:.1f} s | {used:.1f} s | {memory:.0f} MB |")
            sys.stdout.flush()
        if given.ray and given.parquet:
            on_ray(folder, given, answers[given.rows[0]])


def on_ray(folder: Path, given: argparse.Namespace, alone: bytes) -> None:
    """The shortest log again, in workers of Ray."""
    import ray

    from denavit.long import identify_long
    from denavit.studies.on_ray import on_ray as runner

    ray.init(num_cpus=given.ray, include_dashboard=False)
    log = folder / "log.parquet"
    write(log, given.rows[0])
    found = identify_long(example.NOMINAL, log, head=given.head, runner=runner())
    is_same = json.dumps(found.json, sort_keys=True).encode() == alone.strip()
    print(f"on Ray with {given.ray} cores: {'the same' if is_same else 'OTHER'} bytes")


if __name__ == "__main__":
    main()
