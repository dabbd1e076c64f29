"""Tests of a launch that a program runs itself with LaunchService (`launch_testing.legacy`)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from typing import Any

from robolink.launch.ros.launch.actions import EmitEvent, ExecuteLocal, RegisterEventHandler
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchDescriptionEntity
from robolink.launch.ros.launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnShutdown
from robolink.launch.ros.launch.events import ExecutionComplete, Shutdown
from robolink.launch.ros.launch.process_events import ProcessExited, ProcessIO
from robolink.launch.ros.launch.sources import LaunchDescription
from robolink.launch.ros.launch_testing import actions
from robolink.launch.ros.launch_testing.legacy import output
from robolink.launch.ros.launch_testing.legacy.output import OutputTest

__all__ = ["LaunchTestService", "actions", "output"]


_RUNNING, _FINISHED, _DROPPED, _FAILED, _SUCCEEDED = "running", "finished", "dropped", "failed", "succeeded"
_Following = list[LaunchDescriptionEntity]


class LaunchTestService:
    """Tests in a launch description: the launch ends when all are done, or when one has failed.

    What belongs to a test is added to the description; then `run` runs the launch.
    """

    def __init__(self) -> None:
        self._states: dict[str, str] = {}
        self._codes: dict[str, int] = {}
        """Exit codes of processes that should have ended otherwise, by name."""
        self._numbers = itertools.count(1)

    def add_fixture_action(
        self, launch_description: LaunchDescription, action: Action, exit_allowed: bool | Iterable[int] = (0,)
    ) -> Action:
        """Add an action that the tests need; if it is a process, its early end ends the launch.

        Args:
            launch_description: The description.
            action: The action, which is returned.
            exit_allowed: Exit codes with which its process may end; True for any.
        """
        launch_description.add_action(action)
        if isinstance(action, ExecuteLocal):
            allowed = exit_allowed if isinstance(exit_allowed, bool) else frozenset(exit_allowed)

            def ended(event: ProcessExited, context: LaunchContext) -> _Following:
                is_fine = allowed if isinstance(allowed, bool) else event.returncode in allowed
                if context.is_shutdown or is_fine:
                    return []
                self._codes[event.process_name] = event.returncode or 1
                return _shutdown(f"{event.process_name}, which the tests need, has ended with {event.returncode}")

            _react(launch_description, OnProcessExit(target_action=action, on_exit=ended))
        return action

    def add_test_action(self, launch_description: LaunchDescription, action: Action) -> Action:
        """Add an action that is a test: a process, which should end with 0, or an action that should raise nothing.

        Args:
            launch_description: The description.
            action: The action, which is returned.
        """
        name = self._arm("test")

        def ended(event: ProcessExited, context: LaunchContext) -> _Following:
            if event.returncode == 0:
                return self._settle(name, _SUCCEEDED)
            self._codes[event.process_name] = event.returncode
            return self._fail(name, f"the test {event.process_name} has ended with {event.returncode}")

        def completed(event: ExecutionComplete, context: LaunchContext) -> _Following:
            future = event.action.get_asyncio_future()
            if future is not None and future.cancelled():
                return self._settle(name, _DROPPED)
            error = None if future is None else future.exception()
            return self._settle(name, _SUCCEEDED) if error is None else self._fail(name, str(error))

        if isinstance(action, ExecuteLocal):
            _react(launch_description, OnProcessExit(target_action=action, on_exit=ended))
        else:
            _react(launch_description, OnExecutionComplete(target_action=action, on_completion=completed))
        launch_description.add_action(action)
        return action

    def add_output_test(
        self,
        launch_description: LaunchDescription,
        action: ExecuteLocal,
        output_test: OutputTest,
        test_suffix: str = "output",
        output_filter: Callable[[bytes], bytes] | None = None,
        side_effect: str | None = None,
    ) -> ExecuteLocal:
        """Add a test of the output of a process, which is in the description already.

        Args:
            launch_description: The description.
            action: The action that starts the process; it is returned.
            output_test: The test, as a function `create_output_...` of `legacy.output` returns it.
            test_suffix: Name of the test, to tell it from others of the process.
            output_filter: Function of a piece of output, which returns what is looked at; None is all of it.
            side_effect: "shutdown" ends the launch once the test has succeeded.
        """
        name = self._arm(test_suffix)
        said, collate, match, expected = output_test
        left = list(expected)

        def heard(event: ProcessIO) -> _Following:
            nonlocal said
            said = collate(said, output_filter(event.text) if output_filter else event.text)
            left[:] = [each for each in left if not match(said, each)]
            if left or self._states[name] == _SUCCEEDED:
                return []
            ending = _shutdown("a test that should end the launch has succeeded") if side_effect == "shutdown" else []
            return self._settle(name, _SUCCEEDED) or ending

        def ended(event: ProcessExited, context: LaunchContext) -> _Following:
            return self._settle(name, _FINISHED) if left else []  # the last lines may come behind the end

        def over(event: Shutdown, context: LaunchContext) -> _Following:
            if left and self._states[name] != _DROPPED:
                self._states[name] = _FAILED
            return []

        _react(launch_description, OnProcessExit(target_action=action, on_exit=ended))
        _react(launch_description, OnShutdown(on_shutdown=over))
        _react(launch_description, OnProcessIO(target_action=action, on_stdout=heard))
        return action

    def run(self, launch_service: Any, *args: Any, **kwargs: Any) -> int:
        """Run the launch; return its exit code, or that of the first process that should have ended otherwise.

        Args:
            launch_service: The LaunchService that has the description.
            *args: Those of its `run`.
            **kwargs: Those of its `run`.
        """
        code: int = launch_service.run(*args, **kwargs)
        failed = 1 if _FAILED in self._states.values() else 0
        return code or next((each for each in self._codes.values() if each), failed)

    def _arm(self, suffix: str) -> str:
        name = f"{suffix} {next(self._numbers)}"
        self._states[name] = _RUNNING
        return name

    def _settle(self, name: str, state: str) -> _Following:
        """Note the state of a test; return what ends the launch if no other test is left."""
        self._states[name] = state
        return [] if _RUNNING in self._states.values() else _shutdown("all tests finished")

    def _fail(self, name: str, reason: str) -> _Following:
        self._states.update({each: _DROPPED for each, state in self._states.items() if state == _RUNNING})
        self._states[name] = _FAILED
        return _shutdown(reason)


def _shutdown(reason: str) -> _Following:
    return [EmitEvent(event=Shutdown(reason=reason))]


def _react(launch_description: LaunchDescription, handler: Any) -> None:
    launch_description.add_action(RegisterEventHandler(handler))
