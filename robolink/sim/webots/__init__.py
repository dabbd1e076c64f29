"""Import of Webots worlds (.wbt): a flat world with the robots, their drives and their sensors.

description, notes = read("meu_mundo.wbt")
"""

from __future__ import annotations

import os
import warnings
from typing import NamedTuple

from robolink.documents import yamlfile
from robolink.documents.foreign import FileWarning
from robolink.sim.description import WorldDescription

__all__ = ["WebotsWorld", "WorldWarning", "load", "read"]


class WorldWarning(FileWarning):
    """Something of a world is left out or guessed; the text begins with the file's name."""


class WebotsWorld(NamedTuple):
    """A world of Webots, converted, and what was left out or guessed: a sentence each."""

    description: WorldDescription
    notes: tuple[str, ...]

    def warning(self, name: str | os.PathLike[str]) -> str:
        """Return all notes as one text; '' if there are none."""
        return f"{os.fspath(name)}: {'; '.join(self.notes)}" if self.notes else ""


def load(path: str | os.PathLike[str], text: str | None = None) -> WorldDescription:
    """Read a world of Webots (or `text` in its place); one `WorldWarning` says what was left out.

    The errors are those of `read`.
    """
    world = read(path, text)
    if world.notes:
        warnings.warn(world.warning(path), WorldWarning, stacklevel=2)
    return world.description


def read(path: str | os.PathLike[str], text: str | None = None) -> WebotsWorld:
    """Read a world of Webots (or `text` in its place), with the PROTOs that lie beside it.

    Lengths, angles and heights are the file's; seen from above, x is east and y north. Raises `DocumentError` with
    `file:line:column` for what is not VRML, impossible sizes, and robots that start inside something.
    """
    from robolink.sim.webots.convert import convert
    from robolink.sim.webots.protos import Protos
    from robolink.sim.webots.scene_tree import KNOWN_TYPES
    from robolink.sim.webots.vrml import parse, parse_proto
    from robolink.sim.webots.vrml_node import LONGEST, Notes

    name, repaired = os.fspath(path), Notes()
    protos = Protos(repaired, KNOWN_TYPES, parse_proto)
    nodes = parse(yamlfile.read_text(path, LONGEST) if text is None else text, name, protos)
    description, notes = convert(nodes, name, protos.missing)
    return WebotsWorld(description, (*notes, *(each.removeprefix(f"{name}:") for each in repaired)))
