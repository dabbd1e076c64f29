"""Recording that a launch file asks for, by its key `record`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from robolink.documents.yamlfile import spell
from robolink.launch.reading.arguments import read_given, values_of
from robolink.launch.reading.conditions import as_bool
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.section import Section
from robolink.launch.reading.substitution import Values

KEY = "record"
_NOTHING: Mapping[str, str] = MappingProxyType({})


def record_of(
    path: str | os.PathLike[str], given: Mapping[str, str] = _NOTHING, *, text: str | None = None
) -> str | None:
    """Return the folder of the bag that a launch file asks for: '' for one with the date in its name, None for none.

    Args:
        path: The launch file; those that it includes are not asked.
        given: Launch arguments by name, as people type them.
        text: Content to read in place of the file's.

    Raises:
        DocumentError: for a mistake in the file, with `file:line:column`.
    """
    file = LaunchFile(Path(path), text)
    return recorded(file, values_of(file, read_given(given)))


def recorded(file: LaunchFile, values: Values) -> str | None:
    """Return what `record_of` does, of a file that is being read. Raises DocumentError."""
    section = Section(file, [], {key: data for key, data in file.data.items() if key == KEY}, values)
    said = section.get(KEY)
    if said is None:
        return None
    wanted = as_bool(said)
    if wanted is not None:
        return "" if wanted else None
    if not isinstance(said, str) or not said.strip():
        found = said if isinstance(said, str) else spell(said)
        raise section.error([KEY], f"expected true, false or the folder of a bag, got '{found}'")
    return said
