"""A 2D world with robots: exact lidar, driven by force, deterministic. Knows no nodes and no messages."""

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
