"""Results of the tests of a launch (`launch_testing.test_result`)."""

from __future__ import annotations

import unittest
from typing import Any

from robolink.launch.ros.launch_testing.loader import TestRun
from robolink.system import clocks

__all__ = ["FailResult", "SkipResult", "TestResult"]


class _Whole(unittest.TestResult):
    """Result of tests none of which has run.

    Args:
        test_run: The launch.
    """

    def __init__(self, test_run: TestRun) -> None:
        super().__init__()
        self.testCases = list(test_run.all_cases())
        self.testTimes = dict.fromkeys(self.testCases, 0.0)
        self.testsRun = len(self.testCases)


class FailResult(_Whole):
    """Result of tests whose launch ended too early: each has failed.

    Args:
        test_run: The launch.
        message: What has happened.
    """

    def __init__(self, test_run: TestRun, message: str) -> None:
        super().__init__(test_run)
        error = RuntimeError(message)
        for case in self.testCases:
            self.addFailure(case, (RuntimeError, error, None))  # type: ignore[arg-type]

    def wasSuccessful(self) -> bool:
        """Return False, also without a test."""
        return False


class SkipResult(_Whole):
    """Result of tests whose launch is skipped: each is, too.

    Args:
        test_run: The launch.
        skip_reason: Reason for people.
    """

    def __init__(self, test_run: TestRun, skip_reason: str = "") -> None:
        super().__init__(test_run)
        for case in self.testCases:
            self.addSkip(case, skip_reason)


class TestResult(unittest.TextTestResult):
    """Result of tests, with the tests and the time that each took.

    Args:
        stream: Stream of the lines for people.
        descriptions: True shows the first lines of docstrings.
        verbosity: 2 has a line for each test.
        **kwargs: Those of unittest's own class.
    """

    __test__ = False  # it is not a class of tests for pytest

    def __init__(self, stream: Any = None, descriptions: Any = None, verbosity: Any = None, **kwargs: Any) -> None:
        super().__init__(stream, descriptions, verbosity, **kwargs)
        self._began: dict[Any, float] = {}
        self.testTimes: dict[Any, float] = {}
        """Time that each test took, in seconds."""

    @property
    def testCases(self) -> list[Any]:
        """The tests that have begun."""
        return list(self._began)

    def startTest(self, test: unittest.TestCase) -> None:
        """Note that `test` begins."""
        self._began[test] = clocks.monotonic()
        self.testTimes[test] = 0.0
        super().startTest(test)

    def stopTest(self, test: unittest.TestCase) -> None:
        """Note that `test` has ended."""
        self.testTimes[test] = clocks.monotonic() - self._began[test]
        super().stopTest(test)

    def append(self, results: TestResult) -> None:
        """Add other `results`."""
        self._began.update(results._began)
        self.testTimes.update(results.testTimes)
        self.failures += results.failures
        self.errors += results.errors
        self.skipped += results.skipped
        self.expectedFailures += results.expectedFailures
        self.unexpectedSuccesses += results.unexpectedSuccesses
        self.testsRun += results.testsRun
