"""Writer of a class as .msg, .srv or .action text: the text that it came from, or one made of its fields."""

from __future__ import annotations

import ast
import inspect
import textwrap
import threading
from collections.abc import Iterator
from typing import Any

import msgspec

from robolink.message import literals
from robolink.message.annotations import FieldType
from robolink.message.base import Message
from robolink.message.definition import SECTIONS

WIDTH = 120
"""Width of a line of comment in characters, its ``#`` included."""


_parsing = threading.Lock()
"""Held while source is parsed: Python 3.11's parsers, in two threads, raise SystemError at each other."""


class Comments(msgspec.Struct, frozen=True):
    """Comments of a field or constant in a Python class body."""

    above: tuple[str, ...] = ()
    behind: str = ""


def text_of(cls: type[Any]) -> str:
    """Return the text of a message, service or action class, as an interface file would have it.

    A class that came from an interface file has that file's text. Of a class written in Python the docstring stands
    at the head, and comments and docstrings of its fields stand beside them.
    """
    known = getattr(cls, "__ros_text__", None) if "__ros_text__" in vars(cls) else None
    if known is not None:
        return str(known)
    if hasattr(cls, "__ros_fields__"):
        return _message_text(cls)
    kind = cls.__ros_type__.split("/")[1]
    parts = [getattr(cls, suffix.removeprefix("_")) for suffix in SECTIONS[kind]]
    first, *others = (_message_text(part) for part in parts)
    head = "".join(f"{line}\n" for line in _head(cls))
    return "---\n".join([f"{head}\n{first}" if head and first else head + first, *others])


def _message_text(cls: type[Message]) -> str:
    head = list(_head(cls))
    lines: list[str] = []
    comments = _comments(cls)
    for name, (kind, value) in cls.__ros_constants__.items():
        line = f"{_type(kind, cls)} {name}={literals.write(kind, value)}"
        lines.extend(_with_comments(line, comments.get(name, Comments())))
    if lines and cls.__ros_fields__:
        lines.append("")
    for name, kind in cls.__ros_fields__.items():
        line = f"{_type(kind, cls)} {name}"
        if kind.message is None and name in cls.__ros_defaults__:
            line += f" {literals.write(kind, cls.__ros_defaults__[name])}"
        lines.extend(_with_comments(line, comments.get(name, Comments())))
    if head and lines:
        head.append("")
    return "".join(f"{line}\n" for line in head + lines)


def _type(kind: FieldType, cls: type[Message]) -> str:
    """Return the type of a field of `cls`: messages of its own package by their bare name."""
    own = cls.__ros_type__.partition("/")[0] + "/"
    text = str(kind)
    return text.removeprefix(own) if text.count("/") == 1 else text


def _head(cls: type[Any]) -> Iterator[str]:
    doc = cls.__dict__.get("__doc__")
    for paragraph in inspect.cleandoc(doc or "").splitlines():
        yield from _wrapped(paragraph)


def _wrapped(text: str) -> list[str]:
    """Return the lines of a comment; a line that is indented, an example, stays as it is."""
    if not text.strip():
        return ["#"]
    if text[0].isspace() or len(text) <= WIDTH - 2:
        return [f"# {text}".rstrip()]
    return [f"# {line}" for line in textwrap.wrap(text, WIDTH - 2)]


def _with_comments(line: str, comments: Comments) -> Iterator[str]:
    for each in comments.above:
        yield from _wrapped(each)
    yield f"{line}  # {comments.behind}" if comments.behind else line


def _comments(cls: type[Message]) -> dict[str, Comments]:
    """Return the comments of a class's source by field: ``#`` above and behind, and the docstring below."""
    try:
        source = textwrap.dedent(inspect.getsource(cls))
        with _parsing:
            body = ast.parse(source).body[0]
    except (OSError, TypeError, SyntaxError, IndexError, SystemError):  # no source: made at run time, or typed in
        return {}
    if not isinstance(body, ast.ClassDef):
        return {}
    lines = source.split("\n")
    found: dict[str, Comments] = {}
    for statement, following in zip(body.body, [*body.body[1:], None], strict=True):
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            above = [*_above(lines, statement.lineno - 1), *_docstring(following)]
            behind = lines[(statement.end_lineno or 1) - 1].encode()[statement.end_col_offset or 0 :].decode().strip()
            found[statement.target.id] = Comments(tuple(above), _comment(behind))
    return found


def _above(lines: list[str], index: int) -> list[str]:
    start = index
    while start and lines[start - 1].lstrip().startswith("#"):
        start -= 1
    return [_comment(each) for each in lines[start:index]]


def _comment(line: str) -> str:
    text = line.strip()
    return text.lstrip("#").strip() if text.startswith("#") else ""


def _docstring(following: ast.stmt | None) -> list[str]:
    """Return the lines of a statement that is nothing but a string."""
    value = following.value if isinstance(following, ast.Expr) else None
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        return inspect.cleandoc(value.value).splitlines()
    return []
