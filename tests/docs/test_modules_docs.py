"""docs/modules.md: each import that it documents works, and each module that it names is there."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "modules.md").read_text(encoding="utf-8")
IMPORTS = [line for block in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL) for line in block.splitlines()]


@pytest.mark.parametrize("line", IMPORTS)
def test_the_import_works(line: str) -> None:
    exec(line, {})


def test_the_modules_of_the_table_are_there() -> None:
    rows = re.findall(r"^\| `(robolink\.[a-z0-9_.]+)`", PAGE, re.MULTILINE)
    assert len(rows) > 7
    assert [name for name in rows if importlib.util.find_spec(name) is None] == []
    homes = re.findall(r"\(`(robolink[a-z0-9_.]+)`\)", PAGE)
    assert [name for name in homes if importlib.util.find_spec(name) is None] == []
