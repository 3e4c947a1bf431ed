"""A parameter of a robot over the nights, as a small picture."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass

WIDTH, HEIGHT, EDGE = 150.0, 40.0, 5.0


@dataclass(frozen=True)
class Point:
    """A value in a night."""

    place: int
    """Which of the nights, from 0."""
    value: float
    error: float
    is_changed: bool


def sparkline(points: Sequence[Point], nights: int, label: str) -> str:
    """An inline SVG: values with their stated errors, changed ones marked."""
    low = min(one.value - one.error for one in points)
    high = max(one.value + one.error for one in points)
    span = high - low

    def x(one: Point) -> str:
        share = one.place / (nights - 1) if nights > 1 else 0.5
        return f"{EDGE + share * (WIDTH - 2 * EDGE):.1f}"

    def y(value: float) -> str:
        share = (value - low) / span if span > 0 else 0.5
        return f"{HEIGHT - EDGE - share * (HEIGHT - 2 * EDGE):.1f}"

    line = " ".join(f"{x(one)},{y(one.value)}" for one in points)
    marks = []
    for one in points:
        kind = ' class="changed"' if one.is_changed else ""
        ends = y(one.value - one.error), y(one.value + one.error)
        marks.append(f'<path d="M{x(one)} {ends[0]}V{ends[1]}"{kind}/>')
        marks.append(f'<circle cx="{x(one)}" cy="{y(one.value)}" r="2.2"{kind}/>')
    return (
        f'<svg viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{html.escape(label)}">'
        f'<polyline points="{line}"/>{"".join(marks)}</svg>'
    )
