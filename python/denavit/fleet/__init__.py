"""Fleets: every robot in every night, identified against its own history and diagnosed.

A robot is judged by its own earlier nights, and the share of false alarms by the whole fleet. Runs
on one machine or on Ray, as studies do. Needs pyarrow.
"""

from __future__ import annotations

from pathlib import Path

from ..studies.here import Runner, in_process
from .engine import Fleet, Options, Outcome, Progress, run
from .example import write_example
from .files import write_whole
from .page import page
from .sources import FleetError
from .tables import drifts, report_name, write_tables

__all__ = ["Fleet", "FleetError", "Options", "Outcome", "judge", "write_example"]


def judge(
    place: str | Path,
    model_by: str | Path,
    out: str | Path,
    *,
    runner: Runner = in_process,
    options: Options | None = None,
    progress: Progress | None = None,
) -> Fleet:
    """Judges a fleet and writes ``fleet.parquet``, ``parameters.parquet``, ``drift.parquet``, the
    page ``index.html`` and ``reports/`` into the folder ``out``.

    ``place`` is a folder of logs, a URI of one in object storage, or a manifest; ``model_by`` a
    model, or JSON of patterns of robots and their models. Nights that an earlier call left in
    ``out`` are not computed again.
    """
    out = Path(out)
    fleet = run(
        str(place), model_by, out, runner=runner, options=options, progress=progress
    )
    found = drifts(fleet)
    for one in fleet.outcomes:
        name = report_name(one)
        if name is not None and one.diagnosed is not None:
            write_whole(out / name, one.diagnosed["report"])
    write_tables(fleet, found, out)
    write_whole(out / "index.html", page(fleet, found))
    return fleet
