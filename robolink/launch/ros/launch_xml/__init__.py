"""launch_xml: ROS 2's launch files in XML."""

from __future__ import annotations

from robolink.launch.ros.launch_xml import launch_description_sources
from robolink.launch.ros.launch_xml.entity import Entity
from robolink.launch.ros.launch_xml.parser import Parser

__all__ = [
    "Entity",
    "Parser",
    "launch_description_sources",
]
