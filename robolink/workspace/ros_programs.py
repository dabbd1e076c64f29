"""Advice for programs of well-known ROS packages that robolink lacks: what each is, and what serves instead."""

from __future__ import annotations

from fnmatch import fnmatchcase

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.workspace.source import canonical

_ANYWHERE = "on a machine with ROS 2 it sees the same topics (docs/reference/ros2.md)"
_THERE = "run it on a machine with ROS 2: it meets robolink's nodes (docs/reference/ros2.md)"
_WORLD = (
    "'robolink run world' simulates a robot with the topics of a TurtleBot3 instead: "
    "/cmd_vel, /scan, /odom, /tf, /imu (docs/reference/simulator.md)"
)
_WEBOTS = "Webots' driver; 'robolink run world' reads Webots' worlds and robots instead (docs/reference/webots.md)"
_URDF_ROBOT = (
    "a world takes its robots from its own file: put a Robot node into its .wbt file (docs/reference/webots.md)"
)
_NAVIGATION = "a part of Nav2, in C++; 'robolink launch navigate' has those that localize, plan, drive and recover"
_FILTER = f"a Kalman filter in C++; the world's /odom needs none, for a real robot {_THERE}"
_DRIVER = f"driver of a device, in C++; {_THERE}"
_CAMERA = f"driver of a camera, in C++; some lines with cv2.VideoCapture and cv_bridge do the same, else {_THERE}"
_MAPS = f"makes maps, in C++; 'robolink launch map_it' does, too, else {_THERE}"

PROGRAMS = {
    ("rmw_zenoh_cpp", "rmw_zenohd"): "robolink needs no router, and meets one that runs (docs/reference/ros2.md)",
    ("gazebo_ros", "spawn_entity"): f"puts a robot into Gazebo; {_WORLD}",
    ("gazebo_ros", "gzclient"): "Gazebo's window; 'robolink view' shows the world in the browser instead",
    ("ros_gz_sim", "create"): f"puts a robot into Gazebo; {_WORLD}",
    (
        "ros_gz_bridge",
        "parameter_bridge",
    ): "translates Gazebo's topics; 'robolink run world' needs no bridge",
    ("controller_manager", "spawner"): f"loads controllers of ros2_control, which are C++; {_WORLD}",
    ("controller_manager", "ros2_control_node"): f"runs controllers of ros2_control, which are C++; {_WORLD}",
    (
        "webots_ros2_driver",
        "ros2_supervisor",
    ): "Webots' supervisor; the world itself publishes /clock and spawns robots",
    ("webots_ros2_driver", "urdf_spawner"): f"it adds a robot of a URDF file to Webots; {_URDF_ROBOT}",
    ("robot_localization", "ekf_node"): _FILTER,
    ("robot_localization", "ukf_node"): _FILTER,
}
"""Advice by package and program."""
PACKAGES = {
    "rqt*": "a window; 'robolink view' has panels for topics, plots, images, logs, services and parameters",
    "gazebo_ros": f"Gazebo, a simulator in C++; {_WORLD}",
    "gazebo": f"Gazebo, a simulator in C++; {_WORLD}",
    "gzserver": f"Gazebo, a simulator in C++; {_WORLD}",
    "gzclient": "Gazebo's window; 'robolink view' shows the world in the browser instead",
    "gz": f"Gazebo, a simulator in C++; {_WORLD}",
    "ign": f"Gazebo, a simulator in C++; {_WORLD}",
    "gazebo_plugins": f"parts of Gazebo, in C++; {_WORLD}",
    "gazebo_ros2_control": f"ros2_control in Gazebo, in C++; {_WORLD}",
    "gz_ros2_control": f"ros2_control in Gazebo, in C++; {_WORLD}",
    "ign_ros2_control": f"ros2_control in Gazebo, in C++; {_WORLD}",
    "ros_gz*": f"Gazebo, a simulator in C++; {_WORLD}",
    "ros_ign*": f"Gazebo, a simulator in C++; {_WORLD}",
    "turtlebot3_gazebo": f"Gazebo with a TurtleBot3; {_WORLD}",
    "webots_ros2_driver": _WEBOTS,
    "webots_ros2": _WEBOTS,
    "controller_manager": f"ros2_control, in C++; {_WORLD}",
    "diff_drive_controller": f"a controller of ros2_control, in C++; {_WORLD}",
    "ros2_controllers": f"controllers of ros2_control, in C++; {_WORLD}",
    "joint_state_broadcaster": f"a controller of ros2_control, in C++; {_WORLD}",
    "robot_localization": _FILTER,
    "imu_filter_madgwick": _FILTER,
    "imu_complementary_filter": _FILTER,
    "nav2_*": _NAVIGATION,
    "opennav_*": _NAVIGATION,
    "turtlebot3_navigation2": _NAVIGATION,
    "slam_toolbox": f"its nodes that map and localize are here, what remains is in C++; {_THERE}",
    "cartographer_ros": _MAPS,
    "turtlebot3_cartographer": _MAPS,
    "rtabmap_*": _MAPS,
    "octomap_server": _MAPS,
    "moveit*": f"MoveIt, which plans arms in C++; {_THERE}",
    "*_moveit_config": f"settings of MoveIt, which plans arms in C++; {_THERE}",
    "realsense2_camera": _DRIVER,
    "usb_cam": _CAMERA,
    "v4l2_camera": _CAMERA,
    "camera_ros": _DRIVER,
    "depthai_ros_driver": _DRIVER,
    "zed_wrapper": _DRIVER,
    "astra_camera": _DRIVER,
    "orbbec_camera": _DRIVER,
    "velodyne*": _DRIVER,
    "ouster_ros": _DRIVER,
    "livox_ros_driver2": _DRIVER,
    "urg_node*": _DRIVER,
    "rplidar_ros": _DRIVER,
    "sllidar_ros2": _DRIVER,
    "ydlidar_ros2_driver": _DRIVER,
    "ldlidar*": _DRIVER,
    "hls_lfcd_lds_driver": _DRIVER,
    "turtlebot3_node": _DRIVER,
    "kobuki_node": _DRIVER,
    "create_driver": _DRIVER,
    "ur_robot_driver": _DRIVER,
    "nmea_navsat_driver": _DRIVER,
    "ublox_gps": _DRIVER,
    "mavros": f"bridge to flight controllers, in C++; {_THERE}",
    "px4*": f"PX4's parts, in C++; {_THERE}",
    "micro_ros_agent": f"bridge to microcontrollers with micro-ROS, in C++; {_THERE}",
    "foxglove_bridge": "'robolink view' speaks Foxglove's protocol at ws://localhost:8765 (docs/reference/view.md)",
    "rosbridge_server": f"for roslibjs; view serves Foxglove's clients (docs/reference/view.md), else {_THERE}",
    "image_proc": f"corrects images, in C++; cv2.undistort and image_geometry do the same in a node, else {_THERE}",
    "depth_image_proc": f"makes point clouds of depth images, in C++; {_THERE}",
    "stereo_image_proc": f"makes point clouds of two cameras' images, in C++; {_THERE}",
    "pointcloud_to_laserscan": f"translates point clouds, in C++; {_THERE}",
    "laser_filters": f"filters scans, in C++; {_THERE}",
    "apriltag_ros": f"finds AprilTags, in C++; {_THERE}",
    "aruco_ros": f"finds ArUco tags, in C++; cv2.aruco does the same in a node, else {_THERE}",
    "diagnostic_aggregator": f"sorts /diagnostics, in C++; 'robolink topic echo /diagnostics' shows all, else {_THERE}",
    "twist_mux": f"chooses among velocity commands, in C++; {_THERE}",
    "rosbag2_*": "'robolink bag record' and 'robolink bag play' do the same",
}
"""Advice by package, for any program of it; ``*`` stands for any letters, and a name without it goes first."""


