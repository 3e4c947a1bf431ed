"""Parts of a study on disk: rows of a range of indices, as Parquet once they are all there.

While a part is computed its rows stand in a journal beside it, a line each. A process that is
killed loses the row that it was at, and no other: the journal is read again, and its last line
counts only if it is whole. A row that cannot be read now (:class:`.cases.PassingError`) is in no
journal; a file that has such a row says so, and is run again.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from .._arrow import arrow
from ..errors import Error, Fault
from .cases import AGAIN, COLUMN_TYPES, Row, columns_of
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
        """Whether the file is there, with an answer for each index. One of another study or range
        is an error.
        """
        return self.path.exists() and not self._read_again()

    def kept(self) -> dict[int, Row]:
        """Rows of a file in which some are to be computed again: the others."""
        if not self.path.exists():
            return {}
        again = self._read_again()
        rows = read_part(self.path).to_pylist()
        return {row["index"]: row for row in rows if row["index"] not in again}

    def _read_again(self) -> set[int]:
        """Which rows of the file are to be computed again."""
        said = _said(self.path)
        if (said.key, said.start, said.stop) != (self.study.key, self.start, self.stop):
            raise self.other(self.path, said.content)
        return said.again

    def other(self, path: Path, content: dict[str, str] | None) -> StudyError:
        """The exception of a file of another study, or of other indices of it."""
        own, cause = self.study.content, "holds another study, or other indices of it"
        if content is not None and content != own:
            names = sorted(
                name for name in content.keys() | own.keys() if content.get(name) != own.get(name)
            )
            cause = f"holds another study: {' and '.join(names)} changed"
        hint = "name another file, or remove this one: rows of both are not mixed"
        return wrong(path, cause, hint)

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
    head["content"] = part.study.content
    try:
        opened = part.journal.open("a+", encoding="utf-8")
    except OSError as error:
        raise wrong(part.journal, f"cannot be written: {error.strerror}") from None
    with opened as file:
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
                first = json.loads(lines[0])
                read = [json.loads(line) for line in lines[1:]]
            except ValueError as error:
                raise wrong(part.journal, f"is no journal of rows: {error}", hint) from None
            if first != head:
                content = first.get("content") if isinstance(first, dict) else None
                raise part.other(part.journal, content if isinstance(content, dict) else None)
            if not all(_is_row(row, part) for row in read):
                raise wrong(part.journal, "has rows that are not of this study", hint)
            done = {row["index"]: row for row in read}
        file.truncate(len(whole.encode()))
        if not lines:
            file.write(json.dumps(head) + "\n")
            file.flush()
        yield done, file


def noted(file: IO[str], row: Row) -> None:
    """Writes a row into a journal, so that it outlives this process; one that is to be computed
    again is not kept.
    """
    if row.get(AGAIN):
        return
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
    said |= {"count": str(study.count), "content": json.dumps(study.content, sort_keys=True)}
    if again := [str(row["index"]) for row in rows if row.get(AGAIN)]:
        said[AGAIN] = ",".join(again)
    write_table(path, table.replace_schema_metadata(said))


def write_table(path: Path, table: pa.Table) -> None:
    """Writes a table as a whole file, or none."""
    pa = arrow()
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".denavit-", dir=path.parent) as inside:
        new = Path(inside) / "part.parquet"
        pa.parquet.write_table(table, new, compression="zstd", row_group_size=ROWS_A_GROUP)
        os.replace(new, path)


class Said(NamedTuple):
    """What a part says of itself."""

    key: str
    """Of its study."""
    start: int
    stop: int
    again: set[int]
    """Rows that are to be computed again."""
    content: dict[str, str] | None
    """What its study depends on; none in a part of an earlier version."""


def _said(path: Path) -> Said:
    """The study of a part, and its indices."""
    pa = arrow()
    try:
        said = pa.parquet.read_schema(path).metadata or {}
        again = said.get(AGAIN.encode(), b"").decode().split(",")
        unread = {int(index) for index in again if index}
        content = json.loads(said.get(b"content", b"null"))
        known = content if isinstance(content, dict) else None
        key, start, stop = said[b"study"].decode(), int(said[b"start"]), int(said[b"stop"])
        return Said(key, start, stop, unread, known)
    except (pa.ArrowException, OSError, KeyError, ValueError):
        raise wrong(path, "is no part of a study") from None


def extent(path: str | Path) -> tuple[int, int, int | None]:
    """The first index of a part, the one behind its last, and how many its study has: none where a
    part of an earlier version does not say.
    """
    _, start, stop, *_ = _said(Path(path))
    count = (arrow().parquet.read_schema(path).metadata or {}).get(b"count", b"").decode()
    return start, stop, int(count) if count.isdigit() else None


def again(path: str | Path) -> list[int]:
    """Indices of a part whose rows could not be read or computed: its next run computes them."""
    return sorted(_said(Path(path)).again)


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
    """Ranges of indices of a study that no part has, or only one that is to be run again."""
    said = {Path(path): _said(Path(path)) for path in paths}
    for path, one in said.items():
        if one.key != study.key:
            raise wrong(path, f"is no part of the study `{study.name}` as it is now")
    ranges = sorted((one.start, one.stop) for one in said.values() if not one.again)
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
    all_said = [(Path(path), _said(Path(path))) for path in paths]
    parts = [(*one[:3], path) for path, one in all_said]
    if not parts:
        raise wrong(out, "there are no parts to merge")
    key = parts[0][0]
    for other, _, _, path in parts:
        if other != key:
            raise wrong(path, f"is of another study than {parts[0][3]}")
    for path, one in all_said:
        if one.again:
            hint = "run it again: they are computed then"
            raise wrong(path, f"has {len(one.again)} rows that could not be read or computed", hint)
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
