"""Waits for what the processes of a launch do, for coroutines and, with `_sync`, for functions (`launch_pytest.tools`).

Each takes the context of the launch, the action that starts the process, and a timeout in seconds, None for none.
Output is that of a process with `cached_output=True`.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from robolink.launch.ros.launch.bases import BaseEventHandler, LaunchContext
from robolink.launch.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from robolink.launch.ros.launch.processes import ExecuteLocal
from robolink.system import clocks, waits

__all__ = [
    "assert_output",
    "assert_output_sync",
    "assert_stderr",
    "assert_stderr_sync",
    "wait_for_exit",
    "wait_for_exit_sync",
    "wait_for_output",
    "wait_for_output_sync",
    "wait_for_start",
    "wait_for_start_sync",
    "wait_for_stderr",
    "wait_for_stderr_sync",
]

Notify = Callable[[], object]
Validate = Callable[[str], Any]


class _Change:
    """Change of a process: how one hears of it, and how one sees it."""

    def __init__(self, action: ExecuteLocal, holds: Callable[[], Any]) -> None:
        self.action, self.holds = action, holds

    def handler(self, notify: Notify) -> BaseEventHandler:
        """Return the event handler that calls `notify`."""
        raise NotImplementedError


class _Start(_Change):
    def __init__(self, action: ExecuteLocal) -> None:
        super().__init__(action, lambda: "pid" in (action.process_details or {}))

    def handler(self, notify: Notify) -> BaseEventHandler:
        return OnProcessStart(target_action=self.action, on_start=lambda event, context: _call(notify))


class _Exit(_Change):
    def __init__(self, action: ExecuteLocal) -> None:
        super().__init__(action, lambda: action.return_code is not None)

    def handler(self, notify: Notify) -> BaseEventHandler:
        return OnProcessExit(target_action=self.action, on_exit=lambda event, context: _call(notify))


class _Stdout(_Change):
    def handler(self, notify: Notify) -> BaseEventHandler:
        return OnProcessIO(target_action=self.action, on_stdout=lambda event: _call(notify))


class _Stderr(_Change):
    def handler(self, notify: Notify) -> BaseEventHandler:
        return OnProcessIO(target_action=self.action, on_stderr=lambda event: _call(notify))


def _call(notify: Notify) -> None:
    notify()


@contextmanager
def _heard(context: LaunchContext, handler: BaseEventHandler) -> Iterator[None]:
    context.register_event_handler(handler, append=True)
    try:
        yield
    finally:
        context.unregister_event_handler(handler)


async def _wait(context: LaunchContext, change: _Change, timeout: float | None) -> Any:
    """Return the result of `holds` as soon as that is true, or at the end of the timeout."""
    changed = asyncio.Event()
    end = None if timeout is None else clocks.monotonic() + timeout
    with _heard(context, change.handler(changed.set)):
        while not (found := change.holds()):
            try:
                await asyncio.wait_for(changed.wait(), None if end is None else end - clocks.monotonic())
            except asyncio.TimeoutError:
                return change.holds()
            changed.clear()
        return found


def _wait_sync(context: LaunchContext, change: _Change, timeout: float | None) -> Any:
    changed = threading.Event()
    end = None if timeout is None else clocks.monotonic() + timeout
    with _heard(context, change.handler(changed.set)):
        while not (found := change.holds()):
            if not waits.wait(changed, None if end is None else end - clocks.monotonic()):
                return change.holds()
            changed.clear()
        return found


def _validated(validate: Validate, said: Callable[[], str]) -> Callable[[], bool]:
    """Return a function that tells whether an output is as it should be."""

    def is_valid() -> bool:
        try:
            validate(said())
        except AssertionError:
            return False
        return True

    return is_valid


async def wait_for_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> Any:
    """Wait for an output; return what `validate_output` returns at last.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written; a true value ends the wait.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    return await _wait(launch_context, _Stdout(action, lambda: validate_output(action.get_stdout())), timeout)


def wait_for_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> Any:
    """Wait as `wait_for_output` does, in a function.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written; a true value ends the wait.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    return _wait_sync(launch_context, _Stdout(action, lambda: validate_output(action.get_stdout())), timeout)


async def assert_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait until `validate_output` raises no AssertionError any more; raise its last one.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    if not await _wait(launch_context, _Stdout(action, _validated(validate_output, action.get_stdout)), timeout):
        validate_output(action.get_stdout())


def assert_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait as `assert_output` does, in a function.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    if not _wait_sync(launch_context, _Stdout(action, _validated(validate_output, action.get_stdout)), timeout):
        validate_output(action.get_stdout())


async def wait_for_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> Any:
    """Wait for an output on standard error; return what `validate_output` returns at last.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written there; a true value ends the wait.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    return await _wait(launch_context, _Stderr(action, lambda: validate_output(action.get_stderr())), timeout)


def wait_for_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> Any:
    """Wait as `wait_for_stderr` does, in a function.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written there; a true value ends the wait.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    return _wait_sync(launch_context, _Stderr(action, lambda: validate_output(action.get_stderr())), timeout)


async def assert_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait until `validate_output` raises no AssertionError any more for what is on standard error; raise its last one.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written there.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    if not await _wait(launch_context, _Stderr(action, _validated(validate_output, action.get_stderr)), timeout):
        validate_output(action.get_stderr())


def assert_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validate,
    timeout: float | None = None,
) -> None:
    """Wait as `assert_stderr` does, in a function.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        validate_output: Function of all that it has written there.
        timeout: Longest wait in seconds; None has no limit.
    """
    action = execute_process_action
    if not _wait_sync(launch_context, _Stderr(action, _validated(validate_output, action.get_stderr)), timeout):
        validate_output(action.get_stderr())


async def wait_for_start(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait until a process has started, or see that it has; return whether it has.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        timeout: Longest wait in seconds; None has no limit.
    """
    return bool(await _wait(launch_context, _Start(execute_process_action), timeout))


def wait_for_start_sync(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait as `wait_for_start` does, in a function.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        timeout: Longest wait in seconds; None has no limit.
    """
    return bool(_wait_sync(launch_context, _Start(execute_process_action), timeout))


async def wait_for_exit(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait until a process has ended, or see that it has; return whether it has.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        timeout: Longest wait in seconds; None has no limit.
    """
    return bool(await _wait(launch_context, _Exit(execute_process_action), timeout))


def wait_for_exit_sync(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait as `wait_for_exit` does, in a function.

    Args:
        launch_context: Context of the launch.
        execute_process_action: Action that starts the process.
        timeout: Longest wait in seconds; None has no limit.
    """
    return bool(_wait_sync(launch_context, _Exit(execute_process_action), timeout))
