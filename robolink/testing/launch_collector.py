"""pytest collector of launch tests: files with `generate_test_description`, as ROS 2's launch_testing runs them.

Each method of a `unittest.TestCase` in such a file is a test. The processes start before the first of them and end
before those of `@launch_testing.post_shutdown_test()` classes, which come last.
"""

from __future__ import annotations

import inspect
import unittest
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any

import pytest

from robolink.companions.launch_testing.parametrize import PARAMETERS
from robolink.exceptions import RobolinkError
from robolink.launch.lookup import home_of
from robolink.launch.ros.surroundings import surroundings
from robolink.testing.launch_test import LaunchTest, bound

DESCRIBE = "generate_test_description"
"""Name of the function that a launch test has."""
_RUNNERS = ("_pytest", "pluggy", "robolink.testing", "robolink.companions.launch_testing")
OWN_MARKS = ("launch_test", "rostest")
"""Marks that only say what the function is."""


class LaunchTestModule(pytest.Module):
    """File that is a launch test."""

    def _getobj(self) -> Any:
        with surroundings(home_of(self.path, None)):
            return super()._getobj()  # type: ignore[no-untyped-call]

    def collect(self) -> Iterator[LaunchTestClass]:
        """Yield the test classes, for each set of parameters; those of after the shutdown come last."""
        describe = getattr(self.obj, DESCRIBE)
        for mark in getattr(describe, "pytestmark", []):
            if mark.name not in OWN_MARKS:
                self.own_markers.append(mark)
                self.keywords[mark.name] = mark
        self._runs: list[LaunchTest] = []
        for parameters in getattr(describe, PARAMETERS, [{}]):
            run = LaunchTest(describe, self.path, parameters, launch_arguments(self.config))
            self._runs.append(run)
            ending = f"[{'-'.join(map(str, parameters.values()))}]" if parameters else ""
            for cls in sorted(_test_classes(self.obj), key=_is_after_shutdown):
                made = type(cls.__name__, (cls,), {"__module__": cls.__module__, "__qualname__": cls.__qualname__})
                yield LaunchTestClass.from_parent(self, name=cls.__name__ + ending, tests=made, run=run)

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


def _is_after_shutdown(cls: type) -> bool:
    return bool(getattr(cls, "__post_shutdown_test__", False))


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
        with self._told():
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
        with self._told():
            bound(self.tests.tearDownClass, self.run.arguments)()

    @contextmanager
    def _told(self) -> Iterator[None]:
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
            setattr(case, name, _bound_method(case, name, arguments))
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
    kept = pytest.ExceptionInfo.from_exc_info((type(error), error, steps)) if steps is not None else None
    if kept is None:
        return f"{type(error).__name__}: {error}"
    option = config.option
    return kept.getrepr(showlocals=option.showlocals, style="short" if option.tbstyle == "short" else "long")


def _bound_method(case: unittest.TestCase, name: str, arguments: Mapping[str, Any]) -> Any:
    method = getattr(case, name)
    made = bound(method, arguments)
    return made if getattr(made, "keywords", None) else method  # one that asks for nothing keeps its attributes


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
