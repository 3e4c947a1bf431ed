"""Names of content: of bytes, files, folders and functions, and of the build of this package."""

from __future__ import annotations

import hashlib
import inspect
import os
import pickle
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..errors import Error, Fault

BLOCK = 1 << 20


def digest(content: bytes) -> str:
    """The name of some content."""
    return hashlib.sha256(content).hexdigest()


def digest_of_path(path: str | Path) -> str:
    """The name of what a file holds, or of all files of a folder with their paths in it."""
    path = Path(path)
    try:
        if not path.is_dir():
            return _of_file(str(path), *_stamp(path))
        inside = sorted(_inside(path))
        names = [(one.relative_to(path).as_posix(), _of_file(str(one), *_stamp(one)))
                 for one in inside]  # fmt: skip
    except OSError as error:
        fault = Fault(str(path), None, None, f"cannot be read: {error.strerror}", "check the path")
        raise Error([fault]) from None
    return digest("\n".join(f"{name} {content}" for name, content in names).encode())


def _inside(folder: Path) -> Iterator[Path]:
    """The files of a folder that are content, and not what Python makes of it. Links are followed:
    who reads the folder follows them, too.
    """
    above = {os.path.realpath(folder): {os.path.realpath(folder)}}
    for place, names, files in os.walk(folder, followlinks=True, onerror=_raised):
        real = above[os.path.realpath(place)]
        kept = []
        for name in names:
            own = os.path.realpath(os.path.join(place, name))
            # one that leads to a folder it is in has no end
            if name != "__pycache__" and own not in real:
                above[own] = real | {own}
                kept.append(name)
        names[:] = kept
        yield from (path for name in files if (path := Path(place, name)).is_file())


def _raised(error: OSError) -> None:
    raise error


def _stamp(path: Path) -> tuple[int, int]:
    found = os.stat(path)
    return found.st_size, found.st_mtime_ns


@lru_cache(maxsize=1 << 14)
def _of_file(path: str, *_: int) -> str:
    """Of a file as it is now: with another size or time it is read anew."""
    found = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(BLOCK):
            found.update(block)
    return found.hexdigest()


class UnnamedError(Exception):
    """What rows depend on has no name that is the same in another process."""


def of_function(function: Any) -> str:
    """The name of what rows depend on of a function: its text, its defaults, and the values it
    closes over. What it calls is no part of it.
    """
    return digest(_function(function, ()))


def _function(function: Any, within: tuple[int, ...]) -> bytes:
    try:
        text = inspect.getsource(function)
    except (OSError, TypeError):
        name = getattr(function, "__qualname__", str(function))
        raise UnnamedError(f"the text of {name} is not known: it stands in no file") from None
    given: list[Any] = []
    for part in ("__defaults__", "__kwdefaults__"):
        given.append(getattr(function, part, None))
    for cell in getattr(function, "__closure__", None) or ():
        try:
            given.append(cell.cell_contents)
        except ValueError:
            given.append(None)  # it has no value yet
    return text.encode() + _value(given, (*within, id(function)))


def _value(value: Any, within: tuple[int, ...]) -> bytes:
    """A value as bytes, the same for equal ones in every process."""
    if id(value) in within:
        return b"itself"
    inner = (*within, id(value))
    if inspect.isfunction(value):
        return _function(value, within)
    if inspect.ismodule(value):
        return value.__name__.encode()
    kind = type(value).__name__.encode()
    if isinstance(value, (list, tuple, set, frozenset, dict)):
        parts = value.items() if isinstance(value, dict) else value
        each = [_value(one, inner) for one in parts]
        own = sorted(each) if isinstance(value, (set, frozenset)) else each
        return kind + b"".join(str(len(one)).encode() + b":" + one for one in own)
    if value is None or isinstance(value, (bool, int, float, complex, str)):
        return kind + repr(value).encode("utf-8", "surrogatepass")
    try:
        return kind + pickle.dumps(value, protocol=4)
    except Exception as error:
        cause = f"a value of type {type(value).__name__} has no name: {error}"
        raise UnnamedError(cause) from None


@lru_cache(maxsize=1)
def build() -> str:
    """The build of this package: its compiled part and its modules, as this process has them."""
    return digest_of_path(Path(__file__).parents[1])
