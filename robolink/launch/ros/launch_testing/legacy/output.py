"""Output tests for LaunchTestService, on bytes (`launch_testing.legacy.output`)."""

from __future__ import annotations

import io
import os
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

__all__ = [
    "create_output_lines_filter",
    "create_output_lines_test",
    "create_output_regex_test",
    "create_output_test_from_file",
    "get_default_filtered_patterns",
    "get_default_filtered_prefixes",
]


class OutputTest(NamedTuple):
    """Test of an output.

    Args:
        start: Output before there is any.
        collate: Function of the output and of a new piece, which returns both together.
        match: Function of the output and of one of the expected parts: is it there?
        expected: The expected parts.
    """

    start: Any
    collate: Callable[[Any, bytes], Any]
    match: Callable[[Any, Any], bool]
    expected: list[Any]


def get_default_filtered_prefixes() -> list[bytes]:
    """Return beginnings of lines that no test compares."""
    return [b"pid", b"rc"]


def get_default_filtered_patterns() -> list[bytes]:
    """Return patterns of lines that no test compares: none."""
    return []


def create_output_lines_filter(
    filtered_prefixes: Iterable[bytes] | None = None,
    filtered_patterns: Iterable[bytes] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[bytes], bytes]:
    """Return a function that leaves lines out of an output.

    Args:
        filtered_prefixes: Beginnings of these lines; None is those of `get_default_filtered_prefixes`.
        filtered_patterns: Regular expressions that match their beginnings.
        filtered_rmw_implementation: Of no effect: robolink's nodes have no other middleware, and it writes no lines.
    """
    prefixes = tuple(filtered_prefixes or get_default_filtered_prefixes())
    patterns = [re.compile(each) for each in filtered_patterns or ()]
    end = os.linesep.encode()

    def filtered(output: bytes) -> bytes:
        lines = [each for each in output.splitlines() if not each.startswith(prefixes)]
        left = [each for each in lines if not any(one.match(each) for one in patterns)]
        return end.join([*left, b""] if output.endswith(end) else left)

    return filtered


def create_output_lines_test(expected_lines: Iterable[bytes]) -> OutputTest:
    """Return a test that each of the `expected_lines` is within a line of the output."""

    def collate(output: io.BytesIO, addendum: bytes) -> io.BytesIO:
        output.write(addendum)
        return output

    def match(output: io.BytesIO, expected: bytes) -> bool:
        return any(expected in line for line in output.getvalue().splitlines())

    return OutputTest(io.BytesIO(), collate, match, list(expected_lines))


def create_output_regex_test(expected_patterns: Iterable[re.Pattern[bytes]]) -> OutputTest:
    """Return a test that each of the `expected_patterns` is found in the output."""

    def collate(output: io.BytesIO, addendum: bytes) -> io.BytesIO:
        output.write(b"".join(line + b"\n" for line in addendum.splitlines()))  # a pattern may go over two lines
        return output

    def match(output: io.BytesIO, expected: re.Pattern[bytes]) -> bool:
        return expected.search(output.getvalue()) is not None

    return OutputTest(io.BytesIO(), collate, match, list(expected_patterns))


def create_output_test_from_file(output_file: str) -> OutputTest:
    """Return a test of the lines in `output_file`.txt, or of the patterns in `output_file`.regex, one a line.

    Raises FileNotFoundError if there is neither.
    """
    lines, patterns = Path(output_file + ".txt"), Path(output_file + ".regex")
    if lines.is_file():
        return create_output_lines_test(lines.read_bytes().splitlines())
    if patterns.is_file():
        return create_output_regex_test(re.compile(each) for each in patterns.read_bytes().splitlines())
    raise FileNotFoundError(f"there is neither {lines} nor {patterns} with the expected output")
