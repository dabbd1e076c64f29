"""Runner of launch tests within a program: the launch on this thread, its tests on another (`launch_testing`)."""

from __future__ import annotations

import inspect
import threading
import unittest
from collections.abc import Iterable, Sequence
from typing import Any

from robolink.launch.ros.launch import LaunchService
from robolink.launch.ros.launch.actions import IncludeLaunchDescription, RegisterEventHandler
from robolink.launch.ros.launch.bases import LaunchDescriptionEntity
from robolink.launch.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from robolink.launch.ros.launch.sources import LaunchDescription, LaunchDescriptionSource
from robolink.launch.ros.launch_testing.arguments import parse_launch_arguments
from robolink.launch.ros.launch_testing.io_handler import ActiveIoHandler
from robolink.launch.ros.launch_testing.loader import READY_FUNCTION, LaunchTestError, TestRun
from robolink.launch.ros.launch_testing.proc_info_handler import ActiveProcInfoHandler
from robolink.launch.ros.launch_testing.test_result import FailResult, SkipResult, TestResult
from robolink.launch.ros.launch_testing.text import text_of

__all__ = ["LaunchTestRunner"]


def recording(proc_info: ActiveProcInfoHandler, proc_output: ActiveIoHandler) -> list[LaunchDescriptionEntity]:
    """Return the actions by which a launch keeps records of its processes.

    Args:
        proc_info: Record of their starts and ends.
        proc_output: Record of their output.
    """

    def started(event: Any, _: Any) -> None:
        proc_output.track(event.process_name)
        proc_info.append(event)

    def ended(event: Any, _: Any) -> None:
        proc_info.append(event)

    handlers = [
        OnProcessStart(on_start=started),
        OnProcessExit(on_exit=ended),
        OnProcessIO(on_stdout=proc_output.append, on_stderr=proc_output.append),
    ]
    return [RegisterEventHandler(each) for each in handlers]


class _LaunchDied(Exception):
    """The launch has ended before its tests have."""


class _RunnerWorker:
    """Run of one launch and its tests."""

    def __init__(
        self,
        test_run: TestRun,
        test_run_preamble: Iterable[LaunchDescriptionEntity],
        launch_file_arguments: Sequence[str] = (),
        debug: bool = False,
    ) -> None:
        self._test_run, self._preamble = test_run, list(test_run_preamble)
        self._arguments = parse_launch_arguments(launch_file_arguments)
        self._launch_service: Any = LaunchService(debug=debug)
        self._proc_info, self._proc_output = ActiveProcInfoHandler(), ActiveIoHandler()
        self._are_ready, self._are_done = threading.Event(), threading.Event()
        self._results: Any = None

    def run(self) -> Any:
        """Launch the processes, run the tests beside them and those after them; return the results."""
        run = self._test_run
        description, of_file = run.normalized_test_description(ready_fn=self._are_ready.set)
        records = {
            "proc_info": self._proc_info,
            "proc_output": self._proc_output,
            "test_args": dict(self._arguments),
        }
        beside = {**records, "launch_service": self._launch_service}
        run.bind(run.pre_shutdown_tests, beside, {**of_file, **run.param_args, **beside})
        run.bind(run.post_shutdown_tests, records, {**of_file, **run.param_args, **records})
        included = IncludeLaunchDescription(
            LaunchDescriptionSource(launch_description=description), launch_arguments=self._arguments
        )
        handlers = recording(self._proc_info, self._proc_output)
        self._launch_service.include_launch_description(LaunchDescription([*self._preamble, *handlers, included]))
        tests = threading.Thread(target=self._run_test, name="launch tests", daemon=True)
        tests.start()
        self._launch_service.run(shutdown_when_idle=not run.markers.get("keep_alive", False))
        if not self._are_done.is_set():
            print("Processes under test stopped before tests completed")
            self._show_failed()
            raise _LaunchDied
        self._results.append(_run_suite(run.post_shutdown_tests))
        return self._results

    def _run_test(self) -> None:
        """Wait until the processes are ready, and run the tests beside them; then the launch ends."""
        try:
            if self._are_ready.wait(self._test_run.timeout):
                self._results = _run_suite(self._test_run.pre_shutdown_tests)
                self._are_done.set()
            else:
                print("Timed out waiting for processes to start up")
        finally:
            self._launch_service.shutdown()

    def _show_failed(self) -> None:
        """Print the output of processes that have failed."""
        for event in self._proc_info:
            code = getattr(event, "returncode", None)
            if code:
                pieces = self._proc_output[event.action] if event.action in self._proc_output.processes() else []
                title = f"##### '{event.process_name}' ended with {code} and has written: #####"
                print(f"{title}\n{text_of(pieces)}{'#' * len(title)}")


def _run_suite(suite: Any) -> Any:
    return unittest.TextTestRunner(verbosity=2, resultclass=TestResult).run(suite)


class LaunchTestRunner:
    """Runner of launches and their tests, one after the other.

    Args:
        test_runs: The launches.
        launch_file_arguments: Launch arguments, `NAME:=VALUE`.
        debug: True shows what the launch does.
    """

    def __init__(
        self, test_runs: Iterable[TestRun], launch_file_arguments: Sequence[str] = (), debug: bool = False
    ) -> None:
        self._test_runs = list(test_runs)
        self._arguments, self._debug = list(launch_file_arguments), debug

    def generate_preamble(self) -> list[LaunchDescriptionEntity]:
        """Return the entities before each description: none. Subclasses override it."""
        return []

    def run(self) -> dict[TestRun, Any]:
        """Run the launches and their tests; return the results by launch."""
        results: dict[TestRun, Any] = {}
        for run in self._test_runs:
            if len(self._test_runs) > 1:
                print(f"\nStarting test run {run}")
            try:
                results[run] = _RunnerWorker(run, self.generate_preamble(), self._arguments, self._debug).run()
            except unittest.SkipTest as skipped:
                print(f"{run} is skipped: {skipped}")
                results[run] = SkipResult(run, str(skipped))
            except _LaunchDied:
                results[run] = FailResult(run, "the launch has ended before its tests have")
                break
        return results

    def validate(self) -> None:
        """Raise LaunchTestError for a generate_test_description whose arguments are not those of `parametrize`."""
        for run in self._test_runs:
            function = inspect.unwrap(run.test_description_function)
            taken = inspect.signature(function).parameters
            for name in run.param_args:
                if name not in taken:
                    raise LaunchTestError(
                        f"Could not find an argument in generate_test_description matching the parameter '{name}'"
                    )
            for name, each in taken.items():
                is_needed = each.default is each.empty and each.kind not in (each.VAR_POSITIONAL, each.VAR_KEYWORD)
                if is_needed and name not in {*run.param_args, READY_FUNCTION}:
                    raise LaunchTestError(f"generate_test_description has unexpected extra argument '{name}'")
