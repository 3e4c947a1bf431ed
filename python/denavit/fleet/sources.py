"""Where the logs of a fleet are: a folder, a table of logs, or a place in object storage."""

from __future__ import annotations

import hashlib
import io
import re
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any

from .. import _logs
from .._arrow import arrow, columns, header_of, left_out, read_table, refuse_twins
from ..errors import Error, Fault
from ..studies.cases import PassingError

BLOCK = 1 << 22
"""Bytes that are read at once."""

KINDS = (".csv", ".parquet", ".mcap")
"""Endings of logs in a folder."""

ReadLog = str | _logs.Table
"""A log as the use cases take it: a path, or a table."""


class FleetError(Error):
    """What was given as a fleet is none."""


class UnreadError(FleetError, PassingError):
    """A log cannot be read now: the network, or a disk. The next run reads it again."""


def fault(place: str, cause: str, hint: str | None = None) -> Fault:
    """One thing that is wrong with a file."""
    return Fault(place, None, None, cause, hint)


@dataclass(frozen=True)
class File:
    """A log, by its path below the root of the fleet, and what tells whether it was changed."""

    path: str
    size: int
    changed_ns: int


@dataclass(frozen=True)
class RobotNight:
    """The logs of a robot in a night. Without one for validation the only log is cut in two."""

    robot: str
    night: str
    train: tuple[File, ...]
    validate: tuple[File, ...] = ()
    wrong: str | None = None
    """Why these logs have no answer, whatever is in them: one is missing, as after an upload that
    broke off."""


def opened(place: str) -> tuple[Any, str]:
    """The file system of a place, and the path there. A place is a path, or a URI."""
    fs = _fs()
    if re.match(r"[a-z][a-z0-9+.-]+://", place):
        try:
            system, path = fs.FileSystem.from_uri(place)
        except (arrow().ArrowException, ValueError) as error:
            hint = "s3://bucket/folder?region=.., or a path"
            raise FleetError([fault(place, f"is no place of logs: {error}", hint)]) from None
        except OSError as error:
            raise unread(place, error) from None
        return system, path
    return fs.LocalFileSystem(), str(Path(place).resolve())


def _fs() -> Any:
    arrow()
    import pyarrow.fs  # type: ignore[import-untyped, unused-ignore]

    return pyarrow.fs


def read_fleet(place: str) -> tuple[str, list[RobotNight]]:
    """The root of a fleet's logs and its robot-nights, sorted. ``place`` is a folder with logs as
    ``ROBOT/NIGHT.csv`` or ``ROBOT/NIGHT/train*.csv`` and ``validate*.csv``, or a manifest: a table
    with the columns ``robot``, ``night``, ``train`` and, if it is wanted, ``validate``.
    """
    system, path = opened(place)
    pa = arrow()
    try:
        info = system.get_file_info(path)
    except (pa.ArrowException, OSError) as error:
        raise FleetError([fault(place, f"cannot be read: {error}", "check the place")]) from None
    if info.type == _fs().FileType.File:
        found = _of_manifest(system, place, path)
        head, mark, query = place.partition("?")
        root = head.rpartition("/")[0] + mark + query if "://" in place else str(Path(path).parent)
    elif info.type == _fs().FileType.Directory:
        found, root = _of_folder(system, place, path), place if "://" in place else path
    else:
        raise FleetError([fault(place, "is not there", "a folder, a URI, or a manifest")])
    if not found:
        hint = "ROBOT/NIGHT.csv, or ROBOT/NIGHT/train.csv with ROBOT/NIGHT/validate.csv"
        raise FleetError([fault(place, "has no logs", hint)])
    return root, sorted(found, key=lambda one: (one.night, one.robot))


def refuse_inside(place: str, out: Path) -> None:
    """Refuses answers that would stand among the logs: the next run would take them for logs."""
    system, path = opened(place)
    if not isinstance(system, _fs().LocalFileSystem) or not Path(path).is_dir():
        return
    if out.resolve().is_relative_to(Path(path).resolve()):
        cause, hint = f"is in the folder of the logs, {place}", "name a folder beside it"
        raise FleetError([fault(str(out), cause, hint)])


