"""A line of progress on a terminal."""

from __future__ import annotations

import sys
from types import TracebackType


class ProgressLine:
    """Rewrites one line of standard error; whatever ends the work, what follows has a line of its
    own. Where nobody looks, nothing is written.
    """

    def __init__(self) -> None:
        self._longest = 0

    def show(self, text: str) -> None:
        """Shows a text in place of the one before."""
        if sys.stderr.isatty():
            self._longest = max(self._longest, len(text))
            print(f"\r{text:<{self._longest}}", end="", file=sys.stderr, flush=True)

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._longest:
            print(file=sys.stderr, flush=True)
