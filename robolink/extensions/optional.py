"""Optional parts of robolink: folders that an installation may lack, imported by name when something needs them.

A part's folder can be deleted, and what stays says in one line that the part is not there. `python -m
tools.without_annex` lists the parts and tries this for each.
"""

from __future__ import annotations

import importlib
import os
from contextlib import AbstractContextManager
from typing import Any, Protocol

from robolink.exceptions import RobolinkError

PAGE = "robolink.view:page_of"
"""Target of the page for the browser."""

PARTICIPANT = "robolink.rtps:Participant"
"""Target of the participant that meets DDS."""

DETOURS = "robolink.navigation.detours:Detours"
"""Target of the planner of ways round obstacles."""

_PACKAGE = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # noqa: PTH120 - pathlib takes a start 3 ms


class MissingPartError(RobolinkError, ImportError):
    """A part of robolink that this installation lacks."""


class Page(Protocol):
    """Page for the browser that is being served."""

    @property
    def address(self) -> str:
        """Return its address, with the token that lets a browser change something."""

    @property
    def port(self) -> int:
        """Return the port at which it is served."""

    @property
    def exposed(self) -> bool:
        """Return whether other machines can open it."""


def is_here(target: str) -> bool:
    """Return whether this installation has a part; nothing is imported.

    Args:
        target: A module of robolink, or MODULE:NAME.
    """
    path = "/".join([_PACKAGE, *target.partition(":")[0].split(".")[1:]])
    return os.path.isfile(f"{path}/__init__.py") or os.path.isfile(f"{path}.py")  # noqa: PTH113


def check(target: str, what: str) -> None:
    """Raise MissingPartError if this installation lacks a part.

    Args:
        target: A module of robolink, or MODULE:NAME.
        what: The part in words, such as "'robolink view'".
    """
    if not is_here(target):
        raise MissingPartError(f"{what} is not part of this installation of robolink")


def part(target: str, what: str) -> Any:
    """Return the object MODULE:NAME of an optional part.

    Args:
        target: MODULE:NAME.
        what: The part in words, such as "'robolink view'".

    Raises:
        MissingPartError: (an ImportError) If this installation lacks it.
    """
    check(target, what)
    module, _, name = target.partition(":")
    return getattr(importlib.import_module(module), name)


def check_page() -> None:
    """Raise MissingPartError if this installation lacks the page for the browser."""
    check(PAGE, "'robolink view'")


def page(node: Any, *, port: int | None = None, exercises: Any = None) -> AbstractContextManager[Page]:
    """Return the page for the browser, which is served while the block runs.

    Args:
        node: Node that looks at the running system.
        port: Port; None takes the default one, or the next that is free.
        exercises: Exercises for the panel `learn`, with the methods of `robolink.view.server.learning.Exercises`.

    Raises:
        MissingPartError: (an ImportError) If this installation lacks `robolink view`.
    """
    found: AbstractContextManager[Page] = part(PAGE, "'robolink view'")(node, port, exercises)
    return found
