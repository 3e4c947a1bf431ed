"""``python -m denavit``: what runs Python. Everything else is the command ``denavit``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ._progress import ProgressLine
from .errors import Error
from .fleet import command


def _range(text: str) -> range:
    start, colon, stop = text.partition(":")
    if not (colon and start.isdigit() and stop.isdigit() and int(start) <= int(stop)):
        raise argparse.ArgumentTypeError(f"{text!r} is no range of indices: 0:1000")
    return range(int(start), int(stop))


def _share(text: str) -> tuple[int, int]:
    part, slash, parts = text.partition("/")
    if not (slash and part.isdigit() and parts.isdigit() and int(part) < int(parts)):
        raise argparse.ArgumentTypeError(f"{text!r} is no part of parts, from 0: 3/100")
    return int(part), int(parts)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("python -m denavit", description=__doc__)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    study = commands.add_parser("study", help="run studies, and merge their parts")
    parts = study.add_subparsers(required=True, metavar="COMMAND")

    run = parts.add_parser("run", help="compute rows of a study")
    run.add_argument("study", type=Path, help="study file")
    run.add_argument("-o", "--output", type=Path, required=True, help="Parquet file of the rows")
    chosen = run.add_mutually_exclusive_group()
    chosen.add_argument("--range", type=_range, metavar="A:B", help="indices from A, below B")
    chosen.add_argument(
        "--part", type=_share, metavar="K/N", help="part K, from 0, of N: for arrays of jobs"
    )
    where = run.add_mutually_exclusive_group()
    where.add_argument(
        "--workers", type=command.count, default=1, metavar="N", help="processes, here"
    )
    where.add_argument(
        "--ray", nargs="?", const="local", metavar="ADDRESS",
        help="on Ray: of this address, `auto` for the cluster that runs here, or started here",
    )  # fmt: skip
    run.set_defaults(run=_run)

    merge = parts.add_parser("merge", help="write the rows of all parts as one file")
    merge.add_argument("parts", type=Path, nargs="+")
    merge.add_argument("-o", "--output", type=Path, required=True, help="Parquet file of all rows")
    merge.set_defaults(run=_merge)

    missing = parts.add_parser("missing", help="say which indices no part has")
    missing.add_argument("study", type=Path, help="study file")
    missing.add_argument("parts", type=Path, nargs="*")
    missing.set_defaults(run=_missing)
    command.add(commands)
    return parser


def _run(given: argparse.Namespace) -> int:
    from . import studies
    from .studies.here import in_process, in_processes
    from .studies.on_ray import on_ray

    study = studies.read_study(given.study)
    indices: range | None = given.range
    if given.part is not None:
        part, parts = given.part
        indices = range(study.count * part // parts, study.count * (part + 1) // parts)
    runner = in_process if given.workers == 1 else in_processes(given.workers)
    if given.ray is not None:
        runner = on_ray(None if given.ray == "local" else given.ray)
    all_rows = study.count if indices is None else len(indices)

    with ProgressLine() as line:

        def show(done: int, count: int) -> None:
            line.show(f"{done} of {count} rows")

        computed = studies.run(study, given.output, indices, runner=runner, progress=show)
    print(f"{given.output}: {all_rows} rows, {computed} computed now")
    left = studies.again(given.output)
    if left:
        said = f"{len(left)} could not be read or computed; the same command does so again"
        print(said, file=sys.stderr)
    failed = _failed(given.output)
    return 1 if all_rows and failed == all_rows else 0


def _failed(part: Path) -> int:
    """How many rows have no answer; says so."""
    from . import studies

    table = studies.read_part(part).select(["index", "failure"])
    failed = [row for row in table.to_pylist() if row["failure"]]
    if failed:
        first = failed[0]
        said = f"{len(failed)} without an answer; the first, of index {first['index']}:"
        print(f"{said} {first['failure']}", file=sys.stderr)
    return len(failed)


def _merge(given: argparse.Namespace) -> int:
    from . import studies

    print(f"{given.output}: {studies.merge(given.parts, given.output)} rows")
    _failed(given.output)
    start, stop, count = studies.extent(given.output)
    if count is None:
        hint = "`study missing STUDY PART ..` says whether the study has others"
        print(f"these are the rows {start} to {stop - 1}; {hint}", file=sys.stderr)
        return 0
    gaps = [(0, start), (stop, count)]
    said = " and ".join(f"{first} to {end - 1}" for first, end in gaps if first < end)
    if said:
        print(f"no part has the rows {said} of the study's {count}", file=sys.stderr)
    return 0


def _missing(given: argparse.Namespace) -> int:
    from . import studies

    found = studies.missing(given.parts, studies.read_study(given.study))
    for start, stop in found:
        print(f"{start}:{stop}")
    return 1 if found else 0


def main(arguments: list[str] | None = None) -> int:
    """Runs a command; 2 where something is wrong with what was given."""
    given = _parser().parse_args(arguments)
    try:
        code: int = given.run(given)
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("stopped. What is computed is kept: the same command goes on", file=sys.stderr)
        return 130
    return code


if __name__ == "__main__":
    sys.exit(main())
