"""``python -m denavit fleet`` and ``fleet-example``."""

from __future__ import annotations

import argparse
import json
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .._progress import ProgressLine
from ..studies.here import Runner, in_process, in_processes
from ..studies.on_ray import connected, on_ray, ray_package
from .engine import Fleet, Options, Outcome
from .everyone import shifts
from .mapping import check_columns
from .sources import FleetError, fault


def count(text: str) -> int:
    """How many processes."""
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of processes, 1 or more")
    return int(text)


def add(commands: Any) -> None:
    """Adds the commands of fleets."""
    fleet = commands.add_parser("fleet", help="judge every robot in every night")
    fleet.add_argument("logs", metavar="LOGS", help="a folder, a URI, or a manifest")
    fleet.add_argument("--model-by", type=Path, required=True, metavar="FILE",
                       help="a model, its shipped name, or JSON of robots and models")  # fmt: skip
    fleet.add_argument("-o", "--output", type=Path, required=True, help="folder of the answers")
    fleet.add_argument("--columns", type=Path, metavar="MAP", help="map of the columns of logs")
    fleet.add_argument("--restart", action="append", default=[], metavar="ROBOT=NIGHT",
                       help="the history of a robot begins anew, as after a repair")  # fmt: skip
    _judging(fleet)
    fleet.set_defaults(run=_fleet)

    example = commands.add_parser("fleet-example", help="simulate a fleet, with hidden effects")
    example.add_argument("output", type=Path, metavar="OUT", help="folder of logs and model")
    for name, default in (("robots", 12), ("nights", 4), ("changed", 2), ("since", 3), ("seed", 1)):
        example.add_argument(f"--{name}", type=int, default=default, metavar="N",
                             help=f"{default} if it is left out")  # fmt: skip
    example.add_argument("--run", action="store_true", dest="judges",
                         help="judge it, too; its alarms are meant, and no failure")  # fmt: skip
    _judging(example)
    example.set_defaults(run=_example)


def _judging(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--false-alarms", type=float, default=0.05, metavar="SHARE",
                        help="expected share of false alarms among alarms: 0.05")  # fmt: skip
    parser.add_argument("--diagnose", choices=("all", "alarms", "none"), default="all",
                        help="which robots are diagnosed: all")  # fmt: skip
    parser.add_argument("--reports", choices=("all", "alarms"), default="alarms",
                        help="which diagnoses get a page: those of alarms")  # fmt: skip
    parser.add_argument("--open", action="store_true", help="show the page in a browser")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", type=count, default=1, metavar="N", help="processes, here")
    where.add_argument("--ray", nargs="?", const="local", metavar="ADDRESS",
                       help="on Ray: of this address, `auto`, or started here")  # fmt: skip


@contextmanager
def _runner(given: argparse.Namespace) -> Iterator[Runner]:
    if given.ray is not None:
        with connected(None if given.ray == "local" else given.ray):
            yield on_ray()
    else:
        yield in_process if given.workers == 1 else in_processes(given.workers)


def _fleet(given: argparse.Namespace) -> int:
    restart: dict[str, list[str]] = {}
    faults = []
    for one in given.restart:
        robot, equals, night = one.rpartition("=")
        restart.setdefault(robot, []).append(night)
        if not (robot and equals and night):
            faults.append(fault("--restart", f"{one!r} is not ROBOT=NIGHT"))
    columns = None
    if given.columns is not None:
        try:
            columns = json.loads(given.columns.read_bytes())
            if columns is None:
                raise ValueError("it is null")
            check_columns(columns, str(given.columns))
        except (OSError, ValueError) as error:
            faults.append(fault(str(given.columns), f"is no map of columns: {error}"))
    if faults:
        raise FleetError(faults)
    options = Options(given.false_alarms, given.diagnose, given.reports, columns, restart)
    return _judged(given, given.logs, given.model_by, given.output, options)


def _judged(
    given: argparse.Namespace, logs: str, models: Path, out: Path, options: Options
) -> int:
    from . import judge

    with ProgressLine() as line, _runner(given) as runner:

        def show(night: str, what: str, done: int, count: int) -> None:
            line.show(f"{night}: {what} {done} of {count}")

        fleet = judge(logs, models, out, runner=runner, options=options, progress=show)
    code = _said(fleet)
    print(out / "index.html")
    if given.open:
        webbrowser.open((out / "index.html").resolve().as_uri())
    return code


def _said(fleet: Fleet) -> int:
    """Prints the newest night; 1 if someone has to look at it."""
    night, standing = fleet.nights[-1], fleet.standing()
    last = [one for one in fleet.outcomes if one.night == night]
    alarms = [one for one in last if one.is_alarm]
    earlier = [one for one in standing.values() if one.night != night]
    silent = [one for one in last if one.reason and one.has_log]
    gone = [one for one in last if not one.has_log]
    count = "1 alarm" if len(alarms) == 1 else f"{len(alarms)} alarms"
    said = [count, f"{len(silent)} without an answer"]
    if gone:
        said.append(f"{len(gone)} without a log")
    if earlier:
        said.append(f"{len(earlier)} of them with an alarm from before")
    print(f"{len(fleet.robots)} robots, {len(fleet.nights)} nights")
    print(f"{night}: {', '.join(said)}")
    for one in sorted(alarms, key=lambda one: (one.judged.p if one.judged else 1.0, one.robot)):
        print(f"  {one.robot}: {_named(one)}")
    for one in earlier:
        print(f"  {one.robot}: {_named(one)}, alarm of {one.night}, no answer since")
    moved = [each for each in shifts(fleet) if each.night == night]
    for each in moved:
        print(f"  {each}: common, and so an alarm of none of them")
    for one in silent + gone:
        first = (one.reason or "").splitlines()[0]
        print(f"  {first}" if first.startswith(f"{one.robot}:") else f"  {one.robot}: {first}")
    return 1 if alarms or silent or gone or moved else 0


def _named(one: Outcome) -> str:
    found = one.diagnosed or {}
    return f"{found['effect']} at {found['joint']}" if found.get("effect") else "nothing named"


def _example(given: argparse.Namespace) -> int:
    from .example import write_example

    if given.judges and given.ray is not None:
        ray_package()  # before anything is written

    with ProgressLine() as line:

        def show(done: int, count: int) -> None:
            line.show(f"simulated {done} of {count}")

        write_example(
            given.output, robots=given.robots, nights=given.nights, changed=given.changed,
            since=given.since, seed=given.seed, progress=show,
        )  # fmt: skip
    logs, model = given.output / "logs", given.output / "arm.json"
    print(f"{logs}: {given.robots} robots, {given.nights} nights; {model}")
    if not given.judges:
        return 0
    options = Options(given.false_alarms, given.diagnose, given.reports)
    _judged(given, str(logs), model, given.output / "found", options)
    return 0
