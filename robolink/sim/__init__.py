"""A 2D world with robots: exact lidar, driven by force, deterministic. Knows no nodes and no messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.lacking import lazily

if TYPE_CHECKING:
    from robolink.sim.description import Pose, WorldDescription
    from robolink.sim.drive import CommandError
    from robolink.sim.lidar import Scan
    from robolink.sim.placing import WorldError
    from robolink.sim.readings import Inertia, Reading, Velocity, WheelState
    from robolink.sim.robot import Robot
    from robolink.sim.world import World
    from robolink.sim.worldfile import load_world

__all__ = [
    "CommandError",
    "Inertia",
    "Pose",
    "Reading",
    "Robot",
    "Scan",
    "Velocity",
    "WheelState",
    "World",
    "WorldDescription",
    "WorldError",
    "load_world",
]

_HOMES = {
    "CommandError": "drive",
    "Inertia": "readings",
    "Pose": "description",
    "Reading": "readings",
    "Robot": "robot",
    "Scan": "lidar",
    "Velocity": "readings",
    "WheelState": "readings",
    "World": "world",
    "WorldDescription": "description",
    "WorldError": "placing",
    "load_world": "worldfile",
}

# When first used: what only looks at a world file needs no physics.
__getattr__, __dir__ = lazily(__name__, _HOMES, ())
