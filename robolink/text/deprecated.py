"""Deprecation of robolink's own functions: a decorator whose warning names what to use instead, and since when.

The policy is in CONTRIBUTING.md: what is deprecated works for two more minor versions, then it is removed. A test finds
each use of the decorator, and fails when its time is over. Names of rclpy follow rclpy.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

MINOR_VERSIONS = 2
"""Minor versions for which a deprecated function goes on working."""


def deprecated(since: str, instead: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a function that will be removed, so that a call warns.

    Args:
        since: First version in which it is deprecated: "0.3".
        instead: What to use in its place, as one would write it.

    Raises:
        TypeError: for a class, which would be none any more: decorate its `__init__`.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        if isinstance(function, type):
            raise TypeError(f"deprecated takes functions: decorate the __init__ of {function.__name__}")
        name = f"{function.__module__}.{function.__qualname__}"
        words = f"{name} is deprecated since {since} and ends with {end_of(since)}: use {instead}"

        @functools.wraps(function)
        def warning(*args: P.args, **kwargs: P.kwargs) -> R:
            warnings.warn(words, DeprecationWarning, stacklevel=2)
            return function(*args, **kwargs)

        return warning

    return decorate


def end_of(since: str) -> str:
    """Return the first version without what is deprecated since a version: two minor versions later."""
    major, minor = (int(each) for each in since.split(".")[:2])
    return f"{major}.{minor + MINOR_VERSIONS}"
