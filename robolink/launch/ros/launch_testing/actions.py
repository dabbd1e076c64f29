"""Actions of launch tests: the point at which they begin, and processes that are tests (`launch_testing.actions`)."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

from robolink.launch.ros.launch.actions import EmitEvent, ExecuteProcess, RegisterEventHandler, TimerAction
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from robolink.launch.ros.launch.event_handlers import OnProcessExit
from robolink.launch.ros.launch.events import matches_action
from robolink.launch.ros.launch.process_events import ShutdownProcess

__all__ = ["GTest", "PyTest", "ReadyToTest", "Test"]


class ReadyToTest(Action):
    """Begin the tests: here the launch file has come to the point from which on they make sense.

    Args:
        **kwargs: `condition`.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._callbacks: list[Callable[[], object]] = []

    def add_callback(self, callback: Callable[[], object]) -> None:
        """Call `callback` when the launch has come to this point."""
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> None:
        """Call the functions that wait for it; `context` is of no effect."""
        for each in self._callbacks:
            each()


class Test(ExecuteProcess):
    """Process that is a test.

    Args:
        timeout: Longest time that it may take, in seconds, after which it is ended; None has no limit.
        kill_timeout: Of no effect, as in ROS 2: what is ended is killed by the launch's own rules.
        **kwargs: Those of ExecuteProcess.
    """

    __test__ = False  # it is not a class of tests for pytest

    def __init__(
        self,
        *,
        timeout: float | SomeSubstitutionsType | None = None,
        kill_timeout: float | SomeSubstitutionsType = 5.0,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.timeout = timeout

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Start it in `context`, unless its condition is against it; return the timer that ends it."""
        following = super().visit(context)
        if self.timeout is None or (self.condition is not None and not self.condition.evaluate(context)):
            return following
        end = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(self)))
        timer = TimerAction(period=self.timeout, actions=[end])
        done = OnProcessExit(target_action=self, on_exit=lambda event, context: timer.cancel())
        return [*(following or ()), RegisterEventHandler(done), timer]


class GTest(Test):
    """Program of tests in C++.

    Args:
        path: Path of the program.
        **kwargs: Those of Test.
    """

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[path], **kwargs)
        self.path = path


class PyTest(Test):
    """Tests in Python, which pytest runs.

    Args:
        path: Path of the file or folder.
        **kwargs: Those of Test.
    """

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[sys.executable, "-m", "pytest", path], **kwargs)
        self.path = path
