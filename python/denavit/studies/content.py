"""Names of content: of bytes, of files and folders, and of the build of this package."""

from __future__ import annotations

import hashlib
import os
from functools import lru_cache
from pathlib import Path

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
        inside = sorted(one for one in path.rglob("*") if _counts(one))
        names = [(one.relative_to(path).as_posix(), _of_file(str(one), *_stamp(one)))
                 for one in inside]  # fmt: skip
    except OSError as error:
        fault = Fault(str(path), None, None, f"cannot be read: {error.strerror}", "check the path")
        raise Error([fault]) from None
    return digest("\n".join(f"{name} {content}" for name, content in names).encode())


def _counts(path: Path) -> bool:
    """Whether it is content, and not what Python makes of it."""
    return path.is_file() and "__pycache__" not in path.parts


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


@lru_cache(maxsize=1)
def build() -> str:
    """The build of this package: its compiled part and its modules, as this process has them."""
    return digest_of_path(Path(__file__).parents[1])
