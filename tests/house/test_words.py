"""Names, docstrings and help are in the words of the field: the count of the old ones may only shrink."""

from __future__ import annotations

from pathlib import Path

import pytest

from tools.words import counts, places

MOST = {
    "benchmarks": 1,
    "nodes": 1,
    "robolink/cli": 1,
    "robolink/learn": 3,
    "robolink/text": 1,
    "robolink/wire": 1,
    "robolink/workspace": 2,
}
"""Most old words of a room, none where it is not listed. Lower a number when `python -m tools.words` shows less."""


@pytest.mark.slow
def test_no_room_has_more_old_words_than_before() -> None:
    found = counts()
    assert found.total() > 0 or not MOST
    assert {room: count for room, count in found.items() if count > MOST.get(room, 0)} == {}


@pytest.mark.parametrize(
    ("line", "kind", "word"),
    [
        ("def f(is_asked: int) -> int: ...", "name", "is_asked"),
        ("class MannerOf: ...", "name", "MannerOf"),
        ("self.kept = masked = 1", "name", "kept"),
        ("import a as wanted", "name", "wanted"),
        ("class A:\n    '''Give a thing.'''", "docstring", "Give a thing."),
        ("def f():\n    '''Return what a thing is.'''", "docstring", "Return what a thing is."),
        (
            "a = typer.Option('--seed', help='Of the world and of all chance.')",
            "help",
            "Of the world and of all chance.",
        ),
        ("a = f'{b} is no PNG'", "text", "is no PNG"),
        ("a = f'{b} is no {c}'", "text", "is no {}"),
        ("a = 1  # it is no circle", "text", "is no circle"),
    ],
)
def test_old_words_are_found(line: str, kind: str, word: str, tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(f"{line}\n")
    assert [(each.kind, each.text) for each in places(tmp_path / "a.py", tmp_path)] == [(kind, word)]


@pytest.mark.parametrize(
    "line",
    [
        "masked = unwished_for",
        "a = 'there is no room'",
        "a = 'it is no longer here'",
        "from a import asked",
        "a(b.kept)",
    ],
)
def test_words_that_others_chose_or_that_are_usual_are_not_counted(line: str, tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(f"{line}\n")
    assert places(tmp_path / "a.py", tmp_path) == []
