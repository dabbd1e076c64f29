"""Which lines of two transcripts count as the same, and the table of those that may differ."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.judge.comparison import compare, unsteady
from tests.judge.programs import names
from tests.judge.table import Row, rows


@pytest.mark.parametrize(
    ("real", "ours"),
    [
        ("bad: raises ValueError: no", "bad: raises EncodeError(ValueError): not that"),
        ("bad: raises RCLError(RuntimeError): no", "bad: raises InvalidHandle(RCLError,RuntimeError): it is gone"),
        ("bad: raises TypeError", "bad: raises TypeError: with a text"),
        ("set: [(False, 'no')]", "set: [(False, 'not that')]"),
        ("[WARN] [<time>] [n]: so", "[WARN] [<time>] [n]: and so"),
        ("attributes: ['a']", "attributes: ['a', 'b']"),
    ],
)
def test_only_a_text_differs(real: str, ours: str) -> None:
    result = compare(real, ours)
    assert (result.lines, result.texts, result.differing) == (1, 1, 0)


@pytest.mark.parametrize(
    ("real", "ours"),
    [
        ("bad: raises ValueError: no", "bad: raises TypeError: no"),
        ("bad: raises RCLError(RuntimeError): no", "bad: raises ValueError: no"),
        ("bad: raises ValueError: no", "bad: 1"),
        ("n: 1", "n: 2"),
        ("[WARN] [<time>] [n]: so", "[ERROR] [<time>] [n]: so"),
        ("[INFO] [<time>] [n]: so", "[INFO] [<time>] [n]: and so"),
        ("attributes: ['a', 'c']", "attributes: ['a', 'b']"),
        ("", "more"),
        ("less", ""),
    ],
)
def test_a_line_differs(real: str, ours: str) -> None:
    result = compare(real, ours)
    assert (result.texts, result.differing) == (0, 1)


def test_a_line_at_another_place_differs() -> None:
    assert compare("a: 1\nb: 2\nc: 3", "b: 2\na: 1\nc: 3").differing == 1


def test_a_line_that_was_not_steady_is_not_compared() -> None:
    assert compare("a: 1\nb: 2", "a: 3\nb: 2", ["a: 4"]).differing == 0


def test_what_differs_between_runs_is_not_steady() -> None:
    assert unsteady("a\nb: 1\n", ["a\nb: 2\n", "a\nb: 1\n"]) == ["b: 1", "b: 2"]


def _page(folder: Path, *lines: str) -> Path:
    page = folder / "page.md"
    table = "\n".join(["| program | lines | why |", "|---|---|---|", *lines])
    page.write_text(f"<!-- differences: from here on -->\n{table}\n<!-- differences: to here -->\n", encoding="utf-8")
    return page


def test_a_row_names_lines_by_their_labels(tmp_path: Path) -> None:
    (row,) = rows(_page(tmp_path, "| qos | `compat *`, `a \\| b` | **By design**: so |"))
    assert row == Row("qos", ("compat *", "a | b"), "**By design**: so")
    seen = compare("compat R: 1\nother: 1", "compat R: 2\nother: 2").differences
    assert [row.covers(each) for each in seen] == [True, False]
    assert row.unused(seen) == ["a | b"]


@pytest.mark.parametrize("line", ["| qos | `a` |", "| qos | a | **By design** |", "| qos | `a` | since so |"])
def test_a_row_that_is_not_complete_is_told(tmp_path: Path, line: str) -> None:
    with pytest.raises(ValueError, match="row"):
        rows(_page(tmp_path, line))


def test_every_row_names_a_program() -> None:
    assert {row.program for row in rows()} <= set(names())
