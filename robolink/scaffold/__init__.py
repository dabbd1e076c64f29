"""Scaffolding: the first files of a project, a node, a world or a ROS 2 package, made from templates."""

from robolink.scaffold.packages import NewPackage, known_licenses, new_package
from robolink.scaffold.writing import Made, ScaffoldError, new_node, new_project, new_world

__all__ = [
    "Made",
    "NewPackage",
    "ScaffoldError",
    "known_licenses",
    "new_node",
    "new_package",
    "new_project",
    "new_world",
]
