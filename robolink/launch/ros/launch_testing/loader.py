"""Tests of a file with `generate_test_description`: its launches, and for each the tests before and after its end."""

from __future__ import annotations

import functools
import inspect
import unittest
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import ModuleType
from typing import Any

from robolink.exceptions import RobolinkError, nearest
from robolink.launch.ros.launch.bases import LaunchContext, LaunchDescriptionEntity
from robolink.launch.ros.launch.sources import Described, LaunchDescription, described
from robolink.launch.ros.launch_testing.actions import ReadyToTest
from robolink.launch.ros.launch_testing.markers import MARKERS, POST_SHUTDOWN, TIMEOUT, launches

__all__ = ["LoadTestsFromPythonModule", "PostShutdownTestLoader", "PreShutdownTestLoader", "TestRun"]

READY_WITHIN = 15.0
"""Timeout of the ReadyToTest action, in s, as in ROS 2."""
READY_FUNCTION = "ready_fn"
"""Argument of a generate_test_description of before Dashing (2019), a function that begins the tests."""
_NOTHING: Mapping[str, Any] = {}


class LaunchTestError(RobolinkError, RuntimeError):
    """The processes of a launch test could not be started, or never were ready for its tests."""


def ready_actions(entities: Iterable[LaunchDescriptionEntity]) -> list[ReadyToTest]:
    """Return the ReadyToTest actions among `entities`, and in what they hold and include."""
    top = Described(LaunchDescription(entities))
    return [each.entity for each in described(top, LaunchContext()) if isinstance(each.entity, ReadyToTest)]


def bound(function: Callable[..., Any], arguments: Mapping[str, Any]) -> Callable[..., Any]:
    """Return a `function` with those of the `arguments` that it takes by their names.

    If it takes another one that it cannot do without, its call raises LaunchTestError.
    """
    taken = inspect.signature(function).parameters
    for name, each in taken.items():
        is_needed = each.default is each.empty and each.kind not in (each.VAR_POSITIONAL, each.VAR_KEYWORD)
        if is_needed and name not in arguments:
            return functools.partial(_refuse, getattr(function, "__name__", "a function"), name, list(arguments))
    given = {name: each for name, each in arguments.items() if name in taken}
    # A function that takes none of them stays as it is.
    return functools.update_wrapper(functools.partial(function, **given), function) if given else function


def _refuse(function: str, name: str, known: list[str]) -> None:
    __tracebackhide__ = True
    raise LaunchTestError(f"{function} asks for '{name}'{nearest(name, known) or ''}: there is {', '.join(known)}")


def normalized(describe: Callable[..., Any]) -> Callable[..., tuple[LaunchDescription, dict[str, Any]]]:
    """Return a function that calls `describe`, and returns its description and what tests get by name.

    Its argument `ready_fn` is called at the ReadyToTest action of the description.
    """

    def made(*, ready_fn: Callable[[], object], **kwargs: Any) -> tuple[LaunchDescription, dict[str, Any]]:
        takes_function = READY_FUNCTION in inspect.signature(describe).parameters
        found = describe(**kwargs, **({READY_FUNCTION: ready_fn} if takes_function else {}))
        description, of_file = found if isinstance(found, tuple) else (found, {})
        if not isinstance(description, LaunchDescription):
            kind = type(description).__name__
            raise LaunchTestError(f"generate_test_description() returned {kind}, not a LaunchDescription")
        ready = ready_actions(description.entities)
        if not ready and not takes_function:
            raise LaunchTestError(
                "generate_test_description() must return a LaunchDescription containing a ReadyToTest action"
            )
        for each in ready:
            each.add_callback(ready_fn)
        return description, dict(of_file)

    return made


