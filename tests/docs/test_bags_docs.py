"""docs/reference/bags.md: it has every verb of `robolink bag`; its blocks are run by test_pages_run.py."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import typer.main

from robolink.cli.bag import app

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "bags.md").read_text(encoding="utf-8")
VERBS: Any = typer.main.get_command(app).commands  # type: ignore[attr-defined]


def test_every_verb_is_there() -> None:
    said = set(re.findall(r"^robolink bag (\w+)", PAGE, re.MULTILINE))
    assert {each for each in VERBS if not VERBS[each].hidden} - said == {"list"}
