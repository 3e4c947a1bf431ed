"""Parts of a study on disk: rows of a range of indices, as Parquet once they are all there.

While a part is computed its rows stand in a journal beside it, a line each. A process that is
killed loses the row that it was at, and no other: the journal is read again, and its last line
counts only if it is whole.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ..errors import Error, Fault, MissingPackage
from .cases import COLUMN_TYPES, Row, columns_of
from .study import Study

if TYPE_CHECKING:
    import pyarrow as pa  # type: ignore[import-untyped, unused-ignore]

ROWS_A_GROUP = 1 << 16
"""Rows of a row group: the same in every file, so that equal rows are equal bytes."""


class StudyError(Error):
    """A part is of another study, or parts do not fit together."""


def wrong(file: str | Path, cause: str, hint: str | None = None) -> StudyError:
    """The exception of a file."""
    return StudyError([Fault(str(file), None, None, cause, hint)])


def arrow() -> Any:
    """The package pyarrow, which is asked for where it is used."""
    try:
        import pyarrow  # type: ignore[import-untyped, unused-ignore]
        import pyarrow.parquet  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        cause, hint = "pyarrow is not installed", "pip install 'denavit[studies]'"
        raise MissingPackage([Fault(None, None, None, cause, hint)]) from None
    return pyarrow


@dataclass(frozen=True)
class Part:
    """The rows of a range of indices of a study, in a file."""

    study: Study
    start: int
    stop: int
    path: Path

    @property
    def journal(self) -> Path:
        """Where rows stand until all of them are there."""
        return self.path.with_name(self.path.name + ".rows")

    def is_whole(self) -> bool:
        """Whether the file is there. One of another study or range is an error."""
        if not self.path.exists():
            return False
        key, start, stop = _said(self.path)
        if (key, start, stop) != (self.study.key, self.start, self.stop):
            hint = "name another file, or remove this one"
            raise wrong(self.path, "holds another study, or other indices of it", hint)
        return True

    def write(self, rows: Iterable[Row]) -> None:
        """Writes all rows, and ends the journal."""
        write_rows(self.path, self.study, self.start, self.stop, sorted(rows, key=_index))
        self.journal.unlink(missing_ok=True)


@contextmanager
def journal(part: Part) -> Iterator[tuple[dict[int, Row], IO[str]]]:
    """The rows that a broken-off run has left, and where the next ones go. One process at a time
    holds a journal.
    """
    head = {"study": part.study.key, "start": part.start, "stop": part.stop}
    with part.journal.open("a+", encoding="utf-8") as file:
        _locked(file, part.journal)
        file.seek(0)
        try:
            text = file.read()
        except UnicodeDecodeError as error:
            raise wrong(part.journal, f"is no text: {error}", "remove it") from None
        # what stands behind the last end of a line was cut
        whole = text[: text.rfind("\n") + 1]
        lines = whole.splitlines()
        done: dict[int, Row] = {}
        if lines:
            hint = "name another file, or remove this one"
            try:
                is_own = json.loads(lines[0]) == head
                read = [json.loads(line) for line in lines[1:]]
            except ValueError as error:
                raise wrong(part.journal, f"is no journal of rows: {error}", hint) from None
            if not is_own:
                raise wrong(part.journal, "holds another study, or other indices of it", hint)
            if not all(_is_row(row, part) for row in read):
                raise wrong(part.journal, "has rows that are not of this study", hint)
            done = {row["index"]: row for row in read}
        file.truncate(len(whole.encode()))
        if not lines:
            file.write(json.dumps(head) + "\n")
            file.flush()
        yield done, file


def noted(file: IO[str], row: Row) -> None:
    """Writes a row into a journal, so that it outlives this process."""
    file.write(json.dumps(row) + "\n")
    file.flush()
    os.fsync(file.fileno())


def _locked(file: IO[str], path: Path) -> None:
    try:
        import fcntl
    except ImportError:  # pragma: no cover - not on Windows
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise wrong(path, "another process is at this part") from None


def _is_row(row: Any, part: Part) -> bool:
    columns = {"index", "failure", *columns_of(part.study.function)}
    if not isinstance(row, dict) or row.keys() != columns:
        return False
    index = row["index"]
    return type(index) is int and part.start <= index < part.stop


def _index(row: Row) -> int:
    index = row["index"]
    assert isinstance(index, int)
    return index


def schema(study: Study) -> pa.Schema:
    """The columns of a study's rows."""
    pa = arrow()
    # the name that Parquet gives the elements of lists: so a table that was read is written again
    # to the same bytes
    types = {
        "double": pa.float64(),
        "int64": pa.int64(),
        "bool": pa.bool_(),
        "string": pa.string(),
        "list<double>": pa.list_(pa.field("element", pa.float64())),
        "list<string>": pa.list_(pa.field("element", pa.string())),
    }
    own = columns_of(study.function).items()
    fields = [(name, types[COLUMN_TYPES[kind]]) for name, kind in own]
    return pa.schema([("index", pa.int64()), *fields, ("failure", pa.string())])


