"""pytest collector of launch tests: files with `generate_test_description`, as ROS 2's launch_testing runs them.

Each method of a `unittest.TestCase` in such a file is a test. The processes start before the first of them and end
before those of `@launch_testing.post_shutdown_test()` classes, which come last.
"""

from __future__ import annotations

import inspect
import os
import sys
import threading
import unittest
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import pytest

from robolink.exceptions import RobolinkError
from robolink.launch.lookup import home_of
from robolink.launch.ros.launch import LaunchDescription
from robolink.launch.ros.launch.actions import RegisterEventHandler, TimerAction
from robolink.launch.ros.launch.bases import Event, LaunchContext
from robolink.launch.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from robolink.launch.ros.launch.process_events import ProcessExited, ProcessIO, ProcessStarted
from robolink.launch.ros.launch_testing.io_handler import ActiveIoHandler
from robolink.launch.ros.launch_testing.isolation import own_network
from robolink.launch.ros.launch_testing.loader import LaunchTestError, bound, isolated, normalized
from robolink.launch.ros.launch_testing.markers import POST_SHUTDOWN, launches
from robolink.launch.ros.launch_testing.proc_info_handler import ActiveProcInfoHandler
from robolink.launch.ros.surroundings import surroundings
from robolink.launch.system import read_description
from robolink.system import waits
from robolink.testing.supervisor_thread import Launch
from robolink.utilities import try_shutdown

if TYPE_CHECKING:
    from robolink.launch.entry import Direct, Stage
    from robolink.supervisor.events import Exited

READY_WITHIN = 15.0
"""Timeout of the ReadyToTest action, in s, as in ROS 2."""
FOR_EVER = 1e6
"""Time for which the launch goes on if nothing ends it, in s."""
DOWN_WITHIN = 20.0
"""Timeout of the end of all processes, in s: they are killed before."""


class LaunchTest:
    """Processes of a launch test, on a domain of their own that the tests share.

    Args:
        describe: Its function generate_test_description, with its arguments.
        path: Its file.
        parameters: Arguments that it has by `parametrize`, which tests get, too.
        given: Launch arguments by name.
    """

    def __init__(
        self, describe: Callable[..., Any], path: Path, parameters: Mapping[str, Any], given: Mapping[str, str]
    ) -> None:
        self._describe, self._path = describe, path
        self._parameters, self._given = dict(parameters), dict(given)
        self.proc_info, self.proc_output = ActiveProcInfoHandler(), ActiveIoHandler()
        self._of_file: dict[str, Any] = {}
        self._ready = threading.Event()
        self._launch: Launch | None = None
        self._stack = ExitStack()
        self._failed: Exception | None = None
        self._has_begun = self._is_over = False
        self._could_not_start: list[str] = []
        self._reactions: tuple[Any, Stage[Any]] | None = None
        """Director of the launch and its stage."""

    @property
    def arguments(self) -> dict[str, Any]:
        """Values by the names that arguments of tests may have: what the file returns, and the records."""
        records = {"proc_info": self.proc_info, "proc_output": self.proc_output}
        return {**self._parameters, **self._of_file, **records, "test_args": self._given, "launch_service": self}

    def begin(self) -> None:
        """Start the processes and wait until they are ready; with no effect once it was called.

        Raises DocumentError for a mistake in the launch file, LaunchTestError if they do not get ready.
        """
        if self._failed is not None:
            raise self._failed
        if not self._has_begun:
            self._has_begun = True
            try:
                self._start()
                self._await_ready()
            except Exception as error:
                self._failed = error
                self.shutdown()
                raise

    def shutdown(self) -> None:
        """End the processes in order, and by force what does not end; with no effect once it was called, or before."""
        if self._is_over or not self._has_begun:
            return
        self._is_over = True
        try_shutdown()
        if self._launch is not None:
            self._launch.supervisor.stop()
            waits.join(self._launch.thread, DOWN_WITHIN)
        self._stack.close()

    def emit_event(self, event: Event) -> None:
        """Let the launch handle an `event`, such as the inclusion of another description."""
        if self._reactions is None:
            raise LaunchTestError("the processes of this launch test are not there yet")
        reactions, stage = self._reactions
        stage.post(lambda now: reactions.emit(event, now))

    def _direct(self, direct: Direct) -> Direct:
        """Return a maker of the director that notes it."""

        def made(stage: Stage[Any]) -> Any:
            reactions: Any = direct(stage)
            self._reactions = (reactions, stage)
            return reactions

        return made

    def _start(self) -> None:
        with ExitStack() as stack:
            domain = stack.enter_context(own_network())
            system = read_description(self._description(), self._path, self._given)
            for note in system.notes:
                sys.stderr.write(f"[launch] {note}\n")
            network = os.environ["ROBOLINK_NETWORK"]
            assert system.direct is not None  # there are handlers
            direct = self._direct(system.direct)
            self._launch = Launch(system.entries, domain, network, self._note_exit, direct=direct)
            self._launch.begin()
            self._stack = stack.pop_all()

    def _description(self) -> LaunchDescription:
        """Return the description of the file, with handlers that keep records."""
        with surroundings(home_of(self._path, None)):
            description, self._of_file = normalized(self._describe)(ready_fn=self._ready.set)
        going_on = TimerAction(period=FOR_EVER, actions=[])  # without any process, too: tests may start some
        return LaunchDescription([*map(RegisterEventHandler, self._handlers()), going_on, description])

    def _handlers(self) -> list[Any]:
        def note(event: ProcessStarted | ProcessExited, _: LaunchContext) -> None:
            self.proc_info.append(event)

        def hear(event: ProcessIO) -> None:
            event.from_stderr = True  # each line is told as output and as error: the launcher reads both as one
            event.text = event.text.rstrip(b"\r\n") + b"\n"
            self.proc_output.append(event)

        return [OnProcessStart(on_start=note), OnProcessExit(on_exit=note), OnProcessIO(on_stdout=hear)]

    def _await_ready(self) -> None:
        assert self._launch is not None
        for _ in range(int(READY_WITHIN * 10)):
            if self._ready.wait(0.1):
                break
            if not self._launch.thread.is_alive():
                self._ready.wait(0.1)
                break
        if self._could_not_start:
            raise LaunchTestError(f"the processes could not be started: {'; '.join(self._could_not_start)}")
        if not self._ready.is_set():
            raise LaunchTestError(
                f"its ReadyToTest() was not reached within {READY_WITHIN:g} s, or the launch ended before"
            )

    def _note_exit(self, event: Exited) -> None:
        if event.returncode == 127 and event.pid == 0:
            self._could_not_start.append(event.cause)


