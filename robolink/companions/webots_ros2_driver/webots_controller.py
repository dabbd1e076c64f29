"""Action that starts the driver of a robot (`webots_ros2_driver.webots_controller`), for launch files."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.companions.launch.bases import SomeSubstitutionsType
from robolink.companions.launch_ros.actions import Node
from robolink.text.names import spelled


class WebotsController(Node):
    """Start the driver of a robot in a simulated world: its plugins and the topics of its devices.

    Args:
        output: Of no effect: all lines of all processes are shown.
        respawn: True starts it again whenever it ends.
        remappings: Pairs of a name and what stands for it.
        namespace: Namespace of the driver.
        parameters: Mappings and parameter files; `robot_description` is the path of a URDF file.
        robot_name: Name of the robot in the world, after which the node is named.
        port: Of no effect.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        output: Any = "screen",
        respawn: bool | SomeSubstitutionsType = False,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] = (),
        namespace: SomeSubstitutionsType = "",
        parameters: Iterable[Any] = (),
        robot_name: str = "",
        port: Any = "1234",
        **kwargs: Any,
    ) -> None:
        super().__init__(
            package="webots_ros2_driver",
            executable="driver",
            name=spelled(robot_name, "robot") if robot_name else None,
            namespace=namespace or None,
            parameters=[{"robot": robot_name}, *parameters],
            remappings=remappings,
            respawn=respawn,
            **kwargs,
        )
