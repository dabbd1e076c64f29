"""A 2D world with robots: exact lidar, driven by force, deterministic. Knows no nodes and no messages."""

from robolink.sim.description import Pose, WorldDescription
from robolink.sim.drive import CommandError
from robolink.sim.lidar import Scan
from robolink.sim.robot import Robot, Velocity
from robolink.sim.world import World
from robolink.sim.worldfile import load_world

__all__ = ["CommandError", "Pose", "Robot", "Scan", "Velocity", "World", "WorldDescription", "load_world"]
