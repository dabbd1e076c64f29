"""Output that is expected of a process: filters, files and comparisons (`launch_testing.tools.output`)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from robolink.launch.ros.launch_testing.text import build_line_match, build_text_match, without_escapes

__all__ = [
    "basic_output_filter",
    "expect_output",
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

    def filtered(output: str) -> str:
        lines = output.splitlines(keepends=True)
        return "".join(
            each for each in lines if not each.startswith(prefixes) and not any(one.match(each) for one in patterns)
        )

    return filtered


def expected_output_from_file(path: str, encoding: str | None = None) -> list[str] | list[re.Pattern[str]]:
    """Return the lines of the file `path`.txt, or the patterns in `path`.regex, one a line.

    Args:
        path: Path without its suffix.
        encoding: Encoding of the file; None is UTF-8.

    Raises:
        FileNotFoundError: if there is neither.
    """
    for suffix in (".txt", ".regex"):
        if Path(path + suffix).is_file():
            lines = Path(path + suffix).read_text(encoding=encoding or "utf-8").splitlines()
            return lines if suffix == ".txt" else [re.compile(each) for each in lines]
    raise FileNotFoundError(f"there is neither {path}.txt nor {path}.regex with the expected output")


def expect_output(
    text: str | None = None,
    *,
    lines: Sequence[str] | None = None,
    expected_text: Any = None,
    expected_lines: Any = None,
    strip_ansi_escape_sequences: bool = True,
    strict: bool = False,
) -> bool:
    """Return whether an output is as expected.

    Args:
        text: The output as one text; or else `lines`.
        lines: The output, line by line.
        expected_text: What is expected, as for `text.build_text_match`; or else `expected_lines`.
        expected_lines: What is expected, as for `text.build_line_match`.
        strip_ansi_escape_sequences: True leaves colours out.
        strict: True takes all of the output, as for these functions.

    Raises:
        ValueError: for two of what there should be one of, or none.
    """
    if (text is None) == (lines is None):
        raise ValueError("expect_output takes a text or lines, one of them")
    if (expected_text is None) == (expected_lines is None):
        raise ValueError("expect_output takes expected_text or expected_lines, one of them")
    strip = without_escapes if strip_ansi_escape_sequences else str
    if expected_text is not None:
        said = "\n".join(lines or ()) if text is None else text
        return build_text_match(expected_text, strict=strict)(strip(said)) is not None
    single = (text or "").splitlines() if lines is None else lines
    return build_line_match(expected_lines, strict=strict)(list(map(strip, single))) is not None
