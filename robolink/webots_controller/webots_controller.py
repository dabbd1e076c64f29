"""`WebotsController`: a node with a `robot` that speaks Webots' Python API, driven through the world's topics.

    class Driver(WebotsController):
        def __init__(self):
            super().__init__("driver")
            self.left = self.robot.getDevice("left wheel motor")
            self.left.setPosition(float("inf"))
            self.left.setVelocity(2.0)

Beside it runs `robolink run world -p world:=FILE.wbt`; either may come first.
"""

from __future__ import annotations

import contextlib
import os
from typing import Any
from urllib.parse import unquote, urlsplit

from robolink.exceptions import RobolinkError
from robolink.node import Node
from robolink.webots_controller.robot import Robot

URL, NAME = "WEBOTS_CONTROLLER_URL", "WEBOTS_ROBOT_NAME"
"""Environment variables in which Webots names a controller's robot."""


class WebotsController(Node):
    """A node that drives one robot of Webots, or of a simulated world.

    In a world with several robots the parameter `robot` says which; without it WEBOTS_CONTROLLER_URL
    (`ipc://1234/NAME`) or WEBOTS_ROBOT_NAME. Commands are sent while the node spins.
    """

    def __init__(self, node_name: str = "webots_controller", **options: Any) -> None:
        super().__init__(node_name, **options)
        self.robot = Robot(self, str(self.declare_parameter("robot", robot_name(os.environ)).value))

    def destroy_node(self) -> None:
        """Stop the motors, then destroy the node."""
        robot: Robot | None = getattr(self, "robot", None)  # a constructor that fails destroys its node, too
        if robot is not None:
            with contextlib.suppress(RobolinkError):  # the context may have ended
                robot.halt()
        super().destroy_node()


def robot_name(environ: os._Environ[str] | dict[str, str]) -> str:
    """Return the name of the robot in Webots' environment variables, or ''.

    >>> robot_name({"WEBOTS_CONTROLLER_URL": "tcp://192.168.0.5:1234/my%20robot"})
    'my robot'
    """
    url = urlsplit(environ.get(URL, ""))
    return (unquote(url.path.strip("/")) if url.netloc else "") or environ.get(NAME, "")
