"""What a robot that is to be spawned is like: a copy of one that is there, or what a text of YAML says."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import msgspec

from robolink import yamltext
from robolink.exceptions import NotFoundError
from robolink.sim import Pose, WorldDescription, WorldError, load_world
from robolink.sim.description import RobotDescription
from robolink.sim.odometry import wrapped

FARTHEST = 100_000.0
"""Metres from the origin, as in world files."""


def pose_at(x: float, y: float, theta: float, world: WorldDescription) -> Pose:
    """Give a pose in a world, theta within half a turn. Raises WorldError for what is no number, or outside."""
    if not (abs(x) <= FARTHEST and abs(y) <= FARTHEST and math.isfinite(theta)):
        raise WorldError(
            f"expected finite numbers, at most {FARTHEST:g} m from the origin, got [{x:g}, {y:g}, {theta:g}]"
        )
    if world.world.size is not None:
        width, height = world.world.size
        if not (0.0 <= x <= width and 0.0 <= y <= height):
            raise WorldError(f"[{x:g}, {y:g}] lies outside of the world's size, [{width:g}, {height:g}]")
    return Pose(x, y, wrapped(theta))


def robot_like(
    model: str, name: str, pose: Pose, world: WorldDescription, known: Mapping[str, RobotDescription]
) -> RobotDescription:
    """Describe a robot that is like `model`: the name of one that is `known`, '' for the first, or YAML.

    Raises NotFoundError for an unknown name, DocumentError and WorldError for a text that describes no robot. What
    the robot is called, and whether it fits into the world, the world itself looks at.
    """
    text = model.strip()
    if not text or text in known:
        return msgspec.structs.replace(known[text] if text else _first(known), name=name, pose=pose)
    if text.replace("_", "").replace("-", "").isalnum():
        raise NotFoundError("robot", text, known)
    return _read(text, name, pose, world)


def _first(known: Mapping[str, RobotDescription]) -> RobotDescription:
    if not known:
        raise WorldError("this world has no robot that could be copied: say in YAML what the new one is like")
    return next(iter(known.values()))


def _read(text: str, name: str, pose: Pose, world: WorldDescription) -> RobotDescription:
    """Read a robot as a world file has it; a name and pose in the text give way."""
    said: Any = yamltext.plain(yamltext.compose(text, "model"), "model")
    if not isinstance(said, dict):
        raise WorldError(f"model: expected a mapping as of a robot in a world file, got {said!r:.60}")
    robot = {**said, "name": name, "pose": [pose.x, pose.y, pose.theta]}
    document = {"world": {"dt": world.world.dt}, "robots": [robot]}
    return load_world("model", text=json.dumps(document)).robots[0]
