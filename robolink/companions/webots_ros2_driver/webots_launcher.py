"""Actions in place of Webots and its supervisor (`webots_ros2_driver.webots_launcher`): a simulated world is both."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.bases import Action, LaunchContext, SomeSubstitutionsType
from robolink.companions.launch.utilities import LaunchArgumentError
from robolink.companions.launch_ros.actions import Node
from robolink.companions.launch_ros.parameter_descriptions import ParameterValue


class WebotsLauncher(Node):
    """Start a simulated world from a world file of Webots.

    Args:
        output: Of no effect here, as are `gui`, `mode`, `stream` and `port`: `robolink view` shows the world.
        world: Path of the world file, with the suffix .wbt.
        gui: Of no effect.
        mode: Of no effect: the world keeps pace with real time.
        stream: Of no effect.
        ros2_supervisor: True has the world's time published on /clock, and `_supervisor` is there.
        port: Of no effect.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        output: Any = "screen",
        world: SomeSubstitutionsType | None = None,
        gui: Any = True,
        mode: Any = "realtime",
        stream: Any = False,
        ros2_supervisor: bool = False,
        port: Any = "1234",
        **kwargs: Any,
    ) -> None:
        if world is None:
            raise LaunchArgumentError("WebotsLauncher needs a world=..., the path of a file with the suffix .wbt")
        if ros2_supervisor:
            self._supervisor = Ros2SupervisorLauncher(port=port)
        settings = {"world": ParameterValue(world, value_type=str), "publish_clock": bool(ros2_supervisor)}
        super().__init__(package="webots_ros2_driver", executable="webots", parameters=[settings], **kwargs)


class Ros2SupervisorLauncher(Action):
    """Do nothing: the world itself publishes /clock and has services such as `spawn`.

    Args:
        output: Of no effect, as are `respawn` and `port`.
        respawn: Of no effect.
        port: Of no effect.
        condition: Condition of the action.
        **kwargs: Settings of a process, which are of no effect either.
    """

    def __init__(
        self, output: Any = "screen", respawn: Any = True, port: Any = "1234", condition: Any = None, **kwargs: Any
    ) -> None:
        super().__init__(condition=condition)

    def execute(self, context: LaunchContext) -> None:
        """Do nothing, whatever the values of `context`."""
