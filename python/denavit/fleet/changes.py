"""Which robots changed tonight: their parameters against those of their own earlier nights.

A parameter's change is tonight's value less the mean of the nights that were accepted. Its error
has the stated standard errors, widened by the scatter from night to night (:mod:`.scatter`). What
the whole fleet does in a night (a cold hall) is taken off: the median change of the other robots.
A robot has one p-value, and the false discovery rate is that of robots.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from .._arrays import Array
from .distributions import two_sided
from .scatter import Ratios, Scatter, fitted
from .testing import adjusted, combined

FEWEST_OTHERS = 10
"""A median of fewer robots is moved by one that changed."""


@dataclass(frozen=True)
class Estimate:
    """A value of a night; without a standard error where none is stated."""

    value: float
    std: float | None


Night = Mapping[str, Estimate]
"""The values of a robot in a night, by parameter."""


@dataclass
class History:
    """The nights of a robot that were accepted, less what the whole fleet did in them."""

    group: str
    """Robots of the same group have the same parameters, whatever their values."""
    nights: list[Night] = field(default_factory=list)

    def mean(self, name: str) -> tuple[float, float, float, int]:
        """Mean of a parameter, its variance, and the variance ratio with its degrees of freedom."""
        known = [night[name] for night in self.nights if name in night]
        if not known:
            return 0.0, math.inf, 1.0, -1
        weights = np.array([1 / variance(one) for one in known])
        values = np.array([one.value for one in known])
        mean = float(weights @ values / weights.sum())
        degrees = len(known) - 1
        ratio = float(weights @ (values - mean) ** 2) / degrees if degrees else 1.0
        return mean, float(1 / weights.sum()), ratio, degrees


def variance(one: Estimate) -> float:
    """Of the stated error; 1 where none is stated, so that the scatter alone is its scale."""
    return 1.0 if one.std is None else one.std**2


@dataclass(frozen=True)
class Change:
    """The change of a parameter of a robot in a night."""

    name: str
    change: float
    error: float
    """Its standard error, with the scatter from night to night."""
    p: float
    ratio: float
    """That scatter: variances over those of the stated errors."""


@dataclass(frozen=True)
class Judged:
    """What a night says of a robot."""

    p: float
    """That nothing changed."""
    adjusted: float
    """The least false discovery rate at which the robot is an alarm."""
    is_alarm: bool
    changes: tuple[Change, ...]
    changed: tuple[str, ...]
    """Names of the parameters that changed, of an alarm."""


@dataclass(frozen=True)
class Verdicts:
    """What a night says of the fleet."""

    robots: Mapping[str, Judged]
    common: Mapping[tuple[str, str], float]
    """What the whole fleet did, by group and parameter."""
    scatter: Mapping[tuple[str, str], Scatter]


def judged(
    tonight: Mapping[str, Night], histories: Mapping[str, History], rate: float
) -> Verdicts:
    """Judges all robots that have a history. ``rate`` bounds the share of false alarms."""
    tested: dict[tuple[str, str], list[str]] = defaultdict(list)
    robots = sorted(robot for robot in tonight if histories[robot].nights)
    for robot in robots:
        for name in tonight[robot]:
            if histories[robot].mean(name)[3] >= 0:
                tested[histories[robot].group, name].append(robot)
    keys = sorted(tested)
    moves = [
        _moved(
            [tonight[robot][name] for robot in tested[group, name]],
            [histories[robot].mean(name) for robot in tested[group, name]],
        )
        for group, name in keys
    ]
    by_key = dict(zip(keys, moves))
    scatter = _scatter(by_key)
    # where a robot stands among those of a parameter
    places: dict[str, dict[tuple[str, str], int]] = {robot: {} for robot in robots}
    for key in keys:
        for at, robot in enumerate(tested[key]):
            places[robot][key] = at
    groups = Counter(histories[robot].group for robot in robots)
    changes: dict[str, list[Change]] = {}
    for robot, own in places.items():
        fits = scatter
        if groups[histories[robot].group] <= FEWEST_OTHERS:
            fits = _scatter({key: by_key[key] for key in own}, own)
        changes[robot] = [by_key[key].change(key[1], at, fits[key]) for key, at in own.items()]
    common = {key: move.common for key, move in by_key.items()}
    return Verdicts(_alarms(robots, changes, rate), common, scatter)


def _scatter(
    moves: Mapping[tuple[str, str], Moved], without: Mapping[tuple[str, str], int] | None = None
) -> dict[tuple[str, str], Scatter]:
    """The scatter of each parameter; without what one robot did tonight, which has these places:
    among few robots its change would pass for their scatter.
    """
    found: dict[tuple[str, str], Scatter] = {}
    # values and residuals are alike in different ways
    kinds = {key: (key[0], all(move.is_stated)) for key, move in moves.items()}
    for kind in dict.fromkeys(kinds.values()):
        own = [key for key, one in kinds.items() if one == kind]
        # an effect raises the residuals of all joints: robots that changed pass for ones that
        # differ, more than where a value moves alone
        known = [] if kind[1] else [moves[key].known() for key in own]
        fits = fitted([moves[key].ratios((without or {}).get(key)) for key in own], known)
        found |= zip(own, fits if without is None else [one.beside() for one in fits])
    return found


@dataclass(frozen=True)
class Moved:
    """How a parameter moved in the robots of a group, tonight."""

    is_stated: Sequence[bool]
    """Whether its error is stated."""
    own: Array
    """Variances that are stated for tonight."""
    variances: Array
    """Those of the move."""
    moved: Array
    """Less what all others did."""
    common: float
    """What all did."""
    known_ratios: Array
    """Variance ratios of the nights before."""
    known_degrees: Array

    def ratios(self, without: int | None = None) -> Ratios:
        """All that tells of the scatter: tonight, but for one robot, and the nights before."""
        tonight = self.moved**2 / self.variances
        if without is not None:
            tonight = np.delete(tonight, without)
        ratios, degrees = self.known()
        return (
            np.concatenate([tonight, ratios]), np.concatenate([np.ones(len(tonight)), degrees])
        )  # fmt: skip

    def known(self) -> Ratios:
        """What the nights before tell of it, which were accepted."""
        has = self.known_degrees > 0
        return self.known_ratios[has], self.known_degrees[has]

    def change(self, name: str, at: int, fit: Scatter) -> Change:
        """The change of a robot."""
        own = float(self.known_ratios[at]), float(self.known_degrees[at])
        moved, variance = float(self.moved[at]), float(self.variances[at])
        p, expected = 0.0, 0.0
        for weight, ratio, degrees in of_robot(fit, *own, self.is_stated[at]):
            error = math.sqrt(ratio * variance)
            p += weight * two_sided(moved / error if error > 0 else 0.0, degrees)
            expected += weight * ratio
        error = math.sqrt(expected * variance)
        return Change(name, moved, error, min(1.0, p), expected)


def of_robot(
    fit: Scatter, own: float, degrees: float, is_stated: bool
) -> list[tuple[float, float, float]]:
    """The scatter of a robot: weights, variance ratios and degrees of freedom. Stated errors are a
    floor: values that agree by chance make nothing surer. Where none are stated there is no floor,
    and the fleet's scatter alone counts.
    """
    if not is_stated:
        return fit.of_robot(0.0, 0.0)
    found = fit.of_robot(own, degrees)
    return [(weight, max(1.0, ratio), degrees) for weight, ratio, degrees in found]


def _moved(
    tonight: Sequence[Estimate], means: Sequence[tuple[float, float, float, int]]
) -> Moved:
    own = np.array([variance(one) for one in tonight])
    raw = np.array([one.value for one in tonight]) - [mean for mean, *_ in means]
    shifts, common = _shifts(raw)
    variances = own + [known for _, known, *_ in means]
    if len(raw) > FEWEST_OTHERS:
        # the median of normal variables has pi/2 times the variance of their mean
        variances = variances * (1 + math.pi / 2 / (len(raw) - 1))
    return Moved(
        [one.std is not None for one in tonight],
        own,
        variances,
        raw - shifts,
        common,
        np.array([ratio for _, _, ratio, _ in means]),
        np.array([float(degrees) for *_, degrees in means]),
    )


def _shifts(raw: Array) -> tuple[Array, float]:
    """The median of the others for each, and of all."""
    if len(raw) <= FEWEST_OTHERS:
        return np.zeros(len(raw)), 0.0
    ordered = np.sort(raw)
    places = np.argsort(np.argsort(raw, kind="stable"), kind="stable")
    rest = len(raw) - 1
    low, high = (rest - 1) // 2, rest // 2
    # the order without one of it
    lower = np.where(places <= low, ordered[low + 1], ordered[low])
    upper = np.where(places <= high, ordered[high + 1], ordered[high])
    return (lower + upper) / 2, float(np.median(raw))


def _alarms(
    robots: Sequence[str], changes: Mapping[str, list[Change]], rate: float
) -> dict[str, Judged]:
    values = np.array([combined(np.array([one.p for one in changes[robot]])) for robot in robots])
    rates = adjusted(values)
    count = int((rates <= rate).sum())
    found = {}
    for robot, p, least in zip(robots, values, rates):
        own, is_alarm = changes[robot], bool(least <= rate)
        changed: tuple[str, ...] = ()
        if is_alarm:
            # parameters of the chosen robots, by Benjamini and Bogomolov (2014)
            within = adjusted(np.array([one.p for one in own])) <= rate * count / len(robots)
            changed = tuple(one.name for one, is_one in zip(own, within) if is_one)
        found[robot] = Judged(float(p), float(least), is_alarm, tuple(own), changed)
    return found


def less_common(night: Night, group: str, common: Mapping[tuple[str, str], float]) -> Night:
    """A night's values without what the whole fleet did in it."""
    return {
        name: Estimate(one.value - common.get((group, name), 0.0), one.std)
        for name, one in night.items()
    }


def names_of(nights: Iterable[Night]) -> list[str]:
    """All parameters of some nights, in their order."""
    return list(dict.fromkeys(name for night in nights for name in night))
