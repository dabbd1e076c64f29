"""Default context, and small functions for the arguments, the middleware and timeouts of a program."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from robolink.running.defaults import get_defaults

if TYPE_CHECKING:
    from robolink.context import Context

_lock = threading.Lock()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the context that is used where none is named; a new one once the last was shut down.

    With `shutting_down` it is forgotten at the same time, so that the next call returns a new one.
    """
    from robolink.context import Context

    defaults = get_defaults()
    with _lock:
        if defaults.context is None:
            defaults.context = Context()
        context: Context = defaults.context
        if shutting_down:
            defaults.context = None
        return context


def set_default_context(context: Context | None) -> None:
    """Make `context` the default one: how tests run programs that know nothing of contexts."""
    with _lock:
        get_defaults().context = context


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return those of `args` that are not ROS's; None is `sys.argv`."""
    from robolink.arguments.command_line import remove_ros_args as remove

    return remove(sys.argv if args is None else args)


def ok(*, context: Context | None = None) -> bool:
    """True if `context`, by default the default one, is initialized and has not ended."""
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None) -> None:
    """Shut down `context`, by default the default one. Raises RuntimeError if there is nothing to shut down."""
    (get_default_context(shutting_down=True) if context is None else context).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """Shut down `context`, by default the default one, unless it is not initialized or has been shut down."""
    if context is not None:
        context.try_shutdown()
        return
    get_default_context().try_shutdown()
    set_default_context(None)


def get_rmw_implementation_identifier() -> str:
    """Return the name of the middleware whose wire this is."""
    return "rmw_zenoh_cpp"


def get_available_rmw_implementations() -> set[str]:
    """Return the names of all middlewares, or of those that RMW_IMPLEMENTATIONS lists (parted as PATH is).

    Raises RuntimeError if it lists one that is not there.
    """
    there = {get_rmw_implementation_identifier()}
    expected = {each for each in os.environ.get("RMW_IMPLEMENTATIONS", "").split(os.pathsep) if each}
    if expected - there:
        raise RuntimeError(f"RMW_IMPLEMENTATIONS: there is no {', '.join(sorted(expected - there))}, only {min(there)}")
    return expected or there


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Return `timeout_sec` seconds in nanoseconds; -1, for ever, for None and below zero."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(float(timeout_sec) * 1e9)
