"""Callbacks in errors: where one is defined, and how its `def` has to look."""

from __future__ import annotations

import re
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, NamedTuple

from robolink.system.patterns import late

_MISCALLED = late(r"(?:[\w.<>]+\.)?(\w+)\(\) (?:takes|missing) ")
"""Python's text for a call with too many or too few arguments."""


class Place(NamedTuple):
    """File and line of a definition."""

    file: str
    line: int

    def __str__(self) -> str:
        from pathlib import Path  # late: it takes a node's start 3 ms

        return f"{Path(self.file).name}:{self.line}"


def definition(function: Callable[..., Any]) -> Place | None:
    """Return where a function or method is defined; None for one that has no `def` in a file."""
    import inspect  # late: it takes a node's start 5 ms

    code = getattr(inspect.unwrap(getattr(function, "__func__", function)), "__code__", None)
    if code is None or code.co_name == "<lambda>":
        return None
    return Place(code.co_filename, code.co_firstlineno)


def named(function: Callable[..., Any]) -> str:
    """Return a callback's name and place, as ``on_go (careful.py:22)``, or what else it is."""
    place = definition(function)
    return f"{function.__name__} ({place})" if place is not None else str(function)


def signature_of(function: Callable[..., Any], takes: tuple[str, ...]) -> str:
    """Return how a callback has to be defined and where it is: ``write `def on_timer(self):` (careful.py:10)``.

    Args:
        function: The callback.
        takes: Names of the arguments that it gets.

    Returns:
        An empty text for what has no `def`.
    """
    place = definition(function)
    if place is None:
        return ""
    names = ("self", *takes) if hasattr(function, "__self__") else takes
    return f"write `def {function.__name__}({', '.join(names)}):` ({place})"


def callback_of(error: BaseException) -> tuple[Callable[..., Any], tuple[str, ...]] | None:
    """Return the callback that an error is about, and the names of what it gets; None for errors of other things.

    It is about one if it was raised where a timer or a service calls it, or looks at what it returned, and not within.
    """
    entity = _raiser(error)
    takes = getattr(type(entity), "CALLBACK_TAKES", None)
    function = getattr(entity, "callback", None)
    return None if takes is None or function is None else (function, takes)


def _raiser(error: BaseException) -> Any:
    """Return the object whose method raised a TypeError, called by robolink itself; None for other errors."""
    frames = _frames(error.__traceback__)[-2:]
    own = [frame.f_globals.get("__name__", "").startswith("robolink.") for frame in frames]
    return frames[-1].f_locals.get("self") if own == [True, True] and isinstance(error, TypeError) else None


def _frames(trace: TracebackType | None) -> list[FrameType]:
    found = list[FrameType]()
    while trace is not None:
        found.append(trace.tb_frame)
        trace = trace.tb_next
    return found


def miscalled(error: BaseException) -> str:
    """Return how a callback has to be defined that takes other arguments than it gets; '' for other errors."""
    found = callback_of(error)
    named = _MISCALLED.match(str(error))
    if found is None or named is None or named[1] != getattr(found[0], "__name__", ""):
        return ""
    return signature_of(*found)


def place_of(error: BaseException) -> Place | None:
    """Return where the callback stands that an error is about, since no line of it is in the traceback.

    For a timer that was made without one, it is where the timer was made.
    """
    found = callback_of(error)
    if found is None:
        made_at = getattr(_raiser(error), "made_at", None)
        return made_at if isinstance(made_at, Place) else None
    if _MISCALLED.match(str(error)) and not miscalled(error):
        return None
    return definition(found[0])


def call_instead_of_function(place: Place) -> str:
    """Return the call in a line that should have named a function: ``self.tick()``; '' if there is none.

    Args:
        place: Place of a call such as ``self.create_timer(1.0, self.tick())``.
    """
    import linecache

    found = re.search(r",\s*((?:self\.)?\w+\(\))", linecache.getline(place.file, place.line))
    return found[1] if found else ""