def _of_folder(system: Any, place: str, path: str) -> list[RobotNight]:
    selector = _fs().FileSelector(path, recursive=True)
    try:
        all_files = system.get_file_info(selector)
    except (arrow().ArrowException, OSError) as error:
        raise FleetError([fault(place, f"cannot be read: {error}", "check the place")]) from None
    nights: dict[tuple[str, str], list[File]] = {}
    unfit: dict[tuple[str, str], list[str]] = {}
    for info in all_files:
        name = PurePosixPath(info.path).relative_to(path)
        if name.suffix.lower() not in KINDS or len(name.parts) not in (2, 3):
            continue
        key = name.parts[0], name.parts[1] if len(name.parts) == 3 else name.stem
        if info.type == _fs().FileType.File:
            nights.setdefault(key, []).append(_file(info, str(name)))
        elif len(name.parts) == 3:
            unfit.setdefault(key, []).append(str(name))
    found = [
        _night_of_folder(*key, nights.get(key, []), unfit.get(key, []))
        for key in dict.fromkeys([*nights, *unfit])
    ]
    if found and all(one.wrong for one in found):
        raise FleetError([fault(place, f"{one.robot}/{one.night}: {one.wrong}") for one in found])
    return found


def _night_of_folder(robot: str, night: str, files: list[File], unfit: list[str]) -> RobotNight:
    """A robot-night of its logs, and of what has the name of a log and is none."""
    files.sort(key=lambda file: file.path)
    judging = [file for file in files if PurePosixPath(file.path).stem.startswith("validate")]
    train = [file for file in files if file not in judging]
    wrong = None
    if unfit:
        wrong = f"{', '.join(sorted(unfit))}: is no file"
    elif not train or (len(train) > 1 and not judging):
        wrong = "logs are called train.. and validate.., or there is one"
        missing = "train" if not train else "validate"
        wrong = f"no log is called {missing}..: {wrong}"
    return RobotNight(robot, night, tuple(train), tuple(judging), wrong)


def _file(info: Any, name: str) -> File:
    return File(name, int(info.size), int(info.mtime_ns or 0))


def _of_manifest(system: Any, place: str, path: str) -> list[RobotNight]:
    table = _table(system, place, path)
    needed = {"robot", "night", "train"}
    faults = [fault(place, f"has no column `{name}`") for name in needed - set(table)]
    if faults:
        raise FleetError(sorted(faults, key=str))
    root, found = PurePosixPath(path).parent, []
    rows = zip(*(table[name] for name in ("robot", "night", "train")))
    judging = table.get("validate") or [None] * len(table["robot"])
    seen: set[tuple[str, str]] = set()
    for number, ((robot, night, train), validate) in enumerate(zip(rows, judging), start=1):
        if None in (robot, night) or not str(robot) or not str(night):
            faults.append(fault(place, f"row {number} has no robot or night"))
            continue
        key = str(robot), str(night)
        if key in seen:
            faults.append(fault(place, f"row {number}: {key[0]} in {key[1]} stands there twice"))
        seen.add(key)
        logs = [[_listed(system, root, one) for one in _names(cell)] for cell in (train, validate)]
        wrong = None if logs[0] else f"row {number} of the manifest names no log in `train`"
        found.append(RobotNight(*key, tuple(logs[0]), tuple(logs[1]), wrong))
    if found and all(one.wrong for one in found):
        faults += [fault(place, str(one.wrong)) for one in found]
    if faults:
        raise FleetError(faults)
    return found


def _names(cell: object) -> list[str]:
    """The logs of a cell: one, several with semicolons, or a list."""
    if cell is None:
        return []
    each = cell if isinstance(cell, list) else str(cell).split(";")
    return [str(one).strip() for one in each if str(one).strip()]


def _listed(system: Any, root: PurePosixPath, name: str) -> File:
    """A log of a manifest. One that is not there is a row that says so, later."""
    try:
        info = system.get_file_info(str(root / name))
    except (arrow().ArrowException, OSError) as error:
        raise FleetError([fault(name, f"cannot be read: {error}", "check the place")]) from None
    return File(name, int(info.size or 0), int(info.mtime_ns or 0))


def _table(system: Any, place: str, path: str) -> dict[str, list[Any]]:
    pa = arrow()
    import pyarrow.csv  # type: ignore[import-untyped, unused-ignore]

    try:
        with system.open_input_file(path) as file:
            if path.lower().endswith(".csv"):
                # robots may be called 007
                texts = dict.fromkeys(("robot", "night", "train", "validate"), pa.string())
                how = pyarrow.csv.ConvertOptions(column_types=texts)
                table = pyarrow.csv.read_csv(io.BytesIO(file.read()), convert_options=how)
            else:
                table = read_table(file, is_parquet=True)
        refuse_twins(table.column_names)
    except (pa.ArrowException, OSError, ValueError) as error:
        hint = "a Parquet or CSV file with the columns robot, night, train, validate"
        raise FleetError([fault(place, f"is no manifest: {error}", hint)]) from None
    found: dict[str, list[Any]] = table.to_pydict()
    return found


@dataclass(frozen=True)
class Fetched:
    """The logs of a robot-night, here. Files that denavit reads itself are paths."""

    train: tuple[ReadLog, ...]
    validate: tuple[ReadLog, ...]
    contents: tuple[str, ...]
    """Names of the content of the logs that are fitted, by their bytes."""
    folders: tuple[str, ...]
    """Where they are now, which is nobody's concern."""

    def bare(self, text: str) -> str:
        """A text that names logs as the fleet does."""
        for folder in self.folders:
            text = text.replace(folder, "")
        return text


