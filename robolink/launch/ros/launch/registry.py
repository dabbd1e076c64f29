"""Registry of those parts of launch files in XML and YAML that are made of what looks them up.

An action reads itself from an element by a table, whose rows name all actions; the parsers of files need the loader of
files, which looks for them. So the ones register their places here, and the others look them up when they need them.
"""

from __future__ import annotations

import importlib
from typing import Any

PLACES = {
    "arguments": "robolink.launch.ros.launch_frontend.build:arguments",
    "actions": "robolink.launch.ros.launch_frontend.build:methods",
    "substitutions": "robolink.launch.ros.launch_frontend.texts:methods",
    "parser": "robolink.launch.ros.launch.frontend.parser:Parser",
    "parser of xml": "robolink.launch.ros.launch_xml.parser:Parser",
    "parser of yaml": "robolink.launch.ros.launch_yaml.parser:Parser",
}
"""MODULE:NAME of each part: functions of the tables, and classes of parsers."""


def registered(name: str) -> Any:
    """Return the part called `name` in `PLACES`; its module is imported now."""
    module, _, attribute = PLACES[name].partition(":")
    return getattr(importlib.import_module(module), attribute)
