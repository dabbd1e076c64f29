"""Mistakes of a student's file: syntax errors and exceptions, each with its line, as one clear block."""

from __future__ import annotations

import ast
import linecache
import traceback
from pathlib import Path
from typing import Literal

from msgspec import Struct
from msgspec.structs import force_setattr

from robolink.exceptions import RobolinkError
from robolink.system.files import LONGEST_SOURCE, read_plain
from robolink.testing.expectations import NodeFailure
from robolink.text.callbacks import place_of
from robolink.text.tracebacks import advised

Kind = Literal[
    "syntax",
    "empty",
    "exception",
    "elsewhere",
    "stuck",
    "stuck somewhere",
    "asleep",
    "too large",
    "input",
    "ended",
    "ended all",
    "file",
    "lacks",
    "types",
    "use",
    "check",
    "no program",
]

LONGEST_TEXT = 1000
"""Longest text of a mistake or a sentence, in letters."""
LONGEST = 500
"""Longest text of an exception that is shown, in letters."""


def fit_text(text: str) -> str:
    r"""Return a text cut to `LONGEST_TEXT`, with `\ud800` for a surrogate, which JSON lacks."""
    short = text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]} ..."
    return short.encode("utf-8", "backslashreplace").decode()


class Mistake(Struct, frozen=True):
    """Mistake that ended a check: its kind, its text, and the line of the student's file with its code."""

    kind: Kind
    text: str = ""
    line: int = 0
    code: str = ""

    def __post_init__(self) -> None:
        force_setattr(self, "text", fit_text(self.text))
        force_setattr(self, "code", fit_text(self.code))


def mistake_in(file: Path) -> Mistake | None:
    """Return the mistake that keeps a file from being run at all, such as a syntax error; None if it can be run."""
    try:
        text = read_plain(file, LONGEST_SOURCE).decode("utf-8-sig")  # Windows' editors may begin with a mark
    except OSError as error:
        return Mistake("file", f"{file.name}: {error.strerror or error}")
    except UnicodeDecodeError:
        return Mistake("file", f"{file.name}: not UTF-8: save it with this encoding")
    if file.suffix != ".py":
        return Mistake("empty") if _has_only_comments(text) else None
    try:
        tree = ast.parse(text, str(file))
    except SyntaxError as error:
        return _of_syntax(error)
    except (ValueError, RecursionError, MemoryError) as error:  # null characters; brackets of a thousand levels
        return Mistake("file", f"{file.name}: {type(error).__name__}: {error}".removesuffix(": "))
    return Mistake("empty") if all(map(_is_text, tree.body)) else None


def _has_only_comments(text: str) -> bool:
    """Return whether a YAML file has nothing else."""
    return all(not line.strip() or line.lstrip().startswith("#") for line in text.splitlines())


def _is_text(statement: ast.stmt) -> bool:
    """Return whether a statement is a text alone, such as a docstring."""
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


def mistake_of(error: BaseException, file: Path) -> Mistake | None:
    """Return the mistake that an exception shows in a student's file; None if it came from elsewhere.

    Args:
        error: What a check raised.
        file: The student's file.
    """
    if isinstance(error, NodeFailure):
        if error.__cause__ is None:
            return Mistake("ended", str(error).partition("\n")[0][:LONGEST])
        error = error.__cause__
    if isinstance(error, SyntaxError) and error.filename == str(file):
        return _of_syntax(error)
    lines = [each.lineno or 0 for each in traceback.extract_tb(error.__traceback__) if _is(each.filename, file)]
    place = place_of(error)
    if place is not None and _is(place.file, file):
        lines.append(place.line)
    if lines:
        code = line_of(file, lines[-1])
        is_input = isinstance(error, EOFError) and "input(" in code
        return Mistake("input" if is_input else "exception", _shortly(_text(error), file), lines[-1], code)
    if isinstance(error, RobolinkError):
        return Mistake("file", _shortly(_plain_text(error), file))
    return None


def mistake_elsewhere(error: BaseException) -> Mistake:
    """Return the mistake of a program that failed at none of its own lines."""
    return Mistake("elsewhere", _text(error))


def line_of(file: Path, number: int) -> str:
    """Return a line of a student's file, as it is now; numbers begin at 1."""
    linecache.checkcache(str(file))
    return linecache.getline(str(file), number).rstrip()


def _is(filename: str, file: Path) -> bool:
    return filename == str(file) or (Path(filename).name == file.name and Path(filename).resolve() == file.resolve())


def _of_syntax(error: SyntaxError) -> Mistake:
    return Mistake("syntax", f"{type(error).__name__}: {error.msg}", error.lineno or 1, (error.text or "").rstrip())


def _text(error: BaseException) -> str:
    text = "".join(traceback.format_exception_only(type(error), error)).strip()
    text = text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
    if isinstance(error, RobolinkError):
        text = f"{type(error).__name__}: {_plain_text(error)}"
    return advised(text, error)


def _shortly(text: str, file: Path) -> str:
    """Return a text in which the student's file has its short name."""
    return text.replace(str(file), file.name)


def _plain_text(error: RobolinkError) -> str:
    return str(error).partition("\nreplay:")[0].partition("\nwhat came last:")[0][:LONGEST]
