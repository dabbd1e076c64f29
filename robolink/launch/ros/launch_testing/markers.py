"""Decorators of launch tests: `parametrize`, `keep_alive`, `retry_on_failure` and others."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from robolink.launch.ros.launch.bases import LaunchArgumentError

__all__ = ["keep_alive", "parametrize", "post_shutdown_test", "ready_to_test_action_timeout", "retry_on_failure"]

Describe = Callable[..., Any]
T = TypeVar("T", bound="Callable[..., Any]")
C = TypeVar("C", bound=type)

MARKERS = "__markers__"
"""Attribute of generate_test_description with its markers by name, as in ROS 2."""
PARAMETRIZED = "__parametrized__"
"""Attribute of a generate_test_description that yields a function for each launch, as in ROS 2."""
TIMEOUT = "__ready_to_test_action_timeout__"
"""Attribute of generate_test_description with the timeout of its ReadyToTest, as in ROS 2."""
POST_SHUTDOWN = "__post_shutdown_test__"
"""Attribute of a class of tests that run when the processes have ended, as in ROS 2."""


def keep_alive(test_description: T) -> T:
    """Return `test_description`, marked: the launch goes on when its processes have ended."""
    markers: dict[str, Any] = vars(test_description).setdefault(MARKERS, {})
    markers["keep_alive"] = True
    return test_description


def ready_to_test_action_timeout(timeout: float) -> Callable[[T], T]:
    """Return a decorator of generate_test_description.

    Args:
        timeout: Longest wait for its ReadyToTest, in seconds; it is 15 without the decorator.
    """

    def decorate(test_description: T) -> T:
        setattr(test_description, TIMEOUT, timeout)
        return test_description

    return decorate


def post_shutdown_test() -> Callable[[C], C]:
    """Return a decorator by which a class of tests runs after the processes have ended."""

    def decorate(cls: C) -> C:
        if not isinstance(cls, type):
            raise LaunchArgumentError(f"post_shutdown_test() decorates a class of tests, got {type(cls).__name__}")
        setattr(cls, POST_SHUTDOWN, True)
        return cls

    return decorate


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[T], T]:
    """Return a decorator of a test: it fails only if an assertion fails so many times in a row.

    Args:
        times: Number of times that it is tried, from 1 on.
        delay: Time between two tries, in seconds; None is none.
    """
    assert times > 0, "retry_on_failure(times=...) is 1 at least"

    def decorate(test: T) -> T:
        @functools.wraps(test)
        def tried(*args: Any, **kwargs: Any) -> Any:
            for _ in range(times - 1):
                try:
                    return test(*args, **kwargs)
                except AssertionError:
                    time.sleep(delay or 0.0)
            return test(*args, **kwargs)

        return tried  # type: ignore[return-value]

    return decorate


def parametrize(argnames: str, argvalues: Iterable[Any]) -> Callable[[Describe], Describe]:
    """Return a decorator of generate_test_description: there is a launch for each of the values.

    The decorated function is a generator: it yields a function of the remaining arguments, and the values by name, for
    each launch.

    Args:
        argnames: Names of its arguments, parted by commas.
        argvalues: Values, each a tuple if there are several names.

    Raises:
        LaunchArgumentError: for values that do not fit the names.
    """
    names = [each.strip() for each in argnames.split(",") if each.strip()]
    rows = [each if isinstance(each, tuple) else (each,) for each in argvalues]
    for row in rows:
        if len(row) != len(names):
            raise LaunchArgumentError(
                f"parametrize has {len(names)} names, and a row with {len(row)} values: {row!r:.60}"
            )

    def decorate(describe: Describe) -> Describe:
        @functools.wraps(describe)
        def described() -> Iterator[tuple[Describe, dict[str, Any]]]:
            for row in rows:
                own = dict(zip(names, row, strict=True))
                for inner, of_inner in launches(describe):
                    yield functools.update_wrapper(functools.partial(inner, **own), inner), {**of_inner, **own}

        setattr(described, PARAMETRIZED, True)
        return described

    return decorate


def launches(describe: Describe) -> list[tuple[Describe, dict[str, Any]]]:
    """Return the functions that describe a launch each, and their values by name, of `describe`."""
    return list(describe()) if getattr(describe, PARAMETRIZED, False) else [(describe, {})]