class TestRun:
    """One launch, with the tests that run beside it and after it.

    Args:
        name: Name for people.
        test_description_function: Function generate_test_description, without the arguments below.
        param_args: Arguments that it has by `parametrize`, by name.
        pre_shutdown_tests: Suite of the tests while the processes run.
        post_shutdown_tests: Suite of the tests after they have ended.
    """

    __test__ = False  # it is not a class of tests for pytest

    def __init__(
        self,
        name: str,
        test_description_function: Callable[..., Any],
        param_args: Mapping[str, Any],
        pre_shutdown_tests: Any,
        post_shutdown_tests: Any,
    ) -> None:
        self.name, self.param_args = name, dict(param_args)
        self.test_description_function = test_description_function
        self.normalized_test_description = normalized(test_description_function)
        self.pre_shutdown_tests, self.post_shutdown_tests = pre_shutdown_tests, post_shutdown_tests
        self.timeout: float = getattr(test_description_function, TIMEOUT, READY_WITHIN)
        """Longest wait for the ReadyToTest action, in s."""
        for case in self.all_cases():
            _add_to_name(case, self._parameters)

    @property
    def markers(self) -> dict[str, Any]:
        """Markers of generate_test_description, such as keep_alive, by name."""
        found: dict[str, Any] = getattr(self.test_description_function, MARKERS, {})
        return found

    def bind(
        self, tests: Any, injected_attributes: Mapping[str, Any] = _NOTHING, injected_args: Mapping[str, Any] = _NOTHING
    ) -> None:
        """Bind values to tests.

        Args:
            tests: Suite of the tests.
            injected_attributes: Attributes of each test, by name.
            injected_args: Arguments by name, of tests, of setUp, tearDown and their like, for those that take them.
        """
        for case in cases_in(tests):
            for name in (case._testMethodName, "setUp", "tearDown"):
                setattr(case, name, bound(getattr(case, name), injected_args))
        for cls in dict.fromkeys(type(case) for case in cases_in(tests)):
            for name, value in injected_attributes.items():
                setattr(cls, name, value)
            for name in ("setUpClass", "tearDownClass"):
                setattr(cls, name, staticmethod(bound(getattr(cls, name), injected_args)))

    def get_launch_description(self) -> LaunchDescription:
        """Return the description, for looking, not for running."""
        return self.normalized_test_description(ready_fn=lambda: None)[0]

    def all_cases(self) -> Iterator[Any]:
        """Yield the tests."""
        yield from cases_in(self.pre_shutdown_tests)
        yield from cases_in(self.post_shutdown_tests)

    @property
    def _parameters(self) -> str:
        return f"[{', '.join(map(str, self.param_args.values()))}]" if self.param_args else ""

    def __str__(self) -> str:
        return f"{self.name}{self._parameters}"


def _add_to_name(case: Any, ending: str) -> None:
    method = getattr(case, case._testMethodName)
    case._testMethodName += ending
    setattr(case, case._testMethodName, method)


def cases_in(tests: Any) -> Iterator[Any]:
    """Yield the tests in a suite, or in a list of suites and tests, or a single one: `tests`."""
    if isinstance(tests, unittest.TestCase):
        yield tests
        return
    for each in tests:
        yield from cases_in(each)


class _Suite(unittest.TestSuite):
    """Suite whose tests are still there when they have run: results and reports name them."""

    _cleanup = False


class _Loader(unittest.TestLoader):
    """Loader of the classes that run after the end of the processes, or of the others."""

    suiteClass = _Suite

    def __init__(self, is_after: bool) -> None:
        super().__init__()
        self._is_after = is_after

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> Any:
        if bool(getattr(testCaseClass, POST_SHUTDOWN, False)) != self._is_after:
            return self.suiteClass()
        return super().loadTestsFromTestCase(isolated(testCaseClass))


def isolated(cls: type[unittest.TestCase]) -> type[unittest.TestCase]:
    """Return a class of the same tests as `cls`, for one launch: values are given to it."""
    return type(cls.__name__, (cls,), {"__module__": cls.__module__, "__qualname__": cls.__qualname__})


def PreShutdownTestLoader() -> unittest.TestLoader:
    """Return a loader of the tests that run while the processes do."""
    return _Loader(is_after=False)


def PostShutdownTestLoader() -> unittest.TestLoader:
    """Return a loader of the tests that run after the processes have ended."""
    return _Loader(is_after=True)


def LoadTestsFromPythonModule(module: ModuleType, *, name: str = "launch_tests") -> list[TestRun]:
    """Return the launches of a file, each with its tests.

    Args:
        module: The file's module, with a function generate_test_description.
        name: Name of the launches for people.
    """
    return [
        TestRun(
            name,
            describe,
            parameters,
            PreShutdownTestLoader().loadTestsFromModule(module),
            PostShutdownTestLoader().loadTestsFromModule(module),
        )
        for describe, parameters in launches(module.generate_test_description)
    ]
