"""Names by which a launch file declares its test: ReadyToTest, `parametrize`, `keep_alive` and others."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from robolink.launch.ros.launch.bases import (
    Action,
    Condition,
    Event,
    LaunchArgumentError,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeEntitiesType,
    entities_in,
)
from robolink.launch.ros.launch.event_handlers import OnProcessIO
from robolink.launch.ros.launch.events import ProcessIO

__all__ = [
    "GTest",
    "LaunchTestService",
    "ReadyToTest",
    "StdoutReadyListener",
    "TestProcess",
    "keep_alive",
    "retry_on_failure",
]


class ReadyEvent(Event):
    """The processes are started: the tests may begin."""

    name = "launch_testing.events.Ready"


class ReadyToTest(Action):
    """Begin the tests: here the launch file has come to the point from which on they make sense.

    Args:
        **kwargs: `condition`.
    """

    def execute(self, context: LaunchContext) -> None:
        """Emit the event for which the tests wait, in `context`."""
        context.emit_event_sync(ReadyEvent())


class TestProcess(Action):
    """Process that is a test: it is left out with a line.

    Args:
        *args: Those of ROS 2, of no effect.
        condition: Condition without which nothing is said.
        **kwargs: Those of ROS 2, of no effect.
    """

    __test__ = False  # it is not a class of tests for pytest

    def __init__(self, *args: Any, condition: Condition | None = None, **kwargs: Any) -> None:
        super().__init__(condition=condition)

    def execute(self, context: LaunchContext) -> None:
        """Add a line to `context`: it is left out."""
        context.said.append(f"left out: a {type(self).__name__}, since robolink runs no programs of tests")


class GTest(TestProcess):
    """Program of tests in C++: it is left out with a line."""


class StdoutReadyListener(OnProcessIO):
    """Reaction to a text that a process writes once it is ready.

    Args:
        target_action: The action that starts the process; None is any.
        ready_txt: The text, which is within a line.
        actions: What follows, such as a ReadyToTest.
    """

    def __init__(self, *, target_action: Action | None = None, ready_txt: str, actions: SomeEntitiesType) -> None:
        self._text, self._actions = ready_txt, actions
        super().__init__(target_action=target_action, on_stdout=self._follow)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description for people, and what follows."""
        return type(self).__name__, entities_in(self._actions)

    def _follow(self, event: ProcessIO) -> SomeEntitiesType | None:
        return self._actions if self._text in event.text.decode(errors="replace") else None


class LaunchTestService:
    """Test runner within a program, which robolink has not: LaunchError is raised.

    Args:
        *args: Those of ROS 2, of no effect.
        **kwargs: Those of ROS 2, of no effect.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise LaunchError(
            "there is no LaunchTestService here: 'pytest FILE' runs files with generate_test_description()"
        )


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


PARAMETERS = "launch_test_parameters"
"""Attribute of the function with the arguments of each launch."""

Describe = Callable[..., Any]


def parametrize(argnames: str, argvalues: Iterable[Any]) -> Callable[[Describe], Describe]:
    """Return a decorator of generate_test_description: it is called once for each of the values.

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
        def described(**kwargs: Any) -> Any:
            return describe(**kwargs)

        inner = getattr(describe, PARAMETERS, [{}])
        both = [{**of_inner, **dict(zip(names, row, strict=True))} for row in rows for of_inner in inner]
        setattr(described, PARAMETERS, both)
        return described

    return decorate
