"""Files of text, whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def write_whole(path: Path, text: str) -> None:
    """Writes a file; where that breaks off, what was there stays."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".denavit-", dir=path.parent) as inside:
        new = Path(inside) / "new"
        new.write_text(text, encoding="utf-8", newline="\n")
        os.replace(new, path)