@contextmanager
def fetched(root: str, train: Sequence[str], validate: Sequence[str]) -> Iterator[Fetched]:
    """The logs of a robot-night, here for a while."""
    system, base = _opened(root)
    with tempfile.TemporaryDirectory(prefix="denavit-fleet-") as inside:
        folders = inside + "/", base.rstrip("/") + "/"
        try:
            read = [
                [_fetched(system, base, name, Path(inside)) for name in names]
                for names in (train, validate)
            ]
            contents = tuple(content for _, content in read[0])
            logs = [[log for log, _ in each] for each in read]
            if not logs[1]:
                logs = _cut(logs[0], train[0])
            yield Fetched(tuple(logs[0]), tuple(logs[1]), contents, folders)
        except Error as error:
            # faults name logs as the fleet does
            for folder in folders:
                error = error._with("", folder)
            raise error from None


@lru_cache(maxsize=4)
def _opened(root: str) -> tuple[Any, str]:
    return opened(root)


def unread(name: str, error: Exception, base: str = "") -> UnreadError:
    """The exception of what cannot be read now, whatever it holds."""
    cause = str(error).replace(base.rstrip("/") + "/", "") if base else str(error)
    return UnreadError([fault(name, f"cannot be read: {cause}", "the next run reads it again")])


def _fetched(system: Any, base: str, name: str, inside: Path) -> tuple[ReadLog, str]:
    """A log, and the name of its content."""
    pa = arrow()
    path = str(PurePosixPath(base) / name)
    is_local, is_parquet = isinstance(system, _fs().LocalFileSystem), _is_parquet(name)
    if not is_local and (PurePosixPath(name).is_absolute() or ".." in PurePosixPath(name).parts):
        # its copy must not leave the folder
        raise FleetError([fault(name, "leads out of the place of the logs")])
    try:
        content, digest = _content(system, path, keeps=is_parquet or not is_local)
        if is_local and not is_parquet:
            return path, digest
        copy = inside / name
        if not is_parquet:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(content)
            return str(copy), digest
    except (pa.ArrowException, OSError) as error:
        raise unread(name, error, base) from None
    try:
        table = read_table(pa.BufferReader(content), is_parquet=True)
        said = header_of(table.schema) + left_out(table)
        return _logs.Table(name, said, columns(table)), digest
    except (pa.ArrowException, OSError, ValueError) as error:
        raise FleetError([fault(name, f"cannot be read: {error}")]) from None


def _is_parquet(name: str) -> bool:
    return name.lower().endswith(".parquet")


def _content(system: Any, path: str, *, keeps: bool) -> tuple[bytes, str]:
    """Reads a log from end to end, so that a store that fails is no log that is corrupt.
    What is not kept is read again from the file, which the machine remembers. Names it, too.
    """
    kept, named = [], hashlib.sha256()
    with system.open_input_stream(path, compression=None) as file:
        while block := file.read(BLOCK):
            named.update(block)
            if keeps:
                kept.append(block)
    return b"".join(kept), named.hexdigest()


def _cut(logs: list[ReadLog], name: str) -> list[list[ReadLog]]:
    """The only log of a night as two: its first half, and its second."""
    log, *others = logs
    if others:
        hint = "name those that judge as `validate`"
        raise FleetError([fault(name, "stands beside others, and no log judges", hint)])
    if isinstance(log, str):
        if not name.lower().endswith(".csv"):
            hint = "give two logs of the night: train and validate"
            raise FleetError([fault(name, "only tables can be cut in two", hint)])
        log = _read_csv(log, name)
    half = len(next(iter(log.columns.values()), ())) // 2
    parts = slice(None, half), slice(half, None)
    cut = [{column: values[part] for column, values in log.columns.items()} for part in parts]
    return [[_logs.Table(name, log.header, part)] for part in cut]


def _read_csv(path: str, name: str) -> _logs.Table:
    pa = arrow()
    import pyarrow.csv

    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise unread(name, error) from None
    try:
        lines = content.splitlines(keepends=True)
        text = b"".join(line for line in lines if not line.startswith(b"#"))
        said = [line[1:].decode().partition(":") for line in lines if line.startswith(b"#")]
        header = [(key.strip(), value.strip()) for key, _, value in said]
        table = pyarrow.csv.read_csv(io.BytesIO(text))
        return _logs.Table(name, header + left_out(table), columns(table))
    except (pa.ArrowException, ValueError) as error:
        raise FleetError([fault(name, f"cannot be read: {error}")]) from None
