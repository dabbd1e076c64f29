"""Services of a simulated world: pause, reset, spawn, delete, and the models of what is spawned."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import msgspec

from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.documents import yamlfile
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.geometry.plane import wrapped
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.sim import Pose, RobotDescription, WorldDescription, WorldError
from robolink.sim.checks.appearance import robot_picture_problems
from robolink.sim.checks.robots import robot_misfits, robot_problems
from robolink.sim.physics.placing import check_pose
from robolink.sim.worldfile import sensor_class
from robolink.system.terminal import shown
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.world_node.runner import Runner
from robolink.world_node.simulation import Simulation


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


# The services of a simulated world: reset, pause, resume, step, teleport, spawn, delete and set_rate.
#
# Each answers with success, or with the reason why not; no request ends the node.


PACKAGE = "robolink_interfaces"

MOST_STEPS = 1_000_000
"""Most steps of one ~/step request."""

Act = Callable[[Any], str]
"""A handler: does what a request asks for, and returns a message. Raises RobolinkError with the reason why not."""


class Services:
    """Service servers of a simulation and its runner, under the node's own name."""

    def __init__(self, node: Node, simulation: Simulation, runner: Runner) -> None:
        self._node, self._simulation, self._runner = node, simulation, runner
        acts: dict[str, tuple[type[Any], Act]] = {
            "reset": (Trigger, self._reset),
            "pause": (Trigger, self._pause),
            "resume": (Trigger, self._resume),
            "teleport": (own_type("Teleport"), self._teleport),
            "spawn": (own_type("Spawn"), self._spawn),
            "delete": (own_type("Delete"), self._delete),
            "set_rate": (own_type("SetRate"), self._set_rate),
        }
        for name, (srv_type, act) in acts.items():
            node.create_service(srv_type, f"~/{name}", functools.partial(self._answer, act))
        # Its answer comes when the steps have been made: in a group of its own it keeps nothing else from running.
        group = MutuallyExclusiveCallbackGroup()
        node.create_service(own_type("Step"), "~/step", self._on_step, callback_group=group)

    def _answer(self, act: Act, request: Any, response: Any) -> Any:
        try:
            response.success, response.message = True, act(request)
            self._node.get_logger().info(response.message)
        except RobolinkError as error:
            response.success, response.message = False, str(error)
        return response

    async def _on_step(self, request: Any, response: Any) -> Any:
        steps = request.steps
        if self._runner.running:
            response.message = "the world runs by itself: pause it before you ask for steps"
        elif not 1 <= steps <= MOST_STEPS:
            response.message = f"expected 1 to {MOST_STEPS} steps, got {steps}"
        elif await self._runner.advance(steps):
            response.success = True
            response.message = f"{steps} steps, at {self._simulation.world.time_ns / 1e9:.6g} s"
        else:
            response.message = "something else came before all steps were made"
        return response

    def _reset(self, _: Any) -> str:
        self._simulation.reset()
        return "reset: every robot is where it started"

    def _pause(self, _: Any) -> str:
        self._runner.pause()
        return f"paused at {self._simulation.world.time_ns / 1e9:.6g} s"

    def _resume(self, _: Any) -> str:
        self._runner.resume()
        return "running"

    def _teleport(self, request: Any) -> str:
        pose = pose_in(self._simulation.description, request.robot, request.x, request.y, request.theta)
        self._simulation.teleport(request.robot, pose)
        return f"{request.robot} is at ({pose.x:g}, {pose.y:g})"

    def _spawn(self, request: Any) -> str:
        simulation = self._simulation
        pose = pose_in(simulation.description, request.name, request.x, request.y, request.theta)
        known = {name: robot.description for name, robot in simulation.world.robots.items()}
        simulation.spawn(robot_like(request.model, request.name, pose, simulation.description, known))
        return f"spawned {request.name} at ({pose.x:g}, {pose.y:g})"

    def _delete(self, request: Any) -> str:
        self._simulation.delete(request.name)
        return f"deleted {request.name}"

    def _set_rate(self, request: Any) -> str:
        """Set the parameter, so that its readers and listeners know."""
        result = self._node.set_parameters([Parameter("rtf", value=request.rtf)])[0]
        if not result.successful:
            raise WorldError(result.reason)
        return f"{request.rtf:g} times real time" if request.rtf else "as fast as it goes"


def own_type(name: str) -> type[Any]:
    """Return a service type that robolink itself defines, even if a user's has the same name."""
    return WORKSPACE_TYPES.built_in(PACKAGE, "srv", name)
