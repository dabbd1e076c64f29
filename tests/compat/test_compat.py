"""ROS 2's own names are robolink's modules, all of them or none; what is missing is said well."""

from __future__ import annotations

import importlib
import inspect
import pickle
import sys
from pathlib import Path
from typing import Any

import pytest

import robolink
from robolink import interfaces
from robolink.exceptions import RobolinkError
from robolink.interfaces.standard import KINDS, packages, types_of
from robolink.workspace.modules import FINDER
from tests.support.ros_names import VERSION, raised


@pytest.mark.usefixtures("compat")
def test_rclpy_is_robolink_itself() -> None:
    rclpy = importlib.import_module("rclpy")
    assert rclpy is sys.modules["rclpy"] is robolink
    scope: dict[str, Any] = {}
    exec("import rclpy.node, rclpy.qos as q\nfrom rclpy.node import Node\nfrom rclpy import executors as e", scope)
    assert scope["Node"] is robolink.Node is scope["rclpy"].node.Node
    assert scope["q"] is importlib.import_module("robolink.qos")
    assert scope["e"] is importlib.import_module("robolink.executors")
    assert sys.modules["rclpy.node"] is sys.modules["robolink.node"]


@pytest.mark.usefixtures("compat")
def test_a_module_stays_what_it_was() -> None:
    module = importlib.import_module("rclpy.node")
    assert (module.__name__, module.__spec__ is not None and module.__spec__.name) == ("robolink.node",) * 2
    assert inspect.getmodule(module.Node) is module
    assert pickle.loads(pickle.dumps(module.Node)) is robolink.Node
    twist = importlib.import_module("geometry_msgs.msg").Twist()
    twist.linear.x = 0.5
    assert pickle.loads(pickle.dumps(twist)) == twist


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize("kind", KINDS)
def test_every_message_package_is_there(kind: str) -> None:
    for package in filter(lambda each: types_of(each, kind), packages()):
        module = importlib.import_module(f"{package}.{kind}")
        assert module is importlib.import_module(f"robolink.interfaces.{package}.{kind}")
        scope: dict[str, Any] = {}
        exec(f"from {package}.{kind} import *", scope)
        assert {each for each in scope if not each.startswith("__")} == set(types_of(package, kind))


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize(("kind", "name"), [("msg", "Pose"), ("srv", "Spawn"), ("action", "RotateAbsolute")])
def test_turtlesims_types_have_their_newer_package_too(kind: str, name: str) -> None:
    types = importlib.import_module(f"turtlesim_msgs.{kind}")
    assert getattr(types, name) is interfaces.find(f"turtlesim/{kind}/{name}", kind)


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize("kind", KINDS)
def test_the_modules_in_which_rosidl_defines_a_type_are_there(kind: str) -> None:
    from robolink.compat.names import snake_case

    for package in packages():
        for short in types_of(package, kind):
            module = importlib.import_module(f"{package}.{kind}._{snake_case(short)}")
            assert getattr(module, short) is interfaces.find(f"{package}/{kind}/{short}", kind)


@pytest.mark.usefixtures("compat")
def test_a_type_says_where_rosidl_defines_it() -> None:
    scope: dict[str, Any] = {}
    exec("from sensor_msgs.msg import LaserScan\nfrom std_srvs.srv import SetBool\n", scope)
    exec("from example_interfaces.action import Fibonacci", scope)
    scan, switch, action = scope["LaserScan"], scope["SetBool"], scope["Fibonacci"]
    assert str(scan) == "<class 'sensor_msgs.msg._laser_scan.LaserScan'>"
    assert scan().__class__.__module__.split(".")[0] == "sensor_msgs"
    assert str(switch.Request) == "<class 'std_srvs.srv._set_bool.SetBool_Request'>"
    assert str(action.Goal) == "<class 'example_interfaces.action._fibonacci.Fibonacci_Goal'>"
    assert pickle.loads(pickle.dumps(scan(ranges=[1.0]))) == scan(ranges=[1.0])
    assert pickle.loads(pickle.dumps(switch.Request(data=True))) == switch.Request(data=True)
    assert switch.Event.__ros_type__ == "std_srvs/srv/SetBool_Event"


