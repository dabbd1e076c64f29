"""webots_ros2_driver as launch files see it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.launch.ros.launch.actions import RegisterEventHandler
from robolink.launch.ros.launch.bases import Action, LaunchContext, SomeEntitiesType, SomeSubstitutionsType
from robolink.launch.ros.launch.event_handlers import OnProcessStart
from robolink.launch.ros.launch.utilities import LaunchArgumentError
from robolink.launch.ros.launch_ros.actions import Node
from robolink.launch.ros.launch_ros.descriptions import ParameterValue
from robolink.text.names import spelled


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
    """Return the entities that follow a spawned robot.

    Args:
        event: Event with a line of the spawner; its `text` says `success=True` once the robot is there.
        driver_node: What follows: an action or several.

    Returns:
        `driver_node`, or None for any other line.
    """
    return driver_node if "success=True" in event.text.decode(errors="replace") else None


class WaitForControllerConnection(RegisterEventHandler):
    """Start nodes once a driver has started; the driver waits for its robot, and the nodes wait for its topics.

    Args:
        target_driver: The action that starts the driver.
        nodes_to_start: What follows; only the first start of a driver with `respawn` counts.
    """

    def __init__(self, target_driver: Action, nodes_to_start: SomeEntitiesType) -> None:
        handler: Any = OnProcessStart(target_action=target_driver, on_start=nodes_to_start, handle_once=True)
        super().__init__(event_handler=handler)


def controller_protocol() -> str:
    """Return the protocol between a driver and Webots on the same machine."""
    return "ipc"


def controller_ip_address() -> str:
    """Return no address: the world is found by discovery."""
    return ""


def controller_url_prefix(port: str = "1234") -> str:
    """Return the beginning of WEBOTS_CONTROLLER_URL, which the robot's name follows; `port` is the one of Webots."""
    return f"{controller_protocol()}://{port}/"


def get_webots_home(show_warning: bool = False) -> None:
    """Return None: there is no folder of Webots; `show_warning` is of no effect."""


def is_wsl() -> bool:
    """Return False: nothing depends on it here."""
    return False


def is_docker() -> bool:
    """Return False: nothing depends on it here."""
    return False


def has_shared_folder() -> bool:
    """Return False: worlds are read where they are."""
    return False
