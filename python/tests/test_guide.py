"""The code of the guide runs, block after block."""

import re
from pathlib import Path

GUIDE = Path(__file__).resolve().parents[2] / "docs" / "guide" / "python.md"


def test_the_guide_runs():
    blocks = re.findall(r"```python\n(.*?)```", GUIDE.read_text(), re.DOTALL)
    assert len(blocks) >= 5
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(GUIDE), "exec"), names)


def test_the_guide_lists_every_function():
    import denavit

    text = GUIDE.read_text()
    own = [name for name in vars(denavit._denavit.Model) if not name.startswith("_")]
    read = {"name", "description", "source", "notes", "dof", "joints", "links", "contacts"}
    assert [name for name in own if name not in read and f"`{name}`" not in text] == []
