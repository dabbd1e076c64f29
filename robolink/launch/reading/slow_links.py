"""Limits of slow links that a launch file has under its key `limits`."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from robolink.exceptions import DocumentError
from robolink.launch.reading.arguments import values_of
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.section import Section
from robolink.launch.reading.substitution import Step, Values
from robolink.networks.limits import Limits, mistakes, parsed

KEY = "limits"
_OF_LAUNCH_FILES = {KEY, "nodes", "include", "groups"}


class Found(NamedTuple):
    """Limits of a file; `error` makes an error that names the place of one of their values."""

    limits: Limits
    error: Callable[[Sequence[Step], str], DocumentError]


def limits_of(path: str | os.PathLike[str]) -> Found:
    """Return the limits of a file: those of a launch file under `limits`, or those that are a file of their own.

    Args:
        path: The file; launch files that it includes are not asked.

    Raises:
        DocumentError: for a mistake in the file, with `file:line:column`, also for a launch file without limits.
    """
    file = LaunchFile(Path(path))
    if not set(file.data) & _OF_LAUNCH_FILES:
        document = parsed(None, os.fspath(path))
        return Found(document.value, document.error)
    section = section_of(file, values_of(file, {}))
    found = read(section)
    if found is None:
        raise file.error([], f"no key '{KEY}': nothing is limited")
    return Found(found, lambda steps, message: section.error([KEY, *steps], message))


def section_of(file: LaunchFile, values: Values) -> Section:
    """Return the part of a launch file that has its limits."""
    return Section(file, [], {key: data for key, data in file.data.items() if key == KEY}, values)


def read(section: Section) -> Limits | None:
    """Return the limits that a section has; None for none. Raises DocumentError for the first mistake."""
    said: Limits | None = section.value(KEY, Limits | None, None)
    for steps, message, is_key in mistakes(said) if said is not None else ():
        raise section.error([KEY, *steps], message, key=is_key)
    return said