@pytest.mark.usefixtures("compat")
def test_private_modules_have_the_parts_of_services_and_actions() -> None:
    scope: dict[str, Any] = {}
    exec(
        "from std_srvs.srv._set_bool import SetBool_Request\n"
        "from example_interfaces.action._fibonacci import Fibonacci, Fibonacci_Goal, Fibonacci_FeedbackMessage\n"
        "from sensor_msgs.msg._point_cloud2 import PointCloud2\nfrom tf2_msgs.msg._tf_message import TFMessage",
        scope,
    )
    assert scope["SetBool_Request"](data=True).data is True
    assert scope["Fibonacci_Goal"] is scope["Fibonacci"].Goal
    assert scope["Fibonacci_FeedbackMessage"] is scope["Fibonacci"].Impl.FeedbackMessage


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize(
    "name",
    [
        *(
            "rosidl_runtime_py.utilities",
            "ament_index_python.packages",
            "cv_bridge.core",
            "image_geometry.cameramodels",
        ),
        *("tf2_geometry_msgs.tf2_geometry_msgs", "nav2_simple_commander.utils", "rosbag2_py._reader"),
        *("sensor_msgs.msg._image", "std_srvs.srv._set_bool"),
    ],
)
def test_a_module_is_imported_from_its_package(name: str) -> None:
    package, _, module = name.rpartition(".")
    scope: dict[str, Any] = {}
    exec(f"from {package} import {module} as found", scope)
    assert dir(scope["found"]) == dir(importlib.import_module(name))


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize(
    "name",
    [
        *(
            "launch.frontend.entity.Entity",
            "launch.actions.execute_process.ExecuteProcess",
            "launch.logging.get_logger",
        ),
        *("launch.substitutions.text_substitution.TextSubstitution", "launch.launch_context.LaunchContext"),
        *("launch.events.process.process_exited.ProcessExited", "launch_ros.actions.node.Node"),
        *("launch_ros.substitutions.executable_in_package.ExecutableInPackage", "launch_ros.utilities.add_node_name"),
        *("launch_testing.asserts.assert_exit_codes.assertExitCodes", "launch_testing.util.proc_lookup"),
    ],
)
def test_the_import_of_a_package_of_launch_brings_its_modules(name: str) -> None:
    found = importlib.import_module(name.partition(".")[0])
    for part in name.split(".")[1:]:
        found = getattr(found, part)
    module, _, last = name.rpartition(".")
    assert found is getattr(importlib.import_module(module), last)


@pytest.mark.usefixtures("compat")
def test_all_names_of_the_events_of_processes_hide_no_action() -> None:
    scope: dict[str, Any] = {}
    exec("from launch.actions import *\nfrom launch.events.process import *", scope)
    assert scope["Shutdown"] is importlib.import_module("launch.actions").Shutdown
    assert scope["ProcessExited"] is importlib.import_module("launch.events.process.process_exited").ProcessExited