DESCRIBE = "generate_test_description"
"""Name of the function that a launch test has."""
_RUNNERS = ("_pytest", "pluggy", "robolink.testing", "robolink.launch.ros.launch_testing")
OWN_MARKS = ("launch_test", "rostest")
"""Marks that only say what the function is."""


class LaunchTestModule(pytest.Module):
    """File that is a launch test."""

    def _getobj(self) -> Any:
        with surroundings(home_of(self.path, None)):
            return super()._getobj()  # type: ignore[no-untyped-call]

    def collect(self) -> Iterable[pytest.Item | pytest.Collector]:
        """Return the test classes, for each set of parameters; those of after the shutdown come last."""
        self._runs: list[LaunchTest] = []
        describe = getattr(self.obj, DESCRIBE, None)
        return super().collect() if describe is None else self._classes(describe)  # only a text in it was a launch test

    def _classes(self, describe: Callable[..., Any]) -> Iterator[LaunchTestClass]:
        for mark in getattr(describe, "pytestmark", []):
            if mark.name not in OWN_MARKS:
                self.own_markers.append(mark)
                self.keywords[mark.name] = mark
        for name in _test_functions(self.obj):
            instead = "a launch test has its tests in classes of unittest.TestCase"
            self.warn(pytest.PytestCollectionWarning(f"{name}() is not run: {instead}, as in ROS 2"))
        classes = sorted(_test_classes(self.obj), key=_is_after_shutdown) or [TestLaunch]
        for one, parameters in launches(describe):
            run = LaunchTest(one, self.path, parameters, launch_arguments(self.config))
            self._runs.append(run)
            ending = f"[{'-'.join(map(str, parameters.values()))}]" if parameters else ""
            for cls in classes:
                yield LaunchTestClass.from_parent(self, name=cls.__name__ + ending, tests=isolated(cls), run=run)

    def only(self, run: LaunchTest) -> None:
        """End the processes of all other launches of this file."""
        for each in self._runs:
            if each is not run:
                each.shutdown()

    def teardown(self) -> None:
        """End what still runs."""
        for each in self._runs:
            each.shutdown()


def launch_arguments(config: pytest.Config) -> dict[str, str]:
    """Return the launch arguments of the command line, `--launch-args NAME:=VALUE ...`, in `config`."""
    given: list[str] = config.getoption("launch_args", None) or []
    pairs = (each.partition(":=") for text in given for each in text.split())
    return {name: value for name, _, value in pairs}


def _test_classes(module: Any) -> Iterator[type[unittest.TestCase]]:
    for each in vars(module).values():
        is_test = isinstance(each, type) and issubclass(each, unittest.TestCase)
        if is_test and each.__module__.partition(".")[0] != "unittest":
            yield each


def _test_functions(module: Any) -> Iterator[str]:
    for name, each in vars(module).items():
        if name.startswith("test") and inspect.isfunction(each) and each.__module__ == module.__name__:
            yield name


class TestLaunch(unittest.TestCase):
    """Tests of a file without a class of tests, as ROS 2 counts it: its processes get ready, which its setup tests."""

    def test_processes_get_ready(self) -> None:
        """Do nothing beside the processes."""