def write_rows(path: Path, study: Study, start: int, stop: int, rows: list[Row]) -> None:
    """Writes rows as a whole file, or none."""
    pa = arrow()
    table = pa.Table.from_pylist([dict(row) for row in rows], schema=schema(study))
    said = {"study": study.key, "name": study.name, "start": str(start), "stop": str(stop)}
    said["count"] = str(study.count)
    write_table(path, table.replace_schema_metadata(said))


def write_table(path: Path, table: pa.Table) -> None:
    """Writes a table as a whole file, or none."""
    pa = arrow()
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".denavit-", dir=path.parent) as inside:
        new = Path(inside) / "part.parquet"
        pa.parquet.write_table(table, new, compression="zstd", row_group_size=ROWS_A_GROUP)
        os.replace(new, path)


def _said(path: Path) -> tuple[str, int, int]:
    """The study of a part, and its indices."""
    pa = arrow()
    try:
        said = pa.parquet.read_schema(path).metadata or {}
        return said[b"study"].decode(), int(said[b"start"]), int(said[b"stop"])
    except (pa.ArrowException, OSError, KeyError, ValueError):
        raise wrong(path, "is no part of a study") from None


def extent(path: str | Path) -> tuple[int, int, int | None]:
    """The first index of a part, the one behind its last, and how many its study has: none where a
    part of an earlier version does not say.
    """
    _, start, stop = _said(Path(path))
    count = (arrow().parquet.read_schema(path).metadata or {}).get(b"count", b"").decode()
    return start, stop, int(count) if count.isdigit() else None


def read_part(path: str | Path) -> pa.Table:
    """The rows of a part, or of merged parts."""
    path = Path(path)
    _said(path)
    pa = arrow()
    try:
        return pa.parquet.read_table(path)
    except (pa.ArrowException, OSError) as error:
        raise wrong(path, f"is corrupt: {error}", "remove it, and run its range again") from None


def missing(paths: Iterable[str | Path], study: Study) -> list[tuple[int, int]]:
    """Ranges of indices of a study that no part has."""
    said = {Path(path): _said(Path(path)) for path in paths}
    for path, (key, _, _) in said.items():
        if key != study.key:
            raise wrong(path, f"is no part of the study `{study.name}` as it is now")
    ranges = sorted((start, stop) for _, start, stop in said.values())
    found, at, count = [], 0, study.count
    for start, stop in ranges:
        if start > at:
            found.append((at, min(start, count)))
        at = max(at, stop)
    return [*found, (at, count)] if at < count else found


def merge(paths: Iterable[str | Path], out: str | Path) -> int:
    """Writes the rows of all parts of a study as one file, in the order of their indices. Answers
    how many there are.
    """
    pa = arrow()
    parts = [(*_said(Path(path)), Path(path)) for path in paths]
    if not parts:
        raise wrong(out, "there are no parts to merge")
    key = parts[0][0]
    for other, _, _, path in parts:
        if other != key:
            raise wrong(path, f"is of another study than {parts[0][3]}")
    if any(path.resolve() == Path(out).resolve() for *_, path in parts):
        raise wrong(out, "is one of the parts", "name another file")
    parts.sort(key=lambda part: part[1:3])
    for (_, _, stop, path), (_, start, _, following) in zip(parts, parts[1:]):
        if start < stop:
            raise wrong(following, f"has indices that {path} has, too")
        if start > stop:
            raise wrong(following, f"no part has the indices {stop} to {start}", "run them first")
    table = pa.concat_tables([read_part(path) for *_, path in parts])
    said = dict(pa.parquet.read_schema(parts[0][3]).metadata)
    said |= {b"start": str(parts[0][1]).encode(), b"stop": str(parts[-1][2]).encode()}
    write_table(Path(out), table.combine_chunks().replace_schema_metadata(said))
    rows: int = table.num_rows
    return rows
