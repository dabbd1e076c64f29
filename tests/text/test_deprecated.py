"""Deprecated functions warn, name what to use instead, and are removed in time: no use of the decorator outlives it."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from robolink.text.deprecated import deprecated, end_of

ROOT = Path(__file__).parents[2]


@deprecated("0.3", "math.prod")
def product(a: int, b: int) -> int:
    """Multiply."""
    return a * b


def test_a_call_warns_where_it_stands_and_works_all_the_same() -> None:
    with pytest.warns(DeprecationWarning, match="math.prod") as caught:
        assert product(2, b=3) == 6
    [warning] = caught
    words = r".*\.product is deprecated since 0\.3 and ends with 0\.5: use math\.prod"
    assert re.fullmatch(words, str(warning.message))
    assert Path(warning.filename) == Path(__file__)
    assert product.__doc__ == "Multiply."


@pytest.mark.parametrize(("since", "end"), [("0.3", "0.5"), ("0.9.1", "0.11"), ("1.0", "1.2")])
def test_it_ends_two_minor_versions_later(since: str, end: str) -> None:
    assert end_of(since) == end


def test_a_class_stays_a_class() -> None:
    with pytest.raises(TypeError, match="decorate the __init__ of Node"):

        @deprecated("0.3", "another")
        class Node: ...


def overdue(text: str, version: str) -> list[str]:
    """The functions of a program that are deprecated and should have gone by a version."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            continue
        for each in node.decorator_list:
            if isinstance(each, ast.Call) and ast.unparse(each.func).split(".")[-1] == "deprecated":
                given = {keyword.arg: keyword.value for keyword in each.keywords}
                since = ast.literal_eval(each.args[0] if each.args else given["since"])
                if parts(end_of(since)) <= parts(version):
                    found.append(node.name)
    return found


def parts(version: str) -> list[int]:
    return [int(each) for each in version.split(".")[:2]]


def test_what_is_overdue_is_found() -> None:
    text = '@deprecated("0.3", "b")\nasync def a(): ...\n\n@x.deprecated(since="0.9", instead="b")\ndef c(): ...\n'
    assert overdue(text, "0.4.9") == []
    assert overdue(text, "0.5.0") == ["a"]
    assert overdue(text, "1.0.0") == ["a", "c"]
    assert overdue(text, "0.11.0") == ["a", "c"]
    assert overdue(text, "0.10.0") == ["a"]


def test_nothing_is_overdue() -> None:
    version = re.search(r'^version = "(.+)"$', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE)
    assert version is not None
    texts = {each: each.read_text(encoding="utf-8") for each in (ROOT / "robolink").rglob("*.py")}
    using = {each: text for each, text in texts.items() if "deprecated(" in text}
    assert [(each.name, late) for each, text in using.items() if (late := overdue(text, version[1]))] == []
