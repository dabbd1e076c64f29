"""docs/reference/exercises.md: its tables name all verbs and races; its blocks are run by test_pages_run.py."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from robolink.cli.root import command
from robolink.learn.trial import Trial

TEXT = (Path(__file__).parents[2] / "docs" / "reference" / "exercises.md").read_text(encoding="utf-8")


def test_every_verb_is_named() -> None:
    root = command()
    context = root.make_context("robolink", [], resilient_parsing=True)
    for noun in ("learn", "new"):
        for verb in root.get_command(context, noun).commands:
            assert f"{noun} {verb}" in TEXT


@pytest.mark.annex("race")
def test_every_race_is_named_with_its_rule() -> None:
    from robolink.race.races import RACES

    for name in RACES:
        assert f"| `{name}` |" in TEXT


def test_what_a_check_may_use_is_there() -> None:
    for name in re.findall(r"`trial\.(\w+)", TEXT):
        assert hasattr(Trial, name)
