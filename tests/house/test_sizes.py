"""Sizes: a file has at most 600 lines, a function outside of tests at most 40 below its signature and docstring."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
CODE = ("robolink", "nodes", "tools", "benchmarks")
"""Folders of Python code, besides the tests: those hold programs of some length inside of functions."""
LONGEST_FILE, LONGEST_BODY = 600, 40
"""Most lines of a file, and of a function without its signature and its docstring."""

PROGRAMS = ROOT / "tests" / "tutorials"
Function = ast.FunctionDef | ast.AsyncFunctionDef


def files(*folders: str) -> Iterator[Path]:
    """Return each source file of these folders, but for the programs that users of ROS 2 wrote."""
    for folder in folders:
        yield from (each for each in sorted((ROOT / folder).rglob("*.py")) if PROGRAMS not in each.parents)


def body_lines(function: Function) -> int:
    """Return the lines from the first statement behind the docstring to the end."""
    first = function.body[1:2] if ast.get_docstring(function) is not None else function.body
    return (function.end_lineno or 0) - first[0].lineno + 1 if first else 0


def test_a_body_is_counted_without_signature_and_docstring() -> None:
    text = "def f(\n    a: int,\n) -> int:\n    '''Add.\n\n    More.\n    '''\n    b = a\n    return b\n"
    assert [body_lines(each) for each in ast.parse(text).body if isinstance(each, Function)] == [2]


def test_no_file_has_more_than_600_lines() -> None:
    lengths = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8").count("\n") for path in files(*CODE, "tests")}
    assert len(lengths) > 900
    assert {name: lines for name, lines in lengths.items() if lines > LONGEST_FILE} == {}


def test_no_function_has_more_than_40_lines() -> None:
    found = [
        f"{path.relative_to(ROOT).as_posix()}:{node.lineno}: {node.name}: {body_lines(node)}"
        for path in files(*CODE)
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, Function) and body_lines(node) > LONGEST_BODY
    ]
    assert found == []