@pytest.mark.usefixtures("compat")
def test_a_function_stays_one_though_its_module_has_its_name() -> None:
    name = "launch_testing.parametrize"
    package, _, function = name.rpartition(".")
    scope: dict[str, Any] = {}
    exec(f"import {package}\nfrom {name} import {function} as inner\nfrom {package} import {function} as outer", scope)
    assert scope["outer"] is scope["inner"]
    assert callable(scope["inner"])


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize(
    ("name", "attribute", "room"),
    [
        ("tf2_ros", "Buffer", "tf2"),
        ("tf2_ros.buffer", "Buffer", "tf2.buffer"),
        ("tf2_ros.transform_listener", "TransformListener", "tf2.transform_listener"),
        ("tf2_py", "BufferCore", "tf2"),
        ("tf2_geometry_msgs", "do_transform_pose", "tf2.geometry"),
        ("tf2_geometry_msgs.tf2_geometry_msgs", "do_transform_pose", "tf2.geometry"),
        ("tf2_sensor_msgs", "do_transform_cloud", "tf2.point_cloud"),
        ("tf_transformations", "quaternion_from_euler", "geometry.transformations"),
        ("message_filters", "ApproximateTimeSynchronizer", "companions.message_filters"),
        ("sensor_msgs_py.numpy_compat", "structured_to_unstructured", "sensor_msgs_py.numpy_compat"),
        ("sensor_msgs_py.numpy_compat", "unstructured_to_structured", "sensor_msgs_py.numpy_compat"),
        ("sensor_msgs_py.point_cloud2", "read_points", "sensor_msgs_py.point_cloud2"),
        ("cv_bridge", "CvBridge", "companions.cv_bridge"),
        ("cv_bridge.core", "CvBridgeError", "companions.cv_bridge"),
        ("cv_bridge.boost.cv_bridge_boost", "getCvType", "companions.cv_bridge"),
        ("image_geometry", "PinholeCameraModel", "companions.image_geometry"),
        ("image_geometry.cameramodels", "StereoCameraModel", "companions.image_geometry"),
        ("rosidl_runtime_py", "set_message_fields", "companions.rosidl_runtime"),
        ("rosidl_runtime_py.utilities", "get_message", "companions.rosidl_runtime"),
        ("ament_index_python", "get_package_share_directory", "companions.ament_index"),
        ("ament_index_python.packages", "PackageNotFoundError", "companions.ament_index"),
        ("rosbag2_py", "SequentialReader", "companions.rosbag2_py"),
        ("rosbag2_py._storage", "StorageOptions", "companions.rosbag2_py._storage"),
        ("rclpy.action", "ActionServer", "action"),
        ("rclpy.action.client", "ClientGoalHandle", "action.client"),
        ("rclpy.lifecycle", "LifecycleNode", "lifecycle"),
        ("rclpy.impl.logging_severity", "LoggingSeverity", "impl.logging_severity"),
    ],
)
def test_companions_are_there_under_their_names(name: str, attribute: str, room: str) -> None:
    module = importlib.import_module(name)
    assert module is importlib.import_module(f"robolink.{room}")
    assert hasattr(module, attribute)


