"""Identification from one log that is larger than the memory, on one machine or on many.

The head of the log is identified as any log is. That says how the rest is read: pieces of it become
rows, anywhere and in any order, and these are added. Needs pyarrow; ``runner`` may be one of
:mod:`denavit.studies`.

>>> from denavit.long import identify_long
>>> identify_long("arm.json", "year.parquet", head=100_000)  # doctest: +SKIP
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from . import _logs, _options, studies
from ._arrays import Array
from ._arrow import arrow, header_of, refuse_twins
from ._options import Columns, PathLike, Progress
from ._results import answer
from .errors import Error, Fault, _argument
from .identify import Identification, answered_with_model, updated_model
from .model import Model, as_place, load
from .studies.here import Runner, in_process

USUAL_HEAD = 1 << 19
"""Rows of a head by default."""

BATCH = 1 << 16
"""Rows that are read at once."""

FEWEST = 1000
"""Rows of a head, at least."""

NUMBERS = ("int", "uint", "halffloat", "float", "double", "timestamp")
"""Beginnings of the names of types that are numbers here."""


class _Table:
    """Rows of a Parquet file by their numbers."""

    def __init__(self, path: Path) -> None:
        parquet = arrow().parquet
        try:
            path.open("rb").close()
        except OSError as error:
            raise _unread(path, error) from None
        try:
            self.file = parquet.ParquetFile(path)
        except (OSError, ValueError) as error:
            cause = f"cannot be read as Parquet: {error}"
            hint = "tables of pandas and pyarrow write it; `denavit identify --long` reads CSV"
            raise Error([Fault(str(path), None, None, cause, hint)]) from None
        self.path = path
        self.bytes = path.stat().st_size
        self.rows = int(self.file.metadata.num_rows)
        groups = range(self.file.num_row_groups)
        counts = [self.file.metadata.row_group(group).num_rows for group in groups]
        self.ends = np.cumsum(counts, dtype=np.int64)
        self.kinds = {field.name: str(field.type) for field in self.file.schema_arrow}
        self.names = [name for name, kind in self.kinds.items() if kind.startswith(NUMBERS)]
        try:
            refuse_twins(self.file.schema_arrow.names)
        except ValueError as error:
            raise Error([Fault(str(path), None, None, str(error), None)]) from None
        self.header = header_of(self.file.schema_arrow)
        self.epochs: dict[str, int] = {}
        if self.rows == 0:
            raise Error([Fault(str(path), None, None, "has no rows", None)])

    def read(self, start: int, end: int) -> dict[str, Array]:
        """Columns of numbers of rows from ``start`` to before ``end``."""
        first = int(np.searchsorted(self.ends, start, side="right"))
        last = int(np.searchsorted(self.ends, end, side="left"))
        at = int(self.ends[first - 1]) if first else 0
        held: dict[str, list[Array]] = {name: [] for name in self.names}
        groups = list(range(first, last + 1))
        try:
            for batch in self.file.iter_batches(BATCH, row_groups=groups, columns=self.names):
                rows = slice(max(0, start - at), max(0, end - at))
                at += batch.num_rows
                for name in self.names:
                    held[name].append(self._numbers(name, batch.column(name))[rows])
                if at >= end:
                    break
        except OSError as error:
            raise _unread(self.path, error) from None
        return {name: np.concatenate(parts) for name, parts in held.items()}

    def _numbers(self, name: str, column: Any) -> Array:
        """A column as numbers; times as seconds since the first one of the file."""
        if not self.kinds[name].startswith("timestamp"):
            return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)
        nanoseconds = column.cast("timestamp[ns]").cast("int64").to_numpy(zero_copy_only=False)
        if name not in self.epochs:
            group = self.file.read_row_group(0, columns=[name]).column(name)
            if not group[0].is_valid:
                cause = f"has no first time in its column `{name}`"
                raise Error([Fault(str(self.path), None, None, cause, None)])
            self.epochs[name] = int(group[0].cast("timestamp[ns]").cast("int64").as_py())
        return np.asarray((nanoseconds - self.epochs[name]) / 1e9, dtype=np.float64)


def _unread(path: Path, error: OSError) -> studies.PassingError:
    """The exception of a file that cannot be read now: a piece of it is tried again."""
    fault = Fault(str(path), None, None, f"cannot be read: {error}", "check the path and the disk")
    return studies.PassingError([fault])


def _table(path: Path) -> _Table:
    return _opened(path, _stamp(path))


@lru_cache(maxsize=2)
def _opened(path: Path, _: tuple[int, ...]) -> _Table:
    return _Table(path)


def _stamp(path: Path) -> tuple[int, ...]:
    """What changes when another file takes this path."""
    try:
        found = path.stat()
    except OSError as error:
        raise _unread(path, error) from None
    return found.st_size, found.st_mtime_ns


@lru_cache(maxsize=2)
def _model(text: bytes) -> Model:
    return load(json.loads(text))


@studies.rows(rows=str)
def condensed(case: studies.Case) -> studies.Row:
    """The rows of a piece of a long log. Inputs: ``model`` and ``plan``, and ``validate``, columns
    of logs for validation. Options: ``log``, the path of a Parquet file that every worker can read,
    ``arguments`` of the command, and ``judges``, which of them ``validate`` has."""
    plan = json.loads(case.inputs["plan"])
    table = _table(Path(case.options["log"]))
    if table.rows != plan["rows"] or table.bytes != case.options["stamp"][0]:
        cause = f"has {table.rows} rows, and the plan is for {plan['rows']} of another file"
        raise Error([Fault(str(table.path), None, None, cause, None)])
    first, end = plan["stretches_of_pieces"][case.index]
    text = None
    with _options.folder() as inside:
        model = _options.file_of(_model(case.inputs["model"]), "model", inside)
        for name in case.inputs.keys() & {"plan", "columns"}:
            (inside / f"{name}.json").write_bytes(case.inputs[name])
        judges = _logs.unpacked(case.inputs["validate"], case.options["judges"])
        for stretch in range(first, end):
            start, stop = plan["rows_of_stretches"][stretch]
            given, memory = _given(table, start, stop)
            arguments = ["long", "condense", model, *given, *case.options["arguments"]]
            if "columns" in case.inputs:
                arguments += ["--columns", str(inside / "columns.json")]
            arguments += ["--plan", str(inside / "plan.json"), f"--stretch={stretch}"]
            if text is not None:
                (inside / "rows.jsonl").write_text(text)
                arguments += ["--onto", str(inside / "rows.jsonl")]
            text = json.dumps(_options.answered(arguments, None, [*memory, *judges])[0])
    return {"rows": text}


def _given(table: _Table, start: int, end: int) -> tuple[list[str], list[Columns]]:
    """Arguments for rows of a table, and these with a name for messages."""
    arguments, memory = _logs.given(train=table.read(start, end))
    name = f"{table.path.name}, rows {start + 1} to {end}"
    return arguments, [(one[0], one[1], name, table.header, one[4]) for one in memory]


def identify_long(
    model: Model | PathLike,
    log: PathLike,
    validate: _logs.Logs = (),
    *,
    head: int = USUAL_HEAD,
    time: str = "t",
    columns: PathLike | dict[str, Any] | None = None,
    runner: Runner = in_process,
    part: PathLike | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Identification:
    """Identifies base parameters from one log, a Parquet file that may be larger than the memory.

    ``head`` is how many of its rows are identified as any log is, fewer than all; ``time`` the
    column of its times, which ``columns`` maps to ``t`` if it has another name. What the file says
    of itself (``torque_side``, ``model``) counts as in any log. ``validate`` are logs that judge
    the answer; one that is a part of ``log`` is reported, and the answer is no good one then.
    ``runner`` computes the pieces (:func:`denavit.studies.on_ray.on_ray` on many machines, each of
    which reads the file by the same path); ``part`` is where rows of pieces are kept, so that a run
    that was broken off goes on. ``options`` are those of :func:`denavit.identify`: ``method``
    ("ols" or "wls"), ``errors``, ``seed``, ``filter_hz``, ``decimate``, ``derivatives``,
    ``skip_slow``, ``friction``, ``joint_parameters``, ``keep``, ``prior``, ``resolution``,
    ``accept_suspicious``.
    Rows stand at equal distances of time.
    """
    table = _long_table(log, head, time)
    robot = model if isinstance(model, Model) else load(model)
    with _options.folder() as inside:
        effects, place = as_place(robot, inside)
        arguments = [*effects, *_arguments(options, head)]
        judged, judges = _logs.for_workers(validate=validate)
        packed, names = _logs.packed(judges)
        arguments += judged
        inputs = {"model": robot.source.encode(), "validate": packed}
        mapped: list[str] = []
        if columns is not None:
            mapped = ["--columns", _options.file_of(columns, "columns", inside)]
            inputs["columns"] = Path(mapped[1]).read_bytes()
        of_head, memory = _given(table, 0, min(head, table.rows))
        end = float(table.read(table.rows - 1, table.rows)[time][0])
        planned = [place, *of_head, *mapped, *arguments]
        of_whole = [f"--rows={table.rows}", f"--end={end!r}"]
        memory += judges
        plan, _, _ = _options.answered(["long", "plan", *planned, *of_whole], progress, memory)
        inputs["plan"] = json.dumps(plan).encode()
        given = {
            "log": str(table.path),
            "stamp": list(_stamp(table.path)),
            "arguments": arguments,
            "judges": names,
            "judge_stamps": [_stamp(Path(one)) for one in judged if Path(one).exists()],
        }
        study = studies.Study("long", condensed, plan["pieces"], inputs=inputs, options=given)
        (inside / "plan.json").write_bytes(inputs["plan"])
        with open(inside / "rows.jsonl", "w", encoding="utf-8") as file:
            for row in _computed(study, runner, part, progress):
                file.write(row["rows"] + "\n")
        estimating = ["long", "estimate", *planned, "--plan", str(inside / "plan.json")]
        estimating += ["--rows", str(inside / "rows.jsonl")]
        out = inside / "updated.json"
        found, refused = answered_with_model(estimating, out, progress, memory)
        updated = None if refused else updated_model(out, robot)
    return answer(Identification, found, updated=updated, update_refused=refused)


def _long_table(log: PathLike, head: int, time: str) -> _Table:
    """The log, which is longer than its head."""
    if isinstance(head, bool) or not isinstance(head, int) or head < FEWEST:
        raise _argument(f"`head` is {head!r}", f"a number of rows, {FEWEST} or more")
    table = _table(Path(_options.place(log, "`log`")).resolve())
    if table.rows <= head:
        cause = f"its {table.rows} rows are no more than those of its head, {head}"
        hint = "denavit.identify holds a log as a whole; or choose a smaller `head`"
        raise Error([Fault(str(table.path), None, None, cause, hint)])
    if time not in table.names:
        kind = table.kinds.get(time)
        typed = f": it is of type {kind}" if kind else ""
        cause = f"`{table.path.name}` has no column of numbers `{time}`{typed}"
        raise _argument(cause, "`time` names it")
    return table


OPTIONS = (
    "method", "errors", "seed", "keep", "friction", "skip_slow", "filter_hz", "decimate",
    "derivatives", "prior", "resolution", "accept_suspicious", "joint_parameters",
)  # fmt: skip
"""Options of identification that a long log has, too."""


def _arguments(options: dict[str, Any], head: int) -> list[str]:
    """Options of :func:`denavit.identify` as arguments of the command."""
    flags = {"filter_hz": "filter", "joint_parameters": "with"}
    unknown = sorted(options.keys() - set(OPTIONS))
    if unknown:
        raise TypeError(f"identify_long() has no option {', '.join(unknown)}")
    named = {flags.get(name, name): value for name, value in options.items()}
    return _options.flags(**named, head=head)


def _computed(
    study: studies.Study, runner: Runner, part: PathLike | None, progress: Progress | None
) -> Iterator[studies.Row]:
    """Rows of all pieces in their order."""
    with tempfile.TemporaryDirectory(prefix="denavit-") as inside:
        kept = Path(inside) / "rows.parquet"
        if part is not None:
            kept = Path(_options.place(part, "`part`"))

        def told(done: int, count: int) -> None:
            if progress is not None:
                progress("reading the log piece by piece", done / count)

        studies.run(study, kept, runner=runner, progress=told)
        for row in studies.read_part(kept).to_pylist():
            if row["failure"]:
                raise Error([Fault(str(study.options["log"]), None, None, row["failure"], None)])
            yield row
