"""Scaffolding: the first files of a project, a node or a world, made from templates."""

from robolink.scaffold.naming import ScaffoldError
from robolink.scaffold.writing import Made, new_node, new_project, new_world

__all__ = ["Made", "ScaffoldError", "new_node", "new_project", "new_world"]
