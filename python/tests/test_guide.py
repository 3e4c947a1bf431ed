"""The code of the guide runs, block after block."""

import re
from pathlib import Path

import pytest

PAGES = Path(__file__).resolve().parents[2] / "docs" / "guide"
GUIDE = PAGES / "python.md"


@pytest.mark.parametrize(("page", "least"), [("python", 5), ("studies", 2), ("fleet", 3)])
def test_the_guide_runs(page, least):
    file = PAGES / f"{page}.md"
    blocks = re.findall(r"```python\n(.*?)```", file.read_text(), re.DOTALL)
    assert len(blocks) >= least
    if page != "python":
        pytest.importorskip("pyarrow")
    names: dict[str, object] = {"__name__": "guide"}
    for block in blocks:
        exec(compile(block, str(file), "exec"), names)


def test_the_guide_lists_every_function():
    import denavit

    text = GUIDE.read_text()
    own = [name for name in vars(denavit._denavit.Model) if not name.startswith("_")]
    read = {"name", "description", "source", "notes", "dof", "joints", "links", "contacts"}
    assert [name for name in own if name not in read and f"`{name}`" not in text] == []
