"""Kinds of launch files: robolink's own YAML, and those of ROS 2, by suffix and, for YAML, by content."""

from __future__ import annotations

import re
from pathlib import Path

from robolink.system.plainfile import read_plain

YAML = (".yaml", ".yml")
PROGRAMS = (".py", ".xml", ".launch")
"""Suffixes of the launch files that only ROS 2 has."""
_LAUNCH_KEY = re.compile(rb"^(?:%YAML.*|---)?\s*(?:#.*\s*)*^[\"']?launch[\"']?\s*:", re.MULTILINE)
_LONGEST = 10_000_000


def is_of_ros(path: Path) -> bool:
    """True for a launch file of ROS 2: Python, XML, or YAML whose first key is `launch`."""
    if path.suffix in PROGRAMS:
        return True
    try:
        return _LAUNCH_KEY.match(read_plain(path, _LONGEST)) is not None
    except (OSError, ValueError):  # whoever reads it says what is wrong
        return False
