"""Runs a fleet: night after night, since a night is judged by those that were accepted before.

In a night the robots are independent: they are the indices of studies, which run anywhere. What
follows of all of them (:mod:`.changes`) is computed here.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path
from typing import Any, Literal
from urllib.parse import quote

from ..studies import Study, read_part
from ..studies.cases import Function
from ..studies.here import Runner, in_process
from ..studies.here import run as run_study
from ..studies.content import digest
from .changes import Estimate, History, Judged, Night, Verdicts, judged, less_common
from .mapping import check_columns
from .models import kind_of, read_models, widened
from .night import diagnosed, identified
from .sources import FleetError, RobotNight, fault, read_fleet, refuse_inside
from .stale import Seen, without_copies

Progress = Callable[[str, str, int, int], object]
"""Hears the night, what is done in it, and how many robots of how many are."""


@dataclass(frozen=True)
class Options:
    """How a fleet is judged."""

    rate: float = 0.05
    """The share of false alarms that is expected among the alarms of a night, at most."""
    diagnose: Literal["all", "alarms", "none"] = "all"
    """Which robots are diagnosed. With ``all`` also what a robot lacks in its first night is found,
    which then is no change."""
    reports: Literal["all", "alarms"] = "alarms"
    """Which robots get a page of their diagnosis."""
    columns: Mapping[str, Any] | None = None
    """A map of the columns of logs."""
    restart: Mapping[str, str | Sequence[str]] = field(default_factory=dict)
    """Robots whose history begins anew in a night, or in several, as after a repair."""

    def restarts(self) -> list[tuple[str, str]]:
        """Robots with the nights in which their history begins anew."""
        each = {
            robot: [nights] if isinstance(nights, str) else nights
            for robot, nights in self.restart.items()
        }
        return [(robot, night) for robot, nights in each.items() for night in nights]


@dataclass(frozen=True)
class Outcome:
    """What is known of a robot in a night."""

    robot: str
    night: str
    is_first: bool
    """It has no history yet: what it lacks is no change."""
    identified: Mapping[str, Any]
    diagnosed: Mapping[str, Any] | None
    judged: Judged | None
    values: Night
    units: Mapping[str, str]
    common: Mapping[str, float]
    """What the whole fleet did to these values."""
    has_log: bool = True
    """Whether the robot has logged in this night."""

    @property
    def is_alarm(self) -> bool:
        """Whether it is an alarm of its night."""
        return self.judged is not None and self.judged.is_alarm

    @classmethod
    def without_log(cls, robot: str, night: str, last: str) -> Outcome:
        """Of a robot that had its last log in an earlier night."""
        row = dict.fromkeys(("model", "refused", "mismatch", "trusted", "remarks"))
        why = f"{robot}: no log of {night}; the last one is of {last}"
        told = {**row, "failure": why}
        return cls(robot, night, False, told, None, None, {}, {}, {}, has_log=False)

    @property
    def reason(self) -> str | None:
        """Why there is no answer."""
        said = (
            self.identified["failure"],
            (self.diagnosed or {}).get("failure"),
            # without a model there is no history, and nothing to diagnose
            None if self.identified["model"] else self.identified["refused"],
        )
        return next((one for one in said if one), None)


@dataclass
class Fleet:
    """A fleet with its history."""

    root: str
    nights: list[str]
    robots: list[str]
    rate: float
    outcomes: list[Outcome] = field(default_factory=list)
    histories: dict[str, History] = field(default_factory=dict)
    models: dict[str, str] = field(default_factory=dict)
    """Last accepted models; in the beginning those that were given."""
    verdicts: dict[str, Verdicts] = field(default_factory=dict)
    """By night."""
    seen: Seen = field(default_factory=dict)
    """Logs by their content."""

    def standing(self) -> dict[str, Outcome]:
        """Alarms that stand, by robot: those of the newest night, and earlier ones of robots that
        have no answer since.
        """
        found: dict[str, Outcome] = {}
        for one in self.outcomes:
            if one.is_alarm:
                found[one.robot] = one
            elif one.values:
                found.pop(one.robot, None)
        return found


def run(
    place: str,
    model_by: str | Path,
    out: str | Path,
    *,
    runner: Runner = in_process,
    options: Options | None = None,
    progress: Progress | None = None,
) -> Fleet:
    """Judges every robot in every night. Rows of broken-off runs and of earlier nights, which
    stand in ``out``, are not computed again.
    """
    options = options or Options()
    check_columns(options.columns)
    refuse_inside(place, Path(out))
    root, all_logs = read_fleet(place)
    logged: dict[str, str] = {}
    robots = sorted({one.robot for one in all_logs})
    models = read_models(model_by, robots)
    nights = sorted({one.night for one in all_logs})
    _check(place, robots, nights, options)
    fleet = Fleet(root, nights, robots, options.rate, models=dict(models))
    groups = {robot: digest(kind_of(text).encode())[:16] for robot, text in models.items()}
    for robot in robots:
        fleet.histories[robot] = History(groups[robot])
    for night, logs in groupby(all_logs, key=lambda one: one.night):
        for robot, since in options.restarts():
            if since == night:
                fleet.histories[robot] = History(groups[robot])
                fleet.models[robot] = models[robot]
        own = list(logs)
        _night(fleet, night, own, Stage(Path(out), runner, options, root, progress))
        logged |= {one.robot: night for one in own}
        fleet.outcomes += [
            Outcome.without_log(robot, night, last)
            for robot, last in sorted(logged.items())
            if last != night
        ]
    return fleet


def _check(place: str, robots: list[str], nights: list[str], options: Options) -> None:
    faults = []
    if not 0 < options.rate < 1:
        faults.append(fault("rate", f"{options.rate} is no share between 0 and 1"))
    for robot, night in options.restarts():
        if robot not in robots or night not in nights:
            faults.append(fault(place, f"has no {robot} in {night}, which begins anew"))
    if faults:
        raise FleetError(faults)


@dataclass(frozen=True)
class Stage:
    """Where and how rows of a night are computed."""

    out: Path
    runner: Runner
    options: Options
    root: str
    progress: Progress | None

    def rows(
        self, name: str, night: str, function: Function, given: Sequence[Mapping[str, Any]]
    ) -> list[dict[str, Any]]:
        """A row for each of what is given, from the files of an earlier run if they are there."""
        inputs = {str(at): json.dumps(one).encode() for at, one in enumerate(given)}
        columns = None if self.options.columns is None else dict(self.options.columns)
        chosen = {"root": self.root, "columns": columns}
        study = Study(name, function, len(given), inputs=inputs, options=chosen)
        stem = f"{quote(night, safe='')}-{name}-"
        path = self.out / "rows" / f"{stem}{study.key[:12]}.parquet"

        def show(done: int, count: int) -> None:
            if self.progress is not None:
                self.progress(night, name, done, count)

        run_study(study, path, runner=self.runner, progress=show)
        for old in path.parent.glob(f"{stem}*.parquet"):
            if old != path:
                old.unlink()
        rows: list[dict[str, Any]] = read_part(path).to_pylist()
        return rows


def _night(fleet: Fleet, night: str, logs: list[RobotNight], stage: Stage) -> None:
    first = {one.robot for one in logs if not fleet.histories[one.robot].nights}
    found = without_copies(dict(_identified(fleet, night, logs, stage)), night, fleet.seen)
    values = {robot: estimates(row) for robot, row in found.items()}
    told = {robot: own for robot, own in values.items() if own}
    verdicts = judged(told, fleet.histories, stage.options.rate)
    fleet.verdicts[night] = verdicts
    answers = _diagnosed(fleet, night, logs, found, verdicts, stage)
    found |= _with_effects(night, logs, first, answers, stage)
    for one in logs:
        robot, row = one.robot, found[one.robot]
        own, judgement = estimates(row), verdicts.robots.get(one.robot)
        history = fleet.histories[robot]
        common = {
            name: shift for name in own if (shift := verdicts.common.get((history.group, name)))
        }
        units = dict(zip(row["names"] or (), row["units"] or ()))
        outcome = Outcome(
            robot, night, robot in first, row, answers.get(robot), judgement, own, units, common
        )
        fleet.outcomes.append(outcome)
        if own and row["model"] and not outcome.is_alarm:
            history.nights.append(less_common(own, history.group, verdicts.common))
            fleet.models[robot] = row["model"]


def estimates(row: Mapping[str, Any]) -> dict[str, Estimate]:
    """The values of a night: parameters, and of each joint the logarithm of its residual."""
    if row["failure"]:
        return {}
    found = {
        name: Estimate(value, std)
        for name, value, std in zip(row["names"], row["values"], row["stds"])
    }
    for joint, share in zip(row["joints"], row["residuals"]):
        if share > 0:
            found[f"residual of {joint}"] = Estimate(math.log(share), None)
    return found


def _logs_of(one: RobotNight) -> dict[str, Any]:
    """The logs of a robot-night for a worker; sizes and times make changed logs other studies."""
    logs = [[file.path, file.size, file.changed_ns] for file in (*one.train, *one.validate)]
    return {
        "robot": one.robot,
        "night": one.night,
        "wrong": one.wrong,
        "train": [file.path for file in one.train],
        "validate": [file.path for file in one.validate],
        "files": logs,
    }


def _identified(
    fleet: Fleet, night: str, logs: list[RobotNight], stage: Stage
) -> Iterator[tuple[str, dict[str, Any]]]:
    given = [
        _logs_of(one)
        | {
            "model": fleet.models[one.robot],
            "is_known": bool(fleet.histories[one.robot].nights),
        }
        for one in logs
    ]
    rows = stage.rows("identified", night, identified, given)
    return zip((one.robot for one in logs), rows)


def _diagnosed(
    fleet: Fleet, night: str, logs: list[RobotNight], found: Mapping[str, Mapping[str, Any]],
    verdicts: Verdicts, stage: Stage,
) -> dict[str, dict[str, Any]]:  # fmt: skip
    """Diagnoses: in its first night what a robot's model lacks beyond its values, and later what
    the last accepted model lacks.
    """
    chosen, given = [], []
    for one in logs:
        row, judgement = found[one.robot], verdicts.robots.get(one.robot)
        is_alarm = judgement is not None and judgement.is_alarm
        wanted = stage.options.diagnose == "all" or (
            is_alarm and stage.options.diagnose == "alarms"
        )
        model = row["model"] if judgement is None else fleet.models[one.robot]
        if row["failure"] or not wanted or not model:
            continue
        if judgement is not None:
            own = estimates(row)
            model = widened(
                model,
                {
                    each.name: std * math.sqrt(each.ratio)
                    for each in judgement.changes
                    if (std := own[each.name].std) is not None
                },
            )
        wants_report = is_alarm or stage.options.reports == "all"
        chosen.append(one.robot)
        given.append(_logs_of(one) | {"model": model, "wants_report": wants_report})
    rows = stage.rows("diagnosed", night, diagnosed, given)
    return dict(zip(chosen, rows))


def _with_effects(
    night: str, logs: list[RobotNight], first: set[str], answers: Mapping[str, Mapping[str, Any]],
    stage: Stage,
) -> dict[str, dict[str, Any]]:  # fmt: skip
    """Robots that lack an effect in their first night, identified with it, so that it is no
    change later.
    """
    lacking = [
        one
        for one in logs
        if one.robot in first and answers.get(one.robot, {}).get("completed")
    ]
    given = [
        _logs_of(one) | {"model": answers[one.robot]["completed"], "is_known": False}
        for one in lacking
    ]
    rows = stage.rows("completed", night, identified, given)
    return {
        one.robot: row for one, row in zip(lacking, rows) if not row["failure"] and row["model"]
    }