def _is_after_shutdown(cls: type) -> bool:
    return bool(getattr(cls, POST_SHUTDOWN, False))


class LaunchTestClass(pytest.Collector):
    """Class of tests for one launch."""

    def __init__(self, *, tests: type[unittest.TestCase], run: LaunchTest, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.tests, self.run = tests, run

    def collect(self) -> Iterator[LaunchTestItem]:
        """Yield the tests."""
        for name in unittest.defaultTestLoader.getTestCaseNames(self.tests):
            yield LaunchTestItem.from_parent(self, name=name)

    def setup(self) -> None:
        """Start the processes, end them before a class of after the shutdown, and set the class up."""
        assert isinstance(self.parent, LaunchTestModule)
        self.parent.only(self.run)
        with self._errors_shown():
            self.run.begin()
            if _is_after_shutdown(self.tests):
                self.run.shutdown()
            for name in ("proc_info", "proc_output", "test_args"):
                setattr(self.tests, name, self.run.arguments[name])
            if not getattr(self.tests, "__unittest_skip__", False):
                self.addfinalizer(self.tests.doClassCleanups)
                bound(self.tests.setUpClass, self.run.arguments)()
                self.addfinalizer(self._tear_down)

    def _tear_down(self) -> None:
        with self._errors_shown():
            bound(self.tests.tearDownClass, self.run.arguments)()

    @contextmanager
    def _errors_shown(self) -> Iterator[None]:
        """Turn an error of the block into one that shows the user's own lines, and unittest's skip into pytest's."""
        try:
            yield
        except unittest.SkipTest as skipped:
            pytest.skip(str(skipped))
        except Exception as error:  # noqa: BLE001 - the user's code
            raise pytest.fail.Exception(str(_shown(error, self.config)), pytrace=False) from None


class LaunchTestItem(pytest.Item):
    """One test."""

    def runtest(self) -> None:
        """Run it with the arguments that it asks for by name."""
        __tracebackhide__ = True
        assert isinstance(self.parent, LaunchTestClass)
        case = self.parent.tests(self.name)
        arguments = self.parent.run.arguments
        for name in ("setUp", self.name, "tearDown"):
            setattr(case, name, bound(getattr(case, name), arguments))
        outcome = _Outcome()
        case.run(outcome)
        outcome.tell()

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the place of the test."""
        assert isinstance(self.parent, LaunchTestClass)
        try:
            line = inspect.getsourcelines(getattr(self.parent.tests, self.name))[1] - 1
        except (OSError, TypeError):
            line = 0
        return self.path, line, f"{self.parent.name}.{self.name}"

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return how a failure is shown: without the frames of runners; an error that explains itself in one line."""
        return _shown(excinfo.value, self.config)


def _shown(error: BaseException, config: pytest.Config) -> Any:
    if isinstance(error, (RobolinkError, pytest.fail.Exception)):
        return str(error)
    steps = _users(error.__traceback__)
    info = pytest.ExceptionInfo.from_exc_info((type(error), error, steps)) if steps is not None else None
    if info is None:
        return f"{type(error).__name__}: {error}"
    option = config.option
    return info.getrepr(showlocals=option.showlocals, style="short" if option.tbstyle == "short" else "long")


def _users(step: TracebackType | None) -> TracebackType | None:
    """Return a traceback without the frames of those that run tests, and of assertions."""
    steps = []
    while step is not None:
        names = step.tb_frame.f_globals
        if "__unittest" not in names and not str(names.get("__name__", "")).startswith(_RUNNERS):
            steps.append(step)
        step = step.tb_next
    for each, after in zip(steps, [*steps[1:], None], strict=False):
        each.tb_next = after
    return steps[0] if steps else None


class _Outcome(unittest.TestResult):
    """Result of one test, told as pytest expects it."""

    def __init__(self) -> None:
        super().__init__()
        self._errors: list[BaseException] = []
        self._is_unexpected = False

    def addError(self, test: unittest.TestCase, err: Any) -> None:  # noqa: N802 - unittest's name
        self._errors.append(err[1])

    addFailure = addError  # noqa: N815 - unittest's name

    def addSubTest(self, test: unittest.TestCase, subtest: unittest.TestCase, err: Any) -> None:  # noqa: N802
        if err is not None:
            self._errors.append(err[1])

    def addUnexpectedSuccess(self, test: unittest.TestCase) -> None:  # noqa: N802 - unittest's name
        self._is_unexpected = True

    def tell(self) -> None:
        """Raise the first error; skip what was skipped."""
        __tracebackhide__ = True
        if self._errors:
            raise self._errors[0]
        if self.skipped:
            pytest.skip(self.skipped[0][1])
        if self.expectedFailures:
            pytest.xfail("it is expected to fail")
        if self._is_unexpected:
            pytest.fail("it was expected to fail, and did not", pytrace=False)
