"""The services of a simulated world: reset, pause, resume, step, teleport, spawn, delete and set_rate.

Each answers with success, or with the reason why not; no request ends the node.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.exceptions import RobolinkError
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.sim import WorldError
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.world_node.models import pose_in, robot_like
from robolink.world_node.runner import Runner
from robolink.world_node.simulation import Simulation

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
