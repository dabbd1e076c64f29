"""Colours of Webots nodes, as texts of a world file; textures are not read."""

from __future__ import annotations

from collections.abc import Iterator

from robolink.sim.colours import hex_of
from robolink.sim.webots.vrml_node import Node

DEEPEST = 12
"""Most groups, joints and solids inside of each other that are searched for a shape with a colour."""


def colour_of_look(look: Node | None) -> str | None:
    """Return the colour of an appearance: `diffuseColor` or `baseColor`; None for none, and for one with a texture."""
    if look is None:
        return None
    if look.type == "PBRAppearance":
        return None if look.nodes("baseColorMap") else _text(look, "baseColor", 1.0)
    material = look.node("material") if look.type == "Appearance" else None
    return None if material is None or look.nodes("texture") else _text(material, "diffuseColor", 0.8)


def colour_of_shape(shape: Node) -> str | None:
    """Return the colour of a Shape, or None."""
    return colour_of_look(shape.node("appearance")) if "appearance" in shape.fields else None


def first_colour(node: Node) -> str | None:
    """Return the colour of the first shape in a node that has one, or None."""
    return next((found for shape in _shapes(node, DEEPEST) if (found := colour_of_shape(shape))), None)


def _shapes(node: Node, depth: int) -> Iterator[Node]:
    if node.type == "Shape":
        yield node
        return
    for field in ("children", "endPoint") if depth else ():
        for child in node.nodes(field) if field in node.fields else ():
            yield from _shapes(child, depth - 1)


def _text(node: Node, field: str, default: float) -> str:
    red, green, blue = (
        round(255 * min(max(each, 0.0), 1.0)) for each in node.numbers(field, default, default, default)
    )
    return hex_of((red, green, blue))
