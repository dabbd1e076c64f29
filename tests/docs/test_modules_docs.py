"""docs/reference/modules.md: each module that it names is there; its imports are run by test_pages_run.py."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "modules.md").read_text(encoding="utf-8")


def test_the_modules_of_the_table_are_there() -> None:
    rows = re.findall(r"^\| `(robolink\.[a-z0-9_.]+)`", PAGE, re.MULTILINE)
    assert len(rows) > 7
    assert [name for name in rows if importlib.util.find_spec(name) is None] == []
    homes = re.findall(r"\(`(robolink[a-z0-9_.]+)`\)", PAGE)
    assert [name for name in homes if importlib.util.find_spec(name) is None] == []
