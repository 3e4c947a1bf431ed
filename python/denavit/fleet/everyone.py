"""Nights in which most robots moved alike: that is taken off as common, and alarms none of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from statistics import median

from .changes import Judged
from .engine import Fleet

LARGE, UNUSUAL = 8.0, 4.0
"""A common move is reported that is so many times the error of a robot, and so many times as large
as moves of this fleet are. The weather of a hall moves it by less. Chosen on simulated fleets:
3 of 100 quiet ones have such a night."""

Key = tuple[str, str]
"""A group of robots, and a parameter."""


@dataclass(frozen=True)
class Shift:
    """What half of the robots of a group, or more, did in a night."""

    night: str
    name: str
    value: float
    ratio: float
    """Its size over the error of one robot's change."""
    robots: int

    def __str__(self) -> str:
        moved = f"half or more of {self.robots} robots: {self.name} moved by {self.value:.3g}"
        return f"{moved}, {self.ratio:.0f} times the error of one robot"


def shifts(fleet: Fleet) -> list[Shift]:
    """Large moves of the whole fleet, by night, and the largest first."""
    errors: dict[Key, list[float]] = defaultdict(list)
    usual: dict[Key, list[float]] = defaultdict(list)
    found = []
    for night in fleet.nights:
        verdicts = fleet.verdicts.get(night)
        if verdicts is None:
            continue
        tonight: dict[Key, list[float]] = defaultdict(list)
        for robot, judged in verdicts.robots.items():
            for name, error in _errors(judged):
                tonight[fleet.histories[robot].group, name].append(error)
        own = []
        for key, own_errors in tonight.items():
            common = verdicts.common.get(key, 0.0)
            errors[key].append(median(own_errors))
            # where only some robots moved the errors of tonight have what they did
            error = min(errors[key])
            before = usual[key]
            # the median deviation of normal values is their standard deviation over 1.4826
            weather = 1.4826 * median(map(abs, before)) if before else 0.0
            if abs(common) > max(LARGE * error, UNUSUAL * weather) and error > 0:
                ratio = abs(common) / error
                own.append(Shift(night, key[1], common, ratio, len(own_errors)))
            usual[key].append(common)
        found += sorted(own, key=lambda one: (-one.ratio, one.name))
    return found


def _errors(judged: Judged) -> Iterator[tuple[str, float]]:
    return ((one.name, one.error) for one in judged.changes)
