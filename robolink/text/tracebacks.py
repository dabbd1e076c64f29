"""Formatting of tracebacks, with suggestions for misspelt names where Python itself has none."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any

import robolink.exceptions
from robolink.exceptions import RobolinkError, closest
from robolink.system.patterns import late
from robolink.text.advice import advice
from robolink.text.callbacks import place_of

if TYPE_CHECKING:
    import ast


def formatted(error: BaseException, trace: TracebackType | None = None) -> str:
    """Return an exception and its traceback as text, from `trace` on (default: all), without a final newline."""
    import linecache  # late, as in all modules that describe errors: most programs make none
    import traceback

    trace = trace or error.__traceback__
    _leave_out_search(trace)
    _leave_out_check(trace)
    head, newline, last = "".join(traceback.format_exception(type(error), error, trace)).rstrip().rpartition("\n")
    place = place_of(error)
    if place is not None:
        linecache.checkcache(place.file)  # the traceback has no line of it, and robolink's say nothing of the mistake
        head = f'  File "{place.file}", line {place.line}\n    {linecache.getline(place.file, place.line).strip()}'
    return head + newline + advised(last, error)


def advised(text: str, error: BaseException) -> str:
    """Return the last line of an exception with what is better than Python's own suggestion, or lacks one.

    Args:
        text: The line, as Python formats it; its version decides whether a suggestion is there.
        error: The exception.
    """
    bare = _SUGGESTED.sub("", text)
    if advising := advice(error):
        return f"{bare}; {advising}"
    return text if text != bare and not _PRIVATE.search(text) else bare + suggestion(error)


_SUGGESTED = late(r"\. Did you (mean|forget)[^?]*\?$")
_PRIVATE = late(r"attribute '[^_]\w*'\. Did you mean: '_")
"""A suggestion of Python's that names something inside robolink: `_timers` for `on_timer`."""


def _leave_out_search(trace: TracebackType | None) -> None:
    """Cut the end of a traceback where a node looks for an attribute that it lacks."""
    while trace is not None and trace.tb_next is not None:
        code = trace.tb_next.tb_frame
        if code.f_code.co_name == "__getattr__" and code.f_globals.get("__name__") == "robolink.node":
            trace.tb_next = None
            return
        trace = trace.tb_next


def _leave_out_check(trace: TracebackType | None) -> None:
    """Cut the end of a traceback where robolink refuses what the program gave it: the error says what and why.

    The line tells a refusal from a fault of ours, whose frames are needed: it raises the error by a statement.
    """
    import linecache

    users = None
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if not file.startswith((_OWN, "<")):
            users = trace
        elif trace.tb_next is None and linecache.getline(file, trace.tb_lineno).lstrip().startswith("raise "):
            if users is not None:
                users.tb_next = None
            return
        trace = trace.tb_next


_ENTRY = late(r' +File "([^"]+)", line \d+')
_OWN = os.path.dirname(robolink.exceptions.__file__)  # noqa: PTH120 - pathlib takes a node's start 3 ms


def without_own_frames(text: str) -> str:
    """Return a text without the lines of its tracebacks that tell of robolink's own files, and without `^^^^`."""
    lines = []
    is_own = False
    for line in text.split("\n"):
        entry = _ENTRY.match(line)
        if entry:
            is_own = entry[1].startswith((_OWN, "<"))
        elif not line.startswith("    "):
            is_own = False
        if not is_own and not (line.strip() and set(line.strip()) <= {"^", "~"}):
            lines.append(line)
    return "\n".join(lines)


def suggestion(error: BaseException) -> str:
    """Return a suggestion for a misspelt name or field of a message; '' if nothing is near.

    Python 3.10 and 3.11 have them for names only where the interpreter itself prints the exception.
    """
    field = misspelt_field(error)
    if field:
        return field
    name = getattr(error, "name", None)
    if not isinstance(name, str) or isinstance(error, RobolinkError):
        return ""
    known: Iterable[str] = ()
    if isinstance(error, NameError):
        known = _names_at(error.__traceback__)
    elif isinstance(error, AttributeError):
        fields = getattr(type(error.obj), "__ros_fields__", None)
        if fields:
            return _did_you_mean(name, fields) or f" (only {', '.join(fields)})"
        with contextlib.suppress(Exception):  # somebody's __dir__
            known = [each for each in dir(error.obj) if not each.startswith("_") or name.startswith("_")]
    return _did_you_mean(name, (each for each in known if isinstance(each, str) and each != name))


def _did_you_mean(name: str, known: Iterable[str]) -> str:
    close = closest(name, known)
    return f". Did you mean: '{close}'?" if close else ""


def _names_at(trace: TracebackType | None) -> list[str]:
    last = _last(trace)
    return [] if last is None else [*last.tb_frame.f_locals, *last.tb_frame.f_globals, *last.tb_frame.f_builtins]


def _last(trace: TracebackType | None) -> TracebackType | None:
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return trace


# --- Fields of messages -----------------------------------------------------------------------------------------------

_UNKNOWN_FIELD = late(r"'\w+' object has no attribute '(\w+)'")


def misspelt_field(error: BaseException) -> str:
    """Return a suggestion for the field in `twist.liner = 3`; '' for other errors.

    Messages are changed by C, which a look at each field would slow down several times over. So which message
    it was is read from the line that failed.
    """
    found = _UNKNOWN_FIELD.fullmatch(str(error)) if isinstance(error, AttributeError) else None
    last = _last(error.__traceback__)
    if found is None or last is None:
        return ""
    with contextlib.suppress(Exception):  # a source that is gone, or has changed; anybody's attributes
        for node in _statement(last):
            fields = getattr(_meant(node, found[1], last), "__ros_fields__", None)
            if fields:
                return _did_you_mean(found[1], fields) or f" (only {', '.join(fields)})"
    return ""


def _statement(trace: TracebackType) -> Iterator[ast.AST]:
    """Yield the syntax nodes of the smallest statement around the line that failed."""
    import ast  # late: most programs have no such error
    import linecache

    tree = ast.parse("".join(linecache.getlines(trace.tb_frame.f_code.co_filename, trace.tb_frame.f_globals)))
    line = trace.tb_lineno
    around = [each for each in ast.walk(tree) if isinstance(each, ast.stmt) and each.lineno <= line <= _end(each)]
    yield from ast.walk(min(around, key=lambda each: _end(each) - each.lineno))


def _end(node: ast.stmt) -> int:
    return node.end_lineno or node.lineno


def _meant(node: ast.AST, name: str, trace: TracebackType) -> Any:
    """Return the message of which this part of a statement names a field `name`; None if it names none."""
    import ast

    if isinstance(node, ast.Attribute) and node.attr == name:
        return _value(node.value, trace)
    return None


def _value(node: ast.expr, trace: TracebackType) -> Any:
    """Return the value of a dotted name, without calling any code of the user's."""
    import ast
    import inspect

    if isinstance(node, ast.Name):
        return {**trace.tb_frame.f_globals, **trace.tb_frame.f_locals}[node.id]
    if isinstance(node, ast.Attribute):
        owner = _value(node.value, trace)
        is_message = hasattr(type(owner), "__ros_fields__")
        return getattr(owner, node.attr) if is_message else inspect.getattr_static(owner, node.attr)
    return None
