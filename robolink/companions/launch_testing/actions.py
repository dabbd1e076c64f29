"""Actions of launch files that are tests (`launch_testing.actions`)."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.bases import Action, Condition, Event, LaunchContext

__all__ = ["GTest", "ReadyToTest", "TestProcess"]


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
