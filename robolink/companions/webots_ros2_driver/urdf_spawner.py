"""Action in place of what adds robots to Webots (`webots_ros2_driver.urdf_spawner`): it is left out with one line."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch_ros.actions import Node


class URDFSpawner(Node):
    """Leave out a robot that is described in URDF: a world here takes its robots from its own file.

    Args:
        output: Of no effect, as is all that describes the robot.
        name: Name of the robot.
        urdf_path: Path of its URDF file.
        robot_description: Its URDF as a text.
        relative_path_prefix: Folder of its meshes.
        translation: Its position.
        rotation: Its rotation.
        normal: Settings of Webots' import, as are `box_collision` and `init_pos`.
        box_collision: Another one.
        init_pos: Another one.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        output: Any = "log",
        name: Any = None,
        urdf_path: Any = None,
        robot_description: Any = None,
        relative_path_prefix: Any = None,
        translation: Any = "0 0 0",
        rotation: Any = "0 0 1 0",
        normal: Any = False,
        box_collision: Any = False,
        init_pos: Any = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(package="webots_ros2_driver", executable="urdf_spawner", **kwargs)


def get_webots_driver_node(event: Any, driver_node: Any) -> Any:
    """Return what follows a spawned robot.

    Args:
        event: Event with a line of the spawner; its `text` says `success=True` once the robot is there.
        driver_node: What follows: an action or several.

    Returns:
        `driver_node`, or None for any other line.
    """
    return driver_node if "success=True" in event.text.decode(errors="replace") else None