class RosProgramError(NotFoundError):
    """The `program` of a `package` was requested, which robolink lacks; the text has the `advice`."""

    def __init__(self, package: str, program: str, advice: str) -> None:
        self.kind, self.name = "package", package
        RobolinkError.__init__(self, f"{package} {program}".rstrip() + f" is not here: {advice}")


class CompiledProgramError(RosProgramError):
    """The `program` of a user's own `package` is C++."""

    def __init__(self, package: str, program: str) -> None:
        self.kind, self.name = "executable", program
        RobolinkError.__init__(self, f"{package} {program} is a C++ program, and robolink builds none")


def instead_of(package: str, program: str = "") -> str | None:
    """Return the nature of a program of a well-known package and the replacement for it; None for an unknown package.

    >>> instead_of("gazebo_ros", "gzclient")
    "Gazebo's window; 'robolink view' shows the world in the browser instead"

    Args:
        package: Name of the package.
        program: Name of its executable, with or without ``.py``; '' for any.
    """
    known = canonical(package)
    return PROGRAMS.get((known, canonical(program).removesuffix(".py"))) or _of_package(known)


def ros_program_error(package: str, program: str = "", *, by_package: bool = True) -> RosProgramError | None:
    """Return the error for the program `program` of a well-known `package`; None for one that is not known.

    With `by_package` False only what is said of this very program counts.
    """
    advice = instead_of(package, program) if by_package else PROGRAMS.get((canonical(package), canonical(program)))
    return None if advice is None else RosProgramError(package, program, advice)


def _of_package(known: str) -> str | None:
    patterns = (each for each in PACKAGES if "*" in each and fnmatchcase(known, each))
    return PACKAGES.get(known) or PACKAGES.get(next(patterns, ""))
