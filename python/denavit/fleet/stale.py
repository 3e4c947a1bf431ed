"""Logs that stood there before: a copy that was uploaded again is no other night."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Seen = dict[str, tuple[str, str]]
"""The robot and night of each log, by its content."""


def without_copies(
    found: Mapping[str, dict[str, Any]], night: str, seen: Seen
) -> dict[str, dict[str, Any]]:
    """The rows of a night, by robot. One whose logs are those of another robot or of an earlier
    night, byte by byte, has no answer: it says nothing of this robot in this night, and counted
    twice it would say that nothing scatters. ``seen`` hears of the logs of this night.
    """
    owners: dict[str, list[str]] = {}
    for robot, row in found.items():
        for content in row["contents"] or ():
            owners.setdefault(content, []).append(robot)
    rows = {}
    for robot, row in found.items():
        first = None
        for content in row["contents"] or ():
            # of two robots in one night nobody knows whose log it is: neither has an answer
            tonight = ((other, night) for other in owners[content] if other != robot)
            first = first or seen.get(content) or next(tonight, None)
        rows[robot] = row if first is None else _silent(row, robot, *first)
    for content, robots in owners.items():
        seen.setdefault(content, (robots[0], night))
    return rows


def _silent(row: Mapping[str, Any], robot: str, other: str, night: str) -> dict[str, Any]:
    whose = night if other == robot else f"{other} in {night}"
    failure = f"{robot}: stale: its logs are those of {whose}, byte by byte"
    return {**dict.fromkeys(row), "index": row["index"], "failure": failure}
