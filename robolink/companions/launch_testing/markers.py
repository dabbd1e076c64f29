"""Marks of the functions that describe a launch (`launch_testing.markers`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["keep_alive"]

T = TypeVar("T", bound="Callable[..., Any]")


def keep_alive(test_description: T) -> T:
    """Return `test_description` as it is: `robolink launch` ends with its processes."""
    return test_description
