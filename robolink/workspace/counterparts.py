"""Table of the executables of ROS packages that have a counterpart here, found under their ROS names.

`robolink run turtlesim turtlesim_node`, launch files and tests find a row of the table as they find an executable of a
user's own package, which goes first. The code is in `robolink/counterparts/PACKAGE/`, or is one of the built-in nodes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from robolink.exceptions import NotFoundError, nearest
from robolink.workspace.built_in import PACKAGE, built_in_workspace
from robolink.workspace.installed import installed_executables
from robolink.workspace.packages import compiled_executables, executable, executables, named, named_executables
from robolink.workspace.ros_programs import CompiledProgramError, ros_program_error
from robolink.workspace.source import NodeSource, canonical


class Counterpart(NamedTuple):
    """Row of the table."""

    target: str
    """``MODULE:NAME`` of a function without arguments or of a Node class; ``nodes/NAME`` for a built-in node."""
    purpose: str
    """Purpose, as one sentence that begins with a verb."""


MOST_NAMED = 10
"""Most executables that an error lists."""
_CPP, _PY = "robolink.counterparts.demo_nodes_cpp", "robolink.counterparts.demo_nodes_py"
_EXAMPLES, _TOOLS = "robolink.counterparts.examples_rclpy", "robolink.counterparts.topic_tools"


def _forms(noun: str) -> list[str]:
    """Return the names of the example programs with topics, which do the same."""
    inner = "lambda" if noun == "subscriber" else "local_function"
    return [f"{noun}_{each}" for each in (inner, "member_function", "old_school")]


COUNTERPARTS: dict[str, dict[str, Counterpart]] = {
    "demo_nodes_cpp": {
        "add_two_ints_client_async": Counterpart(f"{_CPP}.add_two_ints_client_async:main", "Asks for a sum."),
        "add_two_ints_client": Counterpart(f"{_CPP}.add_two_ints_client:main", "Asks for a sum."),
        "add_two_ints_server": Counterpart(
            f"{_CPP}.add_two_ints_server:AddTwoIntsServer", "Adds two numbers on request."
        ),
        "listener": Counterpart(f"{_CPP}.listener:Listener", "Logs what it hears."),
        "listener_best_effort": Counterpart(
            f"{_CPP}.listener_best_effort:ListenerBestEffort", "Logs what it hears, and may miss some."
        ),
        "parameter_blackboard": Counterpart(f"{_CPP}.parameter_blackboard:ParameterBlackboard", "Keeps parameters."),
        "talker": Counterpart(f"{_CPP}.talker:Talker", "Publishes a count each second."),
    },
    "demo_nodes_py": {
        "add_two_ints_client": Counterpart(f"{_PY}.add_two_ints_client:main", "Asks for a sum."),
        "add_two_ints_client_async": Counterpart(f"{_PY}.add_two_ints_client_async:main", "Asks for a sum."),
        "add_two_ints_server": Counterpart(
            f"{_PY}.add_two_ints_server:AddTwoIntsServer", "Adds two numbers on request."
        ),
        "async_param_client": Counterpart(f"{_PY}.async_param_client:main", "Sets and gets parameters."),
        "introspection": Counterpart(f"{_PY}.introspection:main", "Has calls observed."),
        "listener": Counterpart(f"{_PY}.listener:Listener", "Logs what it hears."),
        "listener_qos": Counterpart(f"{_PY}.listener_qos:main", "Logs what it hears, best effort or reliably."),
        "listener_serialized": Counterpart(
            f"{_PY}.listener_serialized:SerializedListener", "Logs the bytes of what it hears."
        ),
        "set_parameters_callback": Counterpart(
            f"{_PY}.set_parameters_callback:SetParametersCallback", "Sets a parameter by another one."
        ),
        "talker": Counterpart(f"{_PY}.talker:Talker", "Publishes a count each second."),
        "talker_qos": Counterpart(f"{_PY}.talker_qos:main", "Publishes a count, best effort or reliably."),
    },
    **{
        f"examples_rclpy_minimal_{package}": {name: Counterpart(f"{_EXAMPLES}.{target}", purpose) for name in names}
        for package, target, purpose, names in (
            ("publisher", "minimal_publisher:MinimalPublisher", "Publishes a count.", _forms("publisher")),
            ("subscriber", "minimal_subscriber:MinimalSubscriber", "Logs what it hears.", _forms("subscriber")),
            (
                "service",
                "minimal_service:MinimalService",
                "Adds two numbers on request.",
                ["service", "service_member_function"],
            ),
            (
                "client",
                "minimal_client:main",
                "Asks for a sum.",
                ["client", "client_async", "client_async_callback", "client_async_member_function"],
            ),
            (
                "action_server",
                "minimal_action_server:MinimalActionServer",
                "Computes Fibonacci's numbers.",
                ["server", "server_not_composable"],
            ),
            (
                "action_client",
                "minimal_action_client:main",
                "Asks for Fibonacci's numbers.",
                ["client", "client_asyncio", "client_not_composable"],
            ),
        )
    },
    "image_tools": {
        "cam2image": Counterpart("robolink.counterparts.image_tools.cam2image:main", "Publishes a camera's pictures."),
        "showimage": Counterpart("robolink.counterparts.image_tools.showimage:main", "Shows pictures in a window."),
    },
    "joint_state_publisher": {
        "joint_state_publisher": Counterpart(
            "robolink.counterparts.joint_state_publisher.joint_state_publisher:main", "Publishes a state of each joint."
        ),
    },
    "joint_state_publisher_gui": {
        "joint_state_publisher_gui": Counterpart(
            "robolink.counterparts.joint_state_publisher.joint_state_publisher_gui:main",
            "Publishes a state of each joint, which parameters set.",
        ),
    },
    "joy": {
        "game_controller_node": Counterpart(
            "robolink.counterparts.joy.game_controller_node:main", "Publishes a gamepad's state in one order for all."
        ),
        "joy_enumerate_devices": Counterpart(
            "robolink.counterparts.joy.joy_enumerate_devices:main", "Lists the gamepads of this machine."
        ),
        "joy_node": Counterpart("robolink.counterparts.joy.joy_node:main", "Publishes a gamepad's state."),
    },
    "joy_linux": {
        "joy_linux_node": Counterpart("robolink.counterparts.joy.joy_linux_node:main", "Publishes a gamepad's state."),
    },
    "lifecycle": {
        "lifecycle_listener": Counterpart(
            "robolink.counterparts.lifecycle.lifecycle_listener:LifecycleListener", "Logs a managed node's doings."
        ),
        "lifecycle_service_client": Counterpart(
            "robolink.counterparts.lifecycle.lifecycle_service_client:main", "Leads a managed node through its states."
        ),
        "lifecycle_talker": Counterpart(
            "robolink.counterparts.lifecycle.lifecycle_talker:main", "Publishes a count while it is active."
        ),
    },
    "nav2_lifecycle_manager": {
        "lifecycle_manager": Counterpart(
            "robolink.counterparts.nav2_lifecycle_manager.lifecycle_manager:main", "Starts managed nodes in order."
        ),
    },
    "nav2_map_server": {
        "costmap_filter_info_server": Counterpart(
            "robolink.counterparts.nav2_map_server.costmap_filter_info_server:main", "Publishes what a mask means."
        ),
        "map_saver_cli": Counterpart(
            "robolink.counterparts.nav2_map_server.map_saver_cli:main", "Saves a map, and ends."
        ),
        "map_saver_server": Counterpart(
            "robolink.counterparts.nav2_map_server.map_saver_server:main", "Saves maps on request."
        ),
        "map_server": Counterpart(
            "robolink.counterparts.nav2_map_server.map_server:main", "Publishes a map of a file."
        ),
    },
    "rclcpp_components": {
        "component_container": Counterpart(
            "robolink.cli.running_nodes.component_container:main", "Runs nodes that services load."
        ),
        "component_container_isolated": Counterpart(
            "robolink.cli.running_nodes.component_container:main", "Runs nodes that services load."
        ),
        "component_container_mt": Counterpart(
            "robolink.cli.running_nodes.component_container:main_mt", "Runs nodes that services load, in threads."
        ),
    },
    "robot_state_publisher": {
        "robot_state_publisher": Counterpart(
            "robolink.counterparts.robot_state_publisher.robot_state_publisher:main", "Publishes a robot's transforms."
        ),
    },
    "teleop_twist_joy": {
        "teleop_node": Counterpart(
            "robolink.counterparts.teleop_twist_joy.teleop_node:main", "Drives a robot by a gamepad."
        ),
    },
    **{
        package: {package: Counterpart(f"robolink.cli.view.ros_programs:{package}", purpose)}
        for package, purpose in (
            ("rqt_console", "Opens the log of robolink view."),
            ("rqt_graph", "Opens the graph of robolink view."),
            ("rqt_image_view", "Opens the images of robolink view."),
            ("rqt_plot", "Opens the plots of robolink view."),
            ("rqt_reconfigure", "Opens the parameters of robolink view."),
            ("rqt_robot_steering", "Opens the panel of robolink view that drives."),
            ("rqt_service_caller", "Opens the services of robolink view."),
            ("rqt_topic", "Opens the topics of robolink view."),
            ("rviz2", "Opens the world of robolink view."),
        )
    },
    "rqt": {"rqt": Counterpart("robolink.cli.view.ros_programs:rqt", "Opens panels of robolink view.")},
    "rqt_gui": {"rqt_gui": Counterpart("robolink.cli.view.ros_programs:rqt", "Opens panels of robolink view.")},
    "teleop_twist_keyboard": {
        "teleop_twist_keyboard": Counterpart(
            "robolink.counterparts.teleop_twist_keyboard.teleop_twist_keyboard:main", "Drives a robot by the keyboard."
        ),
    },
    "tf2_ros": {
        "buffer_server": Counterpart(
            "robolink.counterparts.tf2_ros.buffer_server:main", "Serves look-ups of transforms."
        ),
        "static_transform_publisher": Counterpart("nodes/static_transform_publisher", "Publishes one fixed transform."),
        "tf2_echo": Counterpart("robolink.cli.tf.ros_programs:tf2_echo", "Shows where a frame is in another."),
        "tf2_monitor": Counterpart("robolink.cli.tf.ros_programs:tf2_monitor", "Shows who publishes transforms."),
    },
    "tf2_tools": {
        "view_frames": Counterpart("robolink.cli.tf.ros_programs:view_frames", "Writes the tree of frames as a graph."),
    },
    "topic_tools": {
        "delay": Counterpart(f"{_TOOLS}.delay:main", "Passes on messages, some time later."),
        "demux": Counterpart(f"{_TOOLS}.demux:main", "Passes on messages to one of several topics."),
        "drop": Counterpart(f"{_TOOLS}.drop:main", "Passes on messages, but for some of them."),
        "mux": Counterpart(f"{_TOOLS}.mux:main", "Passes on messages of one of several topics."),
        "relay": Counterpart(f"{_TOOLS}.relay:main", "Passes on messages to another topic."),
        "relay_field": Counterpart(f"{_TOOLS}.relay_field:main", "Publishes fields as messages of another type."),
        "throttle": Counterpart(f"{_TOOLS}.throttle:main", "Passes on so many messages or bytes per second."),
        "transform": Counterpart(f"{_TOOLS}.transform:main", "Publishes what an expression makes of messages."),
    },
    "turtle_tf2_py": {
        "turtle_tf2_broadcaster": Counterpart(
            "robolink.counterparts.turtle_tf2_py.turtle_tf2_broadcaster:FramePublisher", "Makes a frame of a turtle."
        ),
        "turtle_tf2_listener": Counterpart(
            "robolink.counterparts.turtle_tf2_py.turtle_tf2_listener:FrameListener", "Has a turtle follow a frame."
        ),
    },
    "turtlesim": {
        "draw_square": Counterpart(
            "robolink.counterparts.turtlesim.draw_square:DrawSquare", "Has a turtle draw squares."
        ),
        "mimic": Counterpart("robolink.counterparts.turtlesim.mimic:Mimic", "Drives a turtle as another one swims."),
        "turtle_teleop_key": Counterpart(
            "robolink.counterparts.turtlesim.turtle_teleop_key:main", "Drives a turtle by the keyboard."
        ),
        "turtlesim_node": Counterpart(
            "robolink.counterparts.turtlesim.turtlesim_node:main", "Simulates turtles that draw, shown in the browser."
        ),
    },
    "webots_ros2_driver": {
        "driver": Counterpart(
            "robolink.counterparts.webots_ros2_driver.driver:main", "Runs the plugins of a robot of Webots."
        ),
        "webots": Counterpart("nodes/world", "Simulates a world of Webots."),
    },
    "xacro": {
        "xacro": Counterpart("robolink.counterparts.xacro.xacro:main", "Prints the XML of a file with macros."),
    },
}
"""Counterparts by package and executable."""


def counterparts_of(package: str) -> Mapping[str, Counterpart]:
    """Return the counterparts in `package`, by executable; none for a package without any."""
    return COUNTERPARTS.get(canonical(package), {})


def counterpart_folder(package: str) -> Path | None:
    """Return the folder of the counterparts of `package`, which may have launch files; None if it has none here."""
    if not counterparts_of(package):
        return None
    folder = PACKAGE / "counterparts"
    own = folder / canonical(package)
    return own if own.is_dir() else folder


def counterpart(package: str, name: str) -> NodeSource | None:
    """Return the source of the counterpart of the executable `name` of `package`; None if there is none."""
    row = counterparts_of(package).get(canonical(name).removesuffix(".py"))
    if row is None:
        return None
    found = source_at(row.target)
    return replace(found, name=canonical(name).removesuffix(".py")) if found.attribute else found


def source_at(target: str) -> NodeSource:
    """Return the source of a `target` as rows of the table have it, or `nodes/NAME:CLASS` for a built-in one."""
    module, _, attribute = target.partition(":")
    if module.startswith("nodes/"):
        return NodeSource(module.removeprefix("nodes/"), built_in_workspace() / f"{module}.py", attribute)
    return NodeSource(module.rpartition(".")[2], _file_of(module), attribute)


def executable_of(package: str, name: str, folder: Path | None) -> NodeSource | None:
    """Return the executable `name` of a package in `folder`, else its counterpart, else one that was installed.

    None if there is none of them.

    Args:
        package: Name of the package.
        name: Name of the executable.
        folder: Folder of the user's own package of this name; None if there is none.
    """
    own = None if folder is None else executable(folder, name)
    return own or counterpart(package, name) or named(name, installed_executables(package))


def lacking_executable(package: str, name: str, folder: Path | None) -> NotFoundError | None:
    """Return the error for an executable that is not there; None if the package is not known, or has none at all.

    Args:
        package: Name of the package.
        name: Name of the executable.
        folder: Folder of the user's own package of this name; None if there is none.
    """
    own = executables(folder) if folder is not None else installed_executables(package)
    known = [*own, *counterparts_of(package)]
    if folder is None:
        of_ros = ros_program_error(package, name, by_package=not known)
        if of_ros is not None:
            return of_ros
    elif canonical(name) in map(canonical, compiled_executables(folder)):
        return CompiledProgramError(package, name)
    if not known:
        return None
    error = NotFoundError("executable", name, known, f"package {package}")
    if not nearest(name, known):
        first = [each.name for each in named_executables(folder)] if folder is not None else []
        shown = [*(first or own), *counterparts_of(package)]
        error.args = (f"{error}, which has {', '.join(shown[:MOST_NAMED])}{' ...' if len(shown) > MOST_NAMED else ''}",)
    return error


def _file_of(module: str) -> Path:
    """Return the file of a module of robolink."""
    path = PACKAGE.parent.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
