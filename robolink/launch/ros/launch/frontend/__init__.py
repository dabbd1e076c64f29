"""Elements of XML and YAML launch files, and the parsers that make actions of them (`launch.frontend`)."""

from __future__ import annotations

from robolink.launch.ros.launch.frontend import type_utils
from robolink.launch.ros.launch.frontend.entity import Entity
from robolink.launch.ros.launch.frontend.expose import expose_action, expose_substitution
from robolink.launch.ros.launch.frontend.parser import InvalidFrontendLaunchFileError, Parser

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "type_utils",
]
