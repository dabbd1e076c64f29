"""Sizes: a file has at most 600 lines, a function outside of tests at most 40 below its signature and docstring.

rclpy's Node has some ninety public methods, each with a docstring of its own: in that file, 600 lines of code.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
CODE = ("robolink", "nodes", "tools", "benchmarks")
"""Folders of Python code, besides the tests: those hold programs of some length inside of functions."""
LONGEST_FILE, LONGEST_BODY = 600, 40
"""Most lines of a file, and of a function without its signature and its docstring."""
LONG_WITH_DOCSTRINGS = ("robolink/node.py",)
"""Files whose docstrings and blank lines do not count."""

LONG = re.compile(rf"^( *)(?:async )?def .*\n(?:(?:\1[ )].*)?\n){{{LONGEST_BODY},}}", re.MULTILINE)
"""What a file has that may hold too long a function, its signature included: only such files are parsed."""

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


def lines_of_code(text: str) -> int:
    """Return the lines without blank ones, comments and docstrings."""
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    texts = [each.body[0] for each in ast.walk(ast.parse(text)) if isinstance(each, documented) and each.body]
    texts = [each for each in texts if isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant)]
    dropped = {line for each in texts for line in range(each.lineno, (each.end_lineno or 0) + 1)}
    lines = enumerate(text.splitlines(), 1)
    return sum(1 for number, line in lines if line.strip() and line.strip()[0] != "#" and number not in dropped)


def test_lines_of_code_are_counted_without_docstrings_and_blanks() -> None:
    assert (
        lines_of_code(
            '"""What for."""\n\nimport os\n\n\ndef f():\n    """Do.\n\n    More.\n    """\n    # why\n    f()\n'
        )
        == 3
    )


def test_no_file_has_more_than_600_lines() -> None:
    texts = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in files(*CODE, "tests")}
    lengths = {name: text.count("\n") for name, text in texts.items()}
    for name in LONG_WITH_DOCSTRINGS:
        assert lengths[name] > LONGEST_FILE, f"{name} needs no exception any more"
        lengths[name] = lines_of_code(texts[name])
    assert len(lengths) > 900
    assert {name: lines for name, lines in lengths.items() if lines > LONGEST_FILE} == {}


def test_no_function_has_more_than_40_lines() -> None:
    texts = {path: path.read_text("utf-8") for path in files(*CODE)}
    found = [
        f"{path.relative_to(ROOT).as_posix()}:{node.lineno}: {node.name}: {body_lines(node)}"
        for path, text in texts.items()
        if LONG.search(text)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, Function) and body_lines(node) > LONGEST_BODY
    ]
    assert found == []
