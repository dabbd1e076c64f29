"""Tracebacks as text, with the nearest name for one that is misspelt also where Python's own module has none."""

from __future__ import annotations

import contextlib
import sys
import traceback
from collections.abc import Iterable
from types import TracebackType

from robolink.exceptions import RobolinkError, nearest


def formatted(error: BaseException, trace: TracebackType | None = None) -> str:
    """Return an exception with its traceback, from `trace` on (by default all of it), without a newline at the end."""
    lines = traceback.format_exception(type(error), error, trace or error.__traceback__)
    return "".join(lines).rstrip() + (suggestion(error) if sys.version_info < (3, 12) else "")


def suggestion(error: BaseException) -> str:
    """Return the words that name what a NameError or AttributeError probably meant; '' if nothing is near.

    Python 3.10 and 3.11 have them only where the interpreter itself prints the exception.
    """
    name = getattr(error, "name", None)
    if not isinstance(name, str) or isinstance(error, RobolinkError):
        return ""
    known: Iterable[str] = ()
    if isinstance(error, NameError):
        known = _names_at(error.__traceback__)
    elif isinstance(error, AttributeError):
        with contextlib.suppress(Exception):  # somebody's __dir__
            known = dir(error.obj)
    found = nearest(name, (each for each in known if isinstance(each, str) and each != name))
    return found.replace(" (did you mean ", ". Did you mean: ").replace("?)", "?")


def _names_at(trace: TracebackType | None) -> list[str]:
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    frame = None if trace is None else trace.tb_frame
    return [] if frame is None else [*frame.f_locals, *frame.f_globals, *frame.f_builtins]
