"""Actions of launch files that are tests (`launch_testing.actions`)."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.bases import Action, Condition, LaunchContext

__all__ = ["GTest", "ReadyToTest", "TestProcess"]


class ReadyToTest(Action):
    """Start of the tests, which are not run here: nothing is done.

    Args:
        **kwargs: `condition`.
    """


class TestProcess(Action):
    """Process that is a test: it is left out with a line.

    Args:
        *args: Those of ROS 2, of no effect.
        condition: Condition without which nothing is said.
        **kwargs: Those of ROS 2, of no effect.
    """

    __test__ = False  # it is no class of tests for pytest

    def __init__(self, *args: Any, condition: Condition | None = None, **kwargs: Any) -> None:
        super().__init__(condition=condition)

    def execute(self, context: LaunchContext) -> None:
        """Add a line to `context`: it is left out."""
        context.said.append(f"left out: a {type(self).__name__}, since 'robolink launch' runs no tests")


class GTest(TestProcess):
    """Program of tests in C++: it is left out with a line."""
