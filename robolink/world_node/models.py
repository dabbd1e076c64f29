"""Models of robots to spawn: a copy of a robot in the world, or a description in YAML."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from robolink.documents import yamlfile
from robolink.exceptions import NotFoundError
from robolink.geometry.plane import wrapped
from robolink.sim import Pose, RobotDescription, WorldDescription, WorldError
from robolink.sim.checks.appearance import robot_picture_problems
from robolink.sim.checks.robots import robot_misfits, robot_problems
from robolink.sim.physics.placing import check_pose
from robolink.sim.worldfile import sensor_class
from robolink.system.terminal import shown


def pose_in(world: WorldDescription, name: str, x: float, y: float, theta: float) -> Pose:
    """Return a pose of a robot, theta within half a turn. Raises WorldError if it is not finite, or outside."""
    check_pose(name, Pose(x, y, theta))
    if world.world.size is not None:
        width, height = world.world.size
        if not (0.0 <= x <= width and 0.0 <= y <= height):
            raise WorldError(f"[{x:g}, {y:g}] lies outside of the world's size, [{width:g}, {height:g}]")
    return Pose(x, y, wrapped(theta))


def robot_like(
    model: str, name: str, pose: Pose, world: WorldDescription, known: Mapping[str, RobotDescription]
) -> RobotDescription:
    """Return the description of a robot like `model`: the name of one that is `known`, '' for the first, or YAML.

    Raises NotFoundError for an unknown name, DocumentError with `model:line:column` for a text that describes no
    robot. What the robot is called, and whether there is room for it, the world itself looks at.
    """
    text = model.strip()
    if not text or text in known:
        return msgspec.structs.replace(known[text] if text else _first(known), name=name, pose=pose)
    if text.replace("_", "").replace("-", "").isalnum():
        raise NotFoundError("robot", shown(text), known)
    return _read(model, name, pose, world.world.dt)


def _first(known: Mapping[str, RobotDescription]) -> RobotDescription:
    if not known:
        raise WorldError("this world has no robot that could be copied: say in YAML what the new one is like")
    return next(iter(known.values()))


class Model(RobotDescription, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A robot as a world file has it, but that a name and a pose may be left out: they give way."""

    name: Any = ""
    pose: Any = None


def _read(text: str, name: str, pose: Pose, dt: float) -> RobotDescription:
    """Read a robot for a world with steps of `dt` seconds."""
    document = yamlfile.read("model", Model, text=text, hook=sensor_class)
    robot = RobotDescription(**{**msgspec.structs.asdict(document.value), "name": "robot", "pose": pose})
    data: Any = document.data
    pictures = robot_picture_problems(robot, Path())
    for problem in itertools.chain(robot_misfits(data), robot_problems(robot, dt), pictures):
        raise document.error(f"${problem.path}", problem.message, key=problem.key)
    return msgspec.structs.replace(robot, name=name)
