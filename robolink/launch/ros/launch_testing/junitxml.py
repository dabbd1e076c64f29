"""Results of launch tests as a document in JUnit's XML (`launch_testing.junitxml`)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree

__all__ = ["unittestCaseToXml", "unittestResultToXml", "unittestResultsToXml"]

_NONE: Mapping[Any, Any] = {}


def unittestResultsToXml(
    *, name: str = "launch_test", test_results: Mapping[Any, Any] = _NONE
) -> ElementTree.ElementTree:
    """Return the document of several results.

    Args:
        name: Name of the whole.
        test_results: Results by the name of each, or by its TestRun.
    """
    results = list(test_results.values())
    whole = ElementTree.Element(
        "testsuites",
        name=name,
        tests=str(sum(each.testsRun for each in results)),
        failures=str(sum(len(each.failures) for each in results)),
        errors=str(sum(len(each.errors) for each in results)),
        time=_seconds(sum(map(_time, results))),
    )
    whole.extend(unittestResultToXml(str(run), result) for run, result in test_results.items())
    return ElementTree.ElementTree(whole)


def unittestResultToXml(name: str, test_result: Any) -> ElementTree.Element:
    """Return the element of one result.

    Args:
        name: Its name.
        test_result: The result, as of `test_result.TestResult`.
    """
    suite = ElementTree.Element(
        "testsuite",
        name=name,
        tests=str(test_result.testsRun),
        failures=str(len(test_result.failures)),
        errors=str(len(test_result.errors)),
        skipped=str(len(test_result.skipped)),
        time=_seconds(_time(test_result)),
    )
    suite.extend(unittestCaseToXml(test_result, case) for case in test_result.testCases)
    return suite


def unittestCaseToXml(test_result: Any, test_case: Any) -> ElementTree.Element:
    """Return the element of a test.

    Args:
        test_result: The result that has it.
        test_case: The test.
    """
    name, space, parameters = test_case.id().partition(" ")
    cls, _, method = name.rpartition(".")
    time = _seconds(test_result.testTimes[test_case])
    element = ElementTree.Element("testcase", classname=cls, name=f"{method}{space}{parameters}", time=time)
    kinds = {"failure": test_result.failures, "error": test_result.errors, "skipped": test_result.skipped}
    for tag, found in kinds.items():
        element.extend(ElementTree.Element(tag, message=text) for case, text in found if case is test_case)
    return element


def _time(result: Any) -> float:
    return float(sum(result.testTimes.values()))


def _seconds(seconds: float) -> str:
    return str(round(seconds, 3))
