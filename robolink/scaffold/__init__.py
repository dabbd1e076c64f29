"""Scaffolding: the first files of a project, a node, a world or a ROS 2 package, made from templates."""

from robolink.scaffold.licenses import known_licenses
from robolink.scaffold.naming import ScaffoldError
from robolink.scaffold.packages import NewPackage, new_package
from robolink.scaffold.writing import Made, new_node, new_project, new_world

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
