"""Sights of a world: the surfaces that its cameras see, made when the first of them looks."""

from __future__ import annotations

from collections.abc import Iterable

from robolink.sim.description import RobotDescription, WorldDescription
from robolink.sim.rendering.renderer import Backdrop, Setting
from robolink.sim.scene.scenery import robot_surfaces, scenery
from robolink.sim.scene.surfaces import Scenery, Surfaces


class Sights:
    """Surfaces of a world that cameras see.

    Args:
        description: The world.
    """

    def __init__(self, description: WorldDescription) -> None:
        self._description = description
        self._scenery: Scenery | None = None
        self._backdrop: Backdrop | None = None
        self._settings: dict[int, Setting] = {}

    def forget(self) -> None:
        """Forget what moves: something has come or gone."""
        self._settings.clear()

    def setting(self, viewer: int, things: Iterable[tuple[int, RobotDescription | int | None]]) -> Setting:
        """Return what a viewer sees, made once.

        Args:
            viewer: Number of the viewer.
            things: What moves, each with the row of its place: robots, obstacles by their places in the description, or
                None for what is not seen.
        """
        if self._scenery is None or self._backdrop is None:
            self._scenery = scenery(self._description)
            self._backdrop = Backdrop(self._scenery)
        if viewer not in self._settings:
            movable = self._scenery.movable
            self._settings[viewer] = Setting(
                self._backdrop, [(row, _surfaces(each, movable)) for row, each in things if each is not None]
            )
        return self._settings[viewer]


def _surfaces(thing: RobotDescription | int, movable: dict[int, Surfaces]) -> Surfaces:
    return movable[thing] if isinstance(thing, int) else robot_surfaces(thing)
