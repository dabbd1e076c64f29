"""docs/reference/testing.md: it has the names that there are; its blocks are run by tests/docs/test_pages_run.py."""

from __future__ import annotations

import re
from pathlib import Path

from robolink.testing import System
from robolink.testing.faults import Faults

DOCS = (Path(__file__).parents[2] / "docs" / "reference" / "testing.md").read_text(encoding="utf-8")


def test_what_its_tables_name_is_there() -> None:
    cells = [row.split("|")[1] for row in DOCS.splitlines() if row.startswith("| `")]
    names = [name for cell in cells for name in re.findall(r"`(\w+)", cell)]
    assert len(names) > 30
    assert [each for each in names if not hasattr(System, each) and not hasattr(Faults, each)] == ["clock", "seed"]
    with System() as system:
        assert hasattr(system, "clock")
        assert system.seed == 0
