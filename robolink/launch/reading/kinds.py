"""Kinds of launch files: robolink's own YAML, and those of ROS 2, by suffix and, for YAML, by content."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from robolink.system.plainfile import read_plain

YAML = (".yaml", ".yml")
PROGRAMS = (".py", ".xml", ".launch")
"""Suffixes of the launch files that only ROS 2 has."""
_LAUNCH_KEY = re.compile(rb"[\"']?launch[\"']?\s*:")
_NO_KEY = re.compile(rb"\s*(?:#.*|---.*|%.*)?")
"""Lines that may stand before the first key."""
_LONGEST = 10_000_000


def is_of_ros(path: Path) -> bool:
    """True for a launch file of ROS 2: Python, XML, or YAML whose first key is `launch`."""
    if path.suffix in PROGRAMS:
        return True
    try:
        lines = read_plain(path, _LONGEST).removeprefix(codecs.BOM_UTF8).splitlines()
    except (OSError, ValueError):  # whoever reads it says what is wrong
        return False
    first = next((each for each in lines if not _NO_KEY.fullmatch(each)), b"")
    return _LAUNCH_KEY.match(first) is not None