@pytest.mark.usefixtures("compat")
def test_a_package_with_nothing_of_its_own() -> None:
    scope: dict[str, Any] = {}
    exec("from sensor_msgs_py import point_cloud2\nimport sensor_msgs_py.point_cloud2 as again", scope)
    assert scope["again"] is scope["point_cloud2"]


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize(
    ("code", "kind", "report"),
    [
        ("from rclpy.node import Nod", ImportError, "rclpy.node.Nod (did you mean 'Node'?)"),
        ("from rclpy import Nod", ImportError, "rclpy.Nod (did you mean 'Node'?)"),
        ("import rclpy; rclpy.spinn", AttributeError, "rclpy.spinn (did you mean 'spin'?)"),
        ("import rclpy.node; rclpy.node.Nod", AttributeError, "rclpy.node.Nod (did you mean 'Node'?)"),
        ("import rclpy.executor", ModuleNotFoundError, "rclpy.executor (did you mean 'executors'?)"),
        ("from rclpy.executor import X", ModuleNotFoundError, "rclpy.executor (did you mean 'executors'?)"),
        ("from std_msg.msg import String", ModuleNotFoundError, "std_msg (did you mean 'std_msgs'?)"),
        ("import geometry_mgs.msg", ModuleNotFoundError, "geometry_mgs (did you mean 'geometry_msgs'?)"),
        ("import rclp", ModuleNotFoundError, "rclp (did you mean 'rclpy'?)"),
        (
            "import sensors_msgs",
            ModuleNotFoundError,
            (
                "sensors_msgs; did you mean 'sensor_msgs'? Else put its files into interfaces/sensors_msgs/msg (srv, "
                "action) of your workspace, or the package into src/"
            ),
        ),
        ("from geometry_msgs.msg import Twits", ImportError, "geometry_msgs.msg.Twits (did you mean 'Twist'?)"),
        (
            "from geometry_msgs.msg import LaserScan",
            ImportError,
            "geometry_msgs.msg.LaserScan; it is in sensor_msgs.msg",
        ),
        ("import geometry_msgs.srv", ModuleNotFoundError, "geometry_msgs.srv"),
        ("import geometry_msgs.msg._twits", ModuleNotFoundError, "geometry_msgs.msg._twits (did you mean '_twist'?)"),
        (
            "import sensor_msgs.msg._camera",
            ModuleNotFoundError,
            "sensor_msgs.msg._camera (did you mean '_camera_info'?)",
        ),
        (
            "from std_srvs.srv._trigger import Triger",
            ImportError,
            "std_srvs.srv._trigger.Triger (did you mean 'Trigger'?)",
        ),
        (
            "import sensor_msgs_py.pointcloud",
            ModuleNotFoundError,
            "sensor_msgs_py.pointcloud (did you mean 'point_cloud2'?)",
        ),
        ("from tf2_ros import Bufer", ImportError, "tf2_ros.Bufer (did you mean 'Buffer'?)"),
        ("from message_filters import Cach", ImportError, "message_filters.Cach (did you mean 'Cache'?)"),
        (
            "from std_srvs.srv import TriggerResponse",
            ImportError,
            "std_srvs.srv.TriggerResponse; that is ROS 1: Trigger.Response is what ROS 2 has",
        ),
        (
            "import sensor_msgs.point_cloud2",
            ModuleNotFoundError,
            "sensor_msgs.point_cloud2; that is ROS 1: sensor_msgs_py.point_cloud2 is what ROS 2 has",
        ),
    ],
)
def test_a_name_that_is_missing(code: str, kind: type[Exception], report: str) -> None:
    error = raised(code)
    assert isinstance(error, (kind, RobolinkError))
    assert isinstance(error, kind)
    assert str(error) == f"{VERSION} has no {report}"


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("image_transport", "CompressedImage"),
        ("tf2_kdl", "tf2_geometry_msgs"),
        ("rospy", "ROS 1"),
        ("move_base_msgs", "NavigateToPose"),
        ("ros2topic", "get_topic_names_and_types"),
        ("rosidl_adapter", "robolink.interfaces.find"),
        ("ament_flake8", "ruff"),
        ("moveit_msgs", "interfaces/moveit_msgs/msg"),
        ("my_robot_interfaces", "interfaces/my_robot_interfaces/msg"),
    ],
)
def test_what_ros_has_and_robolink_has_not(name: str, hint: str) -> None:
    for code in (f"import {name}", f"from {name}.anything import X"):
        error = raised(code)
        assert isinstance(error, ModuleNotFoundError)
        assert str(error).startswith(f"{VERSION} has no {name}; ")
        assert hint in str(error)
        assert "\n" not in str(error)
        assert error.name == name


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize("name", ["tf2_kdl", "my_robot_interfaces"])
def test_a_mere_folder_does_not_hide_those_words(name: str, tmp_path: Path) -> None:
    """A package's `launch/` has no `__init__.py`; what is in it can be imported, and nothing else from there."""
    (tmp_path / name / "sub").mkdir(parents=True)
    (tmp_path / name / "mine.py").write_text("HERE = True")
    sys.path.insert(0, str(tmp_path))
    importlib.invalidate_caches()
    for code in (f"from {name} import LaunchDescription", f"import {name}\n{name}.LaunchDescription"):
        error = raised(code)
        assert str(error).startswith(f"{VERSION} has no {name}.LaunchDescription; ")
        assert isinstance(error, ImportError if code.startswith("from") else AttributeError)
    error = raised(f"from {name}.actions import Node")
    assert isinstance(error, ModuleNotFoundError)
    assert str(error).startswith(f"{VERSION} has no {name}.actions; ")
    scope: dict[str, Any] = {}
    exec(f"from {name} import mine\nfrom {name}.mine import HERE\nimport {name}.sub\nimport {name}", scope)
    assert (scope["mine"].HERE, scope["HERE"]) == (True, True)
    assert not hasattr(scope[name], "__wrapped__")
    for each in (name, f"{name}.mine", f"{name}.sub"):
        del sys.modules[each]


@pytest.mark.usefixtures("compat")
def test_others_names_are_left_alone(tmp_path: Path) -> None:
    assert str(raised("import numpyy")) == "No module named 'numpyy'"
    (tmp_path / "image_transport.py").write_text("HERE = True")
    sys.path.append(str(tmp_path))
    importlib.invalidate_caches()
    assert importlib.import_module("image_transport").HERE


@pytest.mark.usefixtures("compat")
def test_asking_whether_a_name_is_there_is_no_error() -> None:
    rclpy = importlib.import_module("rclpy")
    assert not hasattr(rclpy, "spinn")
    assert getattr(importlib.import_module("rclpy.node"), "Nod", None) is None
    assert not hasattr(importlib.import_module("geometry_msgs.msg"), "__wrapped__")


def test_without_the_import_there_is_nothing(before: None) -> None:
    if FINDER.real("rclpy") is not None:
        pytest.skip("a real rclpy is installed here")
    assert str(raised("import rclpy")) == "No module named 'rclpy'"
