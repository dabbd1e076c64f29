"""Deterministic 2D simulator: robots driven by force, exact lidars. Knows no nodes and no messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
    from robolink.sim.description import RobotDescription, WorldDescription
    from robolink.sim.driving.drive import CommandError
    from robolink.sim.physics.placing import WorldError
    from robolink.sim.quantities import Pose
    from robolink.sim.readings import Inertia, Scan, Velocity, WheelState
    from robolink.sim.rendering.renderer import Shot
    from robolink.sim.robot import Robot
    from robolink.sim.schedule import Reading
    from robolink.sim.world import World
    from robolink.sim.worldfile import check_world, load_world

__all__ = [
    "CommandError",
    "Inertia",
    "Pose",
    "Reading",
    "Robot",
    "RobotDescription",
    "Scan",
    "Shot",
    "Velocity",
    "WheelState",
    "World",
    "WorldDescription",
    "WorldError",
    "check_world",
    "load_world",
]

_HOMES = {
    "CommandError": "driving.drive",
    "Inertia": "readings",
    "Pose": "quantities",
    "Reading": "schedule",
    "Robot": "robot",
    "RobotDescription": "description",
    "Scan": "readings",
    "Shot": "rendering.renderer",
    "Velocity": "readings",
    "WheelState": "readings",
    "World": "world",
    "WorldDescription": "description",
    "WorldError": "physics.placing",
    "check_world": "worldfile",
    "load_world": "worldfile",
}

# When first used: what only looks at a world file needs no physics.
__getattr__, __dir__ = lazily(__name__, _HOMES, ())
