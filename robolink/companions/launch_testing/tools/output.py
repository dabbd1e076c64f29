"""Filters of output, and files with expected output (`launch_testing.tools.output`)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path

__all__ = [
    "basic_output_filter",
    "expected_output_from_file",
    "get_default_filtered_patterns",
    "get_default_filtered_prefixes",
]


def get_default_filtered_prefixes() -> list[str]:
    """Return beginnings of lines that no test compares."""
    return ["pid", "rc"]


def get_default_filtered_patterns() -> list[str]:
    """Return patterns of lines that no test compares: none."""
    return []


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None, filtered_patterns: Iterable[str] | None = None
) -> Callable[[str], str]:
    """Return a function that leaves lines out of an output.

    Args:
        filtered_prefixes: Beginnings of these lines; None is those of `get_default_filtered_prefixes`.
        filtered_patterns: Regular expressions that match their beginnings.
    """
    prefixes = tuple(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = [re.compile(each) for each in filtered_patterns or ()]

    def kept(output: str) -> str:
        lines = output.splitlines(keepends=True)
        return "".join(
            each for each in lines if not each.startswith(prefixes) and not any(one.match(each) for one in patterns)
        )

    return kept


def expected_output_from_file(path: str) -> list[str] | list[re.Pattern[str]]:
    """Return the lines of a file `path`.txt, or the patterns in `path`.regex, one a line.

    Raises FileNotFoundError if there is neither.
    """
    for suffix in (".txt", ".regex"):
        if Path(path + suffix).is_file():
            lines = Path(path + suffix).read_text(encoding="utf-8").splitlines()
            return lines if suffix == ".txt" else [re.compile(each) for each in lines]
    raise FileNotFoundError(f"there is neither {path}.txt nor {path}.regex with the expected output")
