"""Logs of a call: files, or columns in memory, which are read as they are."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _arrow, _options
from ._arrays import Array
from ._options import Columns, PathLike
from .errors import Error, Fault, _argument
from .simulate import Run


PARQUET, ARROW = b"PAR1", b"ARROW1"
"""First bytes of files that pyarrow reads, and the compiled part does not."""


@dataclass(frozen=True)
class Table:
    """A log that was read: what its file is called and says of itself, and its columns."""

    name: str
    header: list[tuple[str, str]]
    columns: dict[str, Array]


Log = PathLike | Run | Mapping[str, Any] | Table
"""A log: a file, a run, or a dict (or a data frame) of columns: ``t``, ``q_JOINT``, ``tau_JOINT``
and, if there are any, ``qd_JOINT``, ``f_CONTACT_x|y|z``. A named index of a data frame is a column,
too."""

Logs = Log | list[Log] | tuple[Log, ...]
"""Logs; one alone stands for a list of it."""


def given(**options: Any) -> tuple[list[str], list[Columns]]:
    """Arguments of the command for the logs of each option, and those that are in memory."""
    arguments: list[str] = []
    memory: list[Columns] = []
    for option, logs in options.items():
        is_list = isinstance(logs, (list, tuple))
        all_logs = list(logs) if is_list else [logs]
        if all_logs:
            arguments.append(f"--{option}")
        for at, log in enumerate(all_logs):
            name = f"{option}[{at}]" if is_list else option
            columns = _columns(log)
            if columns is None:
                place = _options.place(log, f"`{name}`")
                log = _table_of(place) or place
                columns = _columns(log)
            if columns is None:
                arguments.append(place)
            else:
                named = [(column, _column(name, column, values)) for column, values in columns]
                # the name stands for what is in memory
                arguments.append(name)
                told = (log.name, log.header) if isinstance(log, Table) else (name, [])
                memory.append((option, at, *told, named))
    return arguments, memory


def _table_of(path: str) -> Table | None:
    """A file of columns that pyarrow reads (Parquet, Arrow), as a table; None of any other file."""
    try:
        with open(path, "rb") if Path(path).is_file() else io.BytesIO() as file:
            magic = file.read(6)
    except OSError:
        return None  # whoever reads it says so
    if magic[:4] != PARQUET and magic != ARROW:
        return None
    pa = _arrow.arrow()
    try:
        table = _arrow.read_table(path, is_parquet=magic != ARROW)
        said = _arrow.header_of(table.schema) + _arrow.left_out(table)
        return Table(path, said, _arrow.columns(table))
    except (pa.ArrowException, OSError, ValueError) as error:
        raise Error([Fault(path, None, None, f"cannot be read: {error}", None)]) from None


def for_workers(**options: Any) -> tuple[list[str], list[Columns]]:
    """The same for processes that run elsewhere: paths of files are whole."""
    arguments, memory = given(**options)
    named = {f"--{option}" for option in options}
    named |= {name for one in memory for name in (one[0], f"{one[0]}[{one[1]}]")}
    return [one if one in named else str(Path(one).resolve()) for one in arguments], memory


def packed(memory: list[Columns]) -> tuple[bytes, list[list[Any]]]:
    """Logs in memory as bytes, and what each is, with the names of its columns."""
    file = io.BytesIO()
    np.savez(file, *(values for one in memory for _, values in one[4]))
    names = [[option, at, log, [name for name, _ in named]] for option, at, log, _, named in memory]
    return file.getvalue(), names


def unpacked(content: bytes, names: list[list[Any]]) -> list[Columns]:
    """Logs as they were packed."""
    with np.load(io.BytesIO(content)) as file:
        values = iter([file[f"arr_{at}"] for at in range(len(file.files))])
    found: list[Columns] = []
    for option, at, log, named in names:
        found.append((option, at, log, [], [(name, next(values)) for name in named]))
    return found


def _columns(log: Any) -> Iterator[tuple[str, Any]] | None:
    """Names and values of what is in memory; None of a file."""
    if isinstance(log, Table):
        return iter(log.columns.items())
    if isinstance(log, Run):
        return zip(log.columns, log.values.T)
    if isinstance(log, Mapping):
        return ((str(name), values) for name, values in log.items())
    if hasattr(log, "columns") and hasattr(log, "to_numpy"):
        return _of_frame(log)
    return None


def _of_frame(frame: Any) -> Iterator[tuple[str, Any]]:
    index = getattr(frame, "index", None)
    name = getattr(index, "name", None)
    if name is not None and name not in frame.columns:
        yield str(name), index
    for column in frame.columns:
        yield str(column), frame[column]


def _column(log: str, name: str, values: Any) -> Array:
    """The numbers of a column, bit by bit; no value is NaN."""
    what = f'`{log}["{name}"]`'
    try:
        array = np.asarray(values)
        if array.dtype.kind == "O":
            array = array.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise _argument(f"{what} is no column of numbers: {error}") from None
    if array.ndim != 1:
        raise _argument(f"{what} has shape {array.shape}", "a column has shape (rows,)")
    if array.dtype.kind not in "fiu":
        raise _argument(
            f"{what} holds {array.dtype} instead of real numbers", "times are seconds"
        )
    return array.astype(np.float64, copy=False)
