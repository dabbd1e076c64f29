"""launch_yaml: ROS 2's launch files in YAML."""

from __future__ import annotations

from robolink.launch.ros.launch_yaml import launch_description_sources
from robolink.launch.ros.launch_yaml.entity import Entity
from robolink.launch.ros.launch_yaml.parser import Parser

__all__ = [
    "Entity",
    "Parser",
    "launch_description_sources",
]
