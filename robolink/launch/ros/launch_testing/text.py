"""Comparison of a text, or of lines, with what is expected of it (`launch_testing.tools.text`)."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias, TypeVar

from robolink.launch.ros.launch.process_events import ProcessIO

__all__ = ["build_line_match", "build_text_match", "normalize_lineseps", "text_of", "without_escapes"]

Span: TypeAlias = "tuple[int, int]"
T = TypeVar("T")
Match: TypeAlias = "Callable[[T, int], Span | None]"
"""Function of an output and the position where it begins, which returns the positions of what it has found."""

_ESCAPES = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]")
_KINDS = "a text, a pattern or several of either"


def text_of(events: Iterable[ProcessIO]) -> str:
    """Return the text of pieces of output, `events`; bytes that are not UTF-8 are replaced."""
    return b"".join(each.text for each in events).decode(errors="replace")


def without_escapes(text: str) -> str:
    """Return `text` without the sequences that a terminal takes for colours and the like."""
    return _ESCAPES.sub("", text)


def normalize_lineseps(lines: str) -> str:
    """Return the text `lines` with newlines at the ends of its lines; a terminal writes a carriage return before."""
    return lines.replace(os.linesep, "\n").replace("\r\n", "\n")


def build_text_match(expected_text: Any, *, strict: bool = False) -> Callable[..., Span | None]:
    """Return a function of a text, and of the position where it begins: where is what was expected? None: nowhere.

    Args:
        expected_text: Text that is within the text, pattern that is searched, or several of either, which follow
            each other.
        strict: True takes the whole text, a pattern at the beginning, or several without a gap.

    Raises:
        ValueError: for anything else.
    """
    if isinstance(expected_text, str):
        return _text(expected_text, strict)
    if hasattr(expected_text, "search") and hasattr(expected_text, "match"):
        return _pattern(expected_text, strict)
    return _sequence([build_text_match(each) for each in _several(expected_text, "text")], strict)


def build_line_match(expected_lines: Any, *, strict: bool = False) -> Callable[..., Span | None]:
    """Return a function of lines, and of the index where it begins: where are those expected? None: nowhere.

    Args:
        expected_lines: Text that is within a line, pattern that matches its beginning, or several of either, which
            follow each other.
        strict: True takes all lines, or several that follow each other without a gap.

    Raises:
        ValueError: for anything else.
    """
    if isinstance(expected_lines, str):
        text = expected_lines
        return _lines((lambda line: line == text) if strict else (lambda line: text in line), strict)
    if hasattr(expected_lines, "match"):
        return _lines(lambda line: expected_lines.match(line) is not None, strict)
    return _sequence([build_line_match(each) for each in _several(expected_lines, "lines")], strict)


def _several(expected: Any, what: str) -> list[Any]:
    some = list(expected) if isinstance(expected, Iterable) else []
    if not some:
        raise ValueError(f"the expected {what} is {_KINDS}, got {expected!r:.60}")
    return some


def _text(expected: str, strict: bool) -> Callable[..., Span | None]:
    def match(actual_text: str, start: int = 0) -> Span | None:
        actual = normalize_lineseps(actual_text)
        found = start if actual[start:] == expected else -1
        if not strict:
            found = actual.find(expected, start)
        return None if found < 0 else (found, found + len(expected))

    return match


def _pattern(expected: re.Pattern[str], strict: bool) -> Callable[..., Span | None]:
    def match(actual_text: str, start: int = 0) -> Span | None:
        find = expected.match if strict else expected.search
        found = find(normalize_lineseps(actual_text), start)
        return None if found is None else found.span()

    return match


def _lines(is_it: Callable[[str], bool], strict: bool) -> Callable[..., Span | None]:
    def match(actual_lines: Sequence[str], start: int = 0) -> Span | None:
        if strict:
            return (start, len(actual_lines)) if all(map(is_it, actual_lines[start:])) else None
        found = (at for at in range(start, len(actual_lines)) if is_it(actual_lines[at]))
        return next(((at, at + 1) for at in found), None)

    return match


def _sequence(parts: Sequence[Match[T]], strict: bool) -> Callable[..., Span | None]:
    def match(actual: T, start: int = 0) -> Span | None:
        first: int | None = None
        at = start
        for part in parts:
            found = part(actual, at)
            if found is None or (strict and found[0] != at):
                return None
            first = found[0] if first is None else first
            at = found[1]
        return None if first is None else (first, at)

    return match
