"""The page of a fleet: worst robots first, offline, without scripts."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Collection, Iterable, Sequence
from html import escape
from urllib.parse import quote

from .drift import Drift
from .engine import Fleet, Outcome
from .everyone import Shift, shifts
from .sparkline import Point, sparkline
from .tables import report_name

MOST_WITH_CURVES = 200
"""Robots with curves: a page of more of them is slow to open. Tables have them all."""

VERDICTS = {
    "nothing_missing": "nothing is missing",
    "explained": "explained",
    "partly_explained": "partly explained",
    "unexplained": "not explained",
    "cannot_tell": "the logs cannot tell",
}
"""Verdicts of a diagnosis in words."""

STYLE = """
:root{color-scheme:light dark;--ink:#1b1f24;--quiet:#59636e;--rule:#d8dde3;--ground:#fff;
--stripe:#f6f8fa;--accent:#0b57c4;--good:#1a7f37;--fair:#9a6700;--bad:#c1121f}
@media(prefers-color-scheme:dark){:root{--ink:#e6e9ed;--quiet:#a3adb8;--rule:#363d46;
--ground:#14181d;--stripe:#1b2026;--accent:#6cb0ff;--good:#56d364;--fair:#e3b341;--bad:#ff7b72}}
*{box-sizing:border-box}
body{margin:2rem auto;max-width:75rem;padding:0 1.25rem;color:var(--ink);background:var(--ground);
overflow-wrap:anywhere;font:16px/1.5 system-ui,Helvetica Neue,Arial,DejaVu Sans,sans-serif}
h1{font-size:1.6rem;margin:0 0 .8rem}h2{font-size:1.2rem;margin:2.4rem 0 .6rem}
h3{font-size:1.05rem;margin:0}p{max-width:46rem;margin:.4rem 0}a{color:var(--accent)}
.verdict{padding:.7rem 1rem;max-width:none;font-size:1.1rem;background:var(--stripe);
border-left:.35rem solid var(--good);border-radius:.2rem}
.verdict.bad{border-color:var(--bad)}.quiet{color:var(--quiet);font-size:.9rem}
section{border-top:1px solid var(--rule);padding:.9rem 0}
.badge{font-size:.8rem;font-weight:600;color:var(--quiet);margin-left:.5rem}
.badge.bad{color:var(--bad)}.badge.fair{color:var(--fair)}.badge.good{color:var(--good)}
.curves{display:grid;grid-template-columns:repeat(auto-fill,minmax(9.5rem,1fr));gap:.5rem 1rem}
figure{margin:0}figcaption{font-size:.8rem;color:var(--quiet);line-height:1.3}
figcaption b{color:var(--ink);font-weight:600}figcaption .changed{color:var(--bad)}
svg{width:100%;height:2.6rem;display:block;background:var(--stripe);border-radius:.2rem}
polyline{fill:none;stroke:var(--quiet);stroke-width:1}circle{fill:var(--accent)}
path{stroke:var(--accent);stroke-width:1}
circle.changed{fill:var(--bad)}path.changed{stroke:var(--bad)}
.wide{overflow-x:auto;background:
linear-gradient(90deg,transparent,var(--ground) 60%) right/4rem 100% no-repeat local,
linear-gradient(270deg,color-mix(in srgb,var(--accent) 55%,transparent),transparent)
right/1.2rem 100% no-repeat scroll}table{border-collapse:collapse;font-size:.9rem}
th,td{padding:.2rem .7rem;border-bottom:1px solid var(--rule);text-align:left;white-space:nowrap}
tr>:first-child{position:sticky;left:0;background:var(--ground)}
.number{text-align:right;font-variant-numeric:tabular-nums}tbody th{font-weight:500}
:focus-visible{outline:2px solid var(--accent)}
@media(max-width:40rem){body{margin:1rem auto;padding:0 .8rem}}
""".strip()


def page(fleet: Fleet, drifts: Sequence[Drift]) -> str:
    """The page. Reports of robots lie beside it."""
    robots = _robots(fleet, drifts)
    last = fleet.nights[-1]
    style = base64.b64encode(hashlib.sha256(STYLE.encode()).digest()).decode()
    allowed = f"default-src 'none'; style-src 'sha256-{style}'"
    moved = shifts(fleet)
    is_bad = any(one.standing or one.last.reason for one in robots)
    kind = "verdict bad" if is_bad or any(one.night == last for one in moved) else "verdict"
    among = _count(len(robots), "robot")
    said = f"{escape(last)}: {_said(robots, among)}"
    shown = robots[:MOST_WITH_CURVES]
    more = len(robots) - len(shown)
    rest = f"<p>{_count(more, 'more robot')} {'is' if more == 1 else 'are'} in the table below.</p>"
    rest = rest if more else ""
    sections = "".join(_section(one, fleet) for one in shown)
    return f"""<!doctype html>
<html lang="en" data-ready="yes" data-charts="yes"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{allowed}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Fleet: {among}</title><style>{STYLE}</style></head><body><main>
<h1>Fleet: {among}, {_count(len(fleet.nights), "night")}</h1>
<p class="{kind}">{said}.</p>{_moved(moved)}
<p>Among the alarms of a night, a share of at most {100 * fleet.rate:g} % is expected to be false.
That is the false discovery rate over the whole fleet. A robot is judged by its own earlier nights;
errors have the scatter from night to night.</p>
<h2>Nights</h2>{_nights(fleet)}
<h2>Robots, worst first</h2>
<p class="quiet">Curves show each parameter over the nights with its stated standard error.
Red is changed. Values are in SI units; a residual is the logarithm of its share of the torque.</p>
{sections}{rest}
<h2>All robots</h2>{_list(robots)}
</main></body></html>
"""


def _moved(found: Sequence[Shift]) -> str:
    """What most robots did alike, night by night."""
    if not found:
        return ""
    lines = "".join(f"<li>{escape(one.night)}: {escape(str(one))}</li>" for one in found)
    said = "Most robots moved alike. That is taken off as common, and is an alarm of none of them:"
    return f"<p>{said}</p><ul>{lines}</ul>"


def _said(robots: Sequence[_Robot], among: str) -> str:
    """The newest night in a sentence."""
    alarmed = sum(one.last.is_alarm for one in robots)
    said = [f"{_count(alarmed, 'alarm')} among {among}"]
    for count, what in (
        (sum(one.last.has_log and bool(one.last.reason) for one in robots), "no answer"),
        (sum(not one.last.has_log for one in robots), "no log"),
        (sum(one.standing is not None for one in robots) - alarmed,
         "an alarm from before, and no answer since"),
    ):  # fmt: skip
        if count:
            said.append(f"{count} {'has' if count == 1 else 'have'} {what}")
    return "; ".join(said)


class _Robot:
    """A robot with its nights and drifts."""

    def __init__(
        self,
        name: str,
        outcomes: list[Outcome],
        drifts: list[Drift],
        standing: Outcome | None,
    ) -> None:
        self.name, self.outcomes, self.drifts = name, outcomes, drifts
        self.last, self.standing = outcomes[-1], standing
        self.has_drift = any(one.is_change for one in drifts)

    @property
    def shown(self) -> Outcome:
        """What is reported: the alarm that stands, or the last night."""
        return self.standing or self.last

    @property
    def p(self) -> float:
        return 1.0 if self.shown.judged is None else self.shown.judged.p

    @property
    def state(self) -> tuple[int, str, str]:
        """Rank, kind and words: the worst is first."""
        silent = "no answer" if self.last.has_log else "no log"
        if self.last.is_alarm:
            return 0, "bad", "alarm"
        if self.standing is not None:
            return 0, "bad", f"alarm of {self.standing.night}, {silent} since"
        if self.last.reason:
            return 1, "fair", silent
        if any(one.is_alarm for one in self.outcomes):
            return 2, "fair", "alarm of an earlier night"
        if self.has_drift:
            return 3, "fair", "drift"
        return 4, "good", "no alarm"


def _robots(fleet: Fleet, drifts: Sequence[Drift]) -> list[_Robot]:
    own: dict[str, list[Drift]] = {}
    for one in drifts:
        own.setdefault(one.robot, []).append(one)
    nights: dict[str, list[Outcome]] = {robot: [] for robot in fleet.robots}
    for outcome in fleet.outcomes:
        nights[outcome.robot].append(outcome)
    standing = fleet.standing()
    robots = [
        _Robot(name, nights[name], own.get(name, []), standing.get(name)) for name in fleet.robots
    ]
    return sorted(robots, key=lambda one: (one.state[0], one.p, one.name))


def _nights(fleet: Fleet) -> str:
    rows = []
    for night in fleet.nights:
        own = [one for one in fleet.outcomes if one.night == night]
        told = ((one.has_log, one.is_first, one.is_alarm, one.has_log and bool(one.reason),
                 not one.has_log) for one in own)  # fmt: skip
        rows.append([night, *(str(sum(each)) for each in zip(*told))])
    numbers = ("robots", "without a history", "alarms", "no answer", "no log")
    return _table(["night", *numbers], rows, numbers)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Collection[str]) -> str:
    """A table whose columns of numbers stand on the right."""
    kinds = [' class="number"' if one in numbers else "" for one in head]
    cells = "".join(
        f'<th scope="col"{kind}>{escape(one)}</th>' for one, kind in zip(head, kinds)
    )
    body = "".join(
        f'<tr><th scope="row">{escape(first)}</th>'
        + "".join(f"<td{kind}>{escape(one)}</td>" for one, kind in zip(rest, kinds[1:]))
        + "</tr>"
        for first, *rest in rows
    )
    table = f"<table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"
    return f'<div class="wide" tabindex="0">{table}</div>'


def _section(robot: _Robot, fleet: Fleet) -> str:
    _, kind, words = robot.state
    said = "".join(f"<p>{line}</p>" for line in _lines(robot, fleet))
    return (
        f'<section><h3>{escape(robot.name)}<span class="badge {kind}">{escape(words)}</span></h3>'
        f'{said}<div class="curves">{_curves(robot, fleet)}</div></section>'
    )


def _lines(robot: _Robot, fleet: Fleet) -> list[str]:
    """Sentences on a robot, as HTML."""
    lines = []
    last, first_alarm = robot.shown, next((one for one in robot.outcomes if one.is_alarm), None)
    if first_alarm is not None:
        lines.append(f"Alarm since {escape(first_alarm.night)}.")
    if last.is_alarm and last.diagnosed and last.diagnosed["named"]:
        odds = last.diagnosed["log10_odds"]
        named = "; ".join(escape(_named(one)) for one in last.diagnosed["named"])
        line = f"<b>{named}</b> (odds 10<sup>{odds:.0f}</sup>)."
        if last.diagnosed["rivals"]:
            rivals = (_words(one) for one in last.diagnosed["rivals"])
            line += f" Or {escape(', '.join(rivals))}."
        lines.append(line)
    elif last.is_alarm:
        verdict = VERDICTS.get((last.diagnosed or {}).get("verdict") or "")
        lines.append(f"Nothing is named{f': {verdict}' if verdict else ''}.")
    if last.diagnosed and last.diagnosed["before"] is not None:
        before, after, floor = (100 * last.diagnosed[key] for key in ("before", "after", "floor"))
        named = f"{before:.2f} %, {after:.2f} % with what is named"
        lines.append(f"Torque mismatch {named}, {floor:.2f} % of noise.")
    if robot.last.reason:
        lines.append(f"{escape(robot.last.night)}: {escape(robot.last.reason)}")
    steps = [one for one in robot.drifts if one.is_change and one.since is not None]
    if steps:
        told = (f"{escape(one.name)} since {escape(fleet.nights[one.since or 0])}" for one in steps)
        lines.append(f"Change points: {', '.join(told)}.")
    pages = [(one.night, name) for one in robot.outcomes if (name := report_name(one))]
    links = (f'<a href="{escape(quote(name))}">{escape(night)}</a>' for night, name in pages)
    return [*lines, f"Reports: {', '.join(links)}."] if pages else lines


def _curves(robot: _Robot, fleet: Fleet) -> str:
    places = {night: at for at, night in enumerate(fleet.nights)}
    series: dict[str, list[Point]] = {}
    for one in robot.outcomes:
        marked = () if one.judged is None else one.judged.changed
        for name, value in one.values.items():
            point = Point(places[one.night], value.value, value.std or 0.0, name in marked)
            series.setdefault(name, []).append(point)
    units = {name: unit for one in robot.outcomes for name, unit in one.units.items()}
    drifts = {one.name: one for one in robot.drifts}
    return "".join(
        _figure(name, points, units.get(name, ""), drifts.get(name), len(fleet.nights))
        for name, points in series.items()
    )


def _figure(
    name: str, points: list[Point], unit: str, drift: Drift | None, nights: int
) -> str:
    last = points[-1]
    said = f"{last.value:.4g}" + (f" &#177; {last.error:.1g}" if last.error else "")
    kind = ' class="changed"' if last.is_changed else ""
    slope = ""
    if drift is not None:
        slope = f"<br>{drift.slope:+.2g} &#177; {drift.slope_error:.1g} a night"
    label = f"{name} over {nights} nights"
    return (
        f"<figure>{sparkline(points, nights, label)}<figcaption><b{kind}>{escape(name)}</b> "
        f"{said} {escape(unit)}{slope}</figcaption></figure>"
    )


def _list(robots: Sequence[_Robot]) -> str:
    rows = []
    for one in robots:
        found, judged = one.shown.diagnosed or {}, one.shown.judged
        nights = [each.night for each in one.outcomes if each.has_log]
        rows.append([
            one.name, one.state[2], nights[-1],
            "" if judged is None else f"{judged.p:.2g}",
            "" if judged is None else f"{judged.adjusted:.2g}",
            VERDICTS.get(found.get("verdict") or "", ""), _words(found.get("effect") or ""),
            found.get("joint") or "",
        ])  # fmt: skip
    numbers = ("p", "false discovery rate")
    head = ["robot", "state", "last log", *numbers, "diagnosis", "effect", "at"]
    return _table(head, rows, numbers)


def _words(name: str) -> str:
    """A name of the catalogue, at a joint perhaps, as words."""
    effect, at, joint = name.partition(" at ")
    return effect.replace("_", " ") + at + joint


def _named(told: str) -> str:
    """An effect with its values."""
    name, colon, values = told.partition(": ")
    return _words(name) + colon + values.replace("+-", "\u00b1")


def _count(count: int, word: str) -> str:
    return f"{count} {word}" if count == 1 else f"{count} {word}s"
