"""What most robots do alike in a night is taken off as common, and told where it is large."""

import dataclasses

import numpy as np
import pytest

from denavit.fleet.changes import Estimate, History, judged, less_common
from denavit.fleet.command import _said
from denavit.fleet.engine import Fleet, Outcome
from denavit.fleet.everyone import shifts
from denavit.fleet.page import page

pytest.importorskip("scipy")

NIGHTS = [f"2026-01-0{night}" for night in range(1, 7)]


def simulated(seed, share=0.0, since=5, size=15.0, robots=20):
    """A fleet of numbers in a hall whose weather is twice the scatter of a robot, as in the
    example. A share of the robots moves by so many of these in a night, and stays there.
    """
    random = np.random.default_rng(seed)
    names = [f"r{at:02}" for at in range(robots)]
    fleet = Fleet("", NIGHTS, names, 0.05)
    fleet.histories = {name: History("arm") for name in names}
    true = random.normal(size=(robots, 6))
    for at, night in enumerate(NIGHTS, start=1):
        values = true + 0.02 * random.normal(size=6) + 0.01 * random.normal(size=true.shape)
        if at >= since:
            values[: int(share * robots), 0] += size * 0.01
        tonight = {
            name: {f"p{at}": Estimate(value, 0.005) for at, value in enumerate(own)}
            for name, own in zip(names, values)
        }
        fleet.verdicts[night] = verdicts = judged(tonight, fleet.histories, 0.05)
        for name in names:
            if name not in verdicts.robots or not verdicts.robots[name].is_alarm:
                less = less_common(tonight[name], "arm", verdicts.common)
                fleet.histories[name].nights.append(less)
    return fleet


def test_the_weather_of_a_hall_is_not_told():
    assert sum(bool(shifts(simulated(seed))) for seed in range(20)) <= 1


@pytest.mark.parametrize("share", [0.7, 1.0])
def test_what_most_robots_do_is_told(share, capsys):
    told = 0
    for seed in range(5):
        own = [(one.night, one.name) for one in shifts(simulated(seed, share, size=40.0))]
        told += (NIGHTS[4], "p0") in own
        assert all(name == "p0" for _, name in own)
    assert told == 5
    fleet = simulated(0, share, since=6, size=40.0)
    assert _said(fleet) == 1
    said = capsys.readouterr().out
    assert "half or more of 20 robots: p0 moved by 0." in said and "an alarm of none" in said
    silent = [Outcome.without_log(one, NIGHTS[5], NIGHTS[4]) for one in fleet.robots]
    fleet.outcomes = [dataclasses.replace(one, has_log=True) for one in silent]
    text = page(fleet, [])
    assert f"<li>{NIGHTS[5]}: half or more of 20 robots: p0 moved by 0." in text
