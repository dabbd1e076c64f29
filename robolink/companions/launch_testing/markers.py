"""Marks of launch tests (`launch_testing.markers`)."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["keep_alive", "retry_on_failure"]

T = TypeVar("T", bound="Callable[..., Any]")


def keep_alive(test_description: T) -> T:
    """Return `test_description` as it is: tests go on here when the processes have ended."""
    return test_description


def retry_on_failure(*, times: int) -> Callable[[T], T]:
    """Return a decorator of a test: it fails only if an assertion fails so many times in a row.

    Args:
        times: Number of times that it is tried, from 1 on.
    """
    assert times > 0, "retry_on_failure(times=...) is 1 at least"

    def decorate(test: T) -> T:
        @functools.wraps(test)
        def tried(*args: Any, **kwargs: Any) -> Any:
            for _ in range(times - 1):
                try:
                    return test(*args, **kwargs)
                except AssertionError:
                    continue
            return test(*args, **kwargs)

        return tried  # type: ignore[return-value]

    return decorate
