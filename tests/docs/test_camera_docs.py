"""docs/reference/camera.md: its figures are those of the tests; its blocks are run by test_pages_run.py."""

from __future__ import annotations

from pathlib import Path

from tests.support.opencvs_conversions import ENCODINGS

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "camera.md").read_text(encoding="utf-8")


def test_so_many_pairs_are_compared() -> None:
    count = len(ENCODINGS)
    assert f"all {count**2:,} pairs of {count} encodings" in " ".join(PAGE.split())
