"""ROS 2's own names are robolink's modules, all of them or none; what is missing is said well."""

from __future__ import annotations

import functools
import importlib
import inspect
import os
import pickle
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import robolink
from robolink import interfaces
from robolink.exceptions import RobolinkError
from robolink.interfaces._standard import STANDARD
from robolink.workspace import VARIABLE as WORKSPACE
from robolink.workspace import use_interfaces
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.workspace.modules import FINDER
from tests.commands import ROBOLINK

MODE = "ROBOLINK_COMPAT"
COMPANIONS = [
    "rclpy",
    "tf2_ros",
    "tf2_py",
    "tf2_geometry_msgs",
    "tf2_sensor_msgs",
    "tf_transformations",
    "message_filters",
    "sensor_msgs_py",
    "rosidl_runtime_py",
    "ament_index_python",
    "cv_bridge",
]


def _is_ros(name: str) -> bool:
    """Whether a module is there through robolink.compat or these tests, or is a part of it."""
    top = name.partition(".")[0]
    packages = {package for types in STANDARD.values() for package in types}
    return name.startswith("robolink.compat") or top in {*packages, *COMPANIONS}


def _forget() -> None:
    for name in filter(_is_ros, list(sys.modules)):
        del sys.modules[name]
    vars(robolink).pop("compat", None)
    for module in [each for name, each in sys.modules.items() if name.startswith("robolink.")]:
        asked = vars(module).get("__getattr__")
        if isinstance(asked, functools.partial):  # with robolink's own at the end, if there is one
            vars(module).update(__getattr__=asked.args[-1])
            if asked.args[-1] is None:
                del vars(module)["__getattr__"]


@pytest.fixture
def before(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Imports as they are without robolink.compat; nothing of it is left in this process."""
    monkeypatch.delenv(MODE, raising=False)
    monkeypatch.setattr(sys, "meta_path", [each for each in sys.meta_path if each is not FINDER])
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(FINDER, "makers", [])
    monkeypatch.setattr(FINDER, "hides", lambda _: False)
    monkeypatch.setattr(interfaces, "_sources", ())
    _forget()
    yield
    _forget()


@pytest.fixture
def compat(before: None) -> Any:
    return importlib.import_module("robolink.compat")


def raised(code: str) -> Exception:
    with pytest.raises((ImportError, AttributeError)) as caught:
        exec(code, {})
    return caught.value


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
@pytest.mark.parametrize("kind", list(STANDARD))
def test_every_message_package_is_there(kind: str) -> None:
    for package, types in STANDARD[kind].items():
        module = importlib.import_module(f"{package}.{kind}")
        assert module is importlib.import_module(f"robolink.interfaces.{package}.{kind}")
        scope: dict[str, Any] = {}
        exec(f"from {package}.{kind} import *", scope)
        assert {each for each in scope if not each.startswith("__")} == set(types.split())


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize("kind", list(STANDARD))
def test_the_modules_in_which_rosidl_defines_a_type_are_there(kind: str) -> None:
    from robolink.compat.names import snake_case

    for package, types in STANDARD[kind].items():
        for short in types.split():
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
    ("name", "attribute", "room"),
    [
        ("tf2_ros", "Buffer", "tf2"),
        ("tf2_ros.buffer", "Buffer", "tf2.buffer"),
        ("tf2_ros.transform_listener", "TransformListener", "tf2.transform_listener"),
        ("tf2_py", "BufferCore", "tf2"),
        ("tf2_geometry_msgs", "do_transform_pose", "tf2.geometry"),
        ("tf2_geometry_msgs.tf2_geometry_msgs", "do_transform_pose", "tf2.geometry"),
        ("tf2_sensor_msgs", "do_transform_cloud", "tf2.point_cloud"),
        ("tf_transformations", "quaternion_from_euler", "transformations"),
        ("message_filters", "ApproximateTimeSynchronizer", "message_filters"),
        ("sensor_msgs_py.numpy_compat", "structured_to_unstructured", "numpy_compat"),
        ("sensor_msgs_py.numpy_compat", "unstructured_to_structured", "numpy_compat"),
        ("sensor_msgs_py.point_cloud2", "read_points", "point_cloud2"),
        ("rosidl_runtime_py", "set_message_fields", "rosidl_runtime"),
        ("rosidl_runtime_py.utilities", "get_message", "rosidl_runtime.utilities"),
        ("ament_index_python", "get_package_share_directory", "ament_index"),
        ("ament_index_python.packages", "PackageNotFoundError", "ament_index.packages"),
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


VERSION = "robolink " + robolink.__version__


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
        ("cv_bridge", "numpy"),
        ("tf2_kdl", "tf2_geometry_msgs"),
        ("launch", "robolink launch"),
        ("launch_ros", "robolink launch"),
        ("rospy", "ROS 1"),
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
@pytest.mark.parametrize("name", ["launch", "launch_ros", "my_robot_interfaces"])
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
    (tmp_path / "cv_bridge.py").write_text("HERE = True")
    sys.path.append(str(tmp_path))
    importlib.invalidate_caches()
    assert importlib.import_module("cv_bridge").HERE


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


# All or none.


@pytest.fixture
def ros(before: None, tmp_path: Path) -> Path:
    """A real ROS 2, as far as names go: on the path, with a companion and a package of messages."""
    site = tmp_path / "opt/ros/jazzy/lib/python3/site-packages"
    for name in ("rclpy", "geometry_msgs", "tf_transformations"):
        (site / name).mkdir(parents=True)
        (site / name / "__init__.py").write_text("REAL = True\n")
    (site / "geometry_msgs/msg.py").write_text("REAL = True\n")
    sys.path.insert(0, str(site))
    importlib.invalidate_caches()
    return site


@pytest.mark.usefixtures("ros")
def test_a_real_rclpy_is_left_alone_as_a_whole() -> None:
    compat = importlib.import_module("robolink.compat")
    assert not compat.is_active()
    assert importlib.import_module("rclpy").REAL
    assert importlib.import_module("geometry_msgs.msg").REAL
    assert str(raised("import rclpy.node")) == "No module named 'rclpy.node'"
    assert str(raised("import std_msgs.msg")) == "No module named 'std_msgs'"


@pytest.mark.usefixtures("before")
@pytest.mark.parametrize("inner", ["rclpy/rclpy/__init__.py", "rclpy/__init__.py", "rclpy.py"])
def test_a_checkout_of_rclpy_beside_the_script_is_none_that_is_installed(inner: str, tmp_path: Path) -> None:
    """Its repository has a folder rclpy/ with the package in it, and needs to be built."""
    (tmp_path / inner).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / inner).write_text("raise ImportError('it is not built')")
    sys.path.insert(0, str(tmp_path))
    importlib.invalidate_caches()
    compat = importlib.import_module("robolink.compat")
    assert compat.is_active()
    assert importlib.import_module("rclpy") is robolink
    assert importlib.import_module("rclpy.node").Node is robolink.Node


@pytest.mark.usefixtures("before")
def test_a_real_rclpy_that_is_built_elsewhere_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy/__init__.py").write_text("REAL = True\n")
    (tmp_path / "rclpy/_rclpy_pybind11.cpython-312-x86_64-linux-gnu.so").touch()
    sys.path.insert(0, str(tmp_path))
    importlib.invalidate_caches()
    assert not importlib.import_module("robolink.compat").is_active()
    assert importlib.import_module("rclpy").REAL


@pytest.mark.usefixtures("ros")
@pytest.mark.parametrize("by", ["variable", "argument"])
def test_robolinks_are_taken_all_the_same_when_asked_for(by: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if by == "variable":
        monkeypatch.setenv(MODE, "always")
    compat = importlib.import_module("robolink.compat")
    assert compat.activate(compat.ALWAYS if by == "argument" else compat.AUTO)
    assert importlib.import_module("rclpy") is robolink
    assert not hasattr(importlib.import_module("geometry_msgs.msg"), "REAL")
    assert not hasattr(importlib.import_module("tf_transformations"), "REAL")


@pytest.mark.usefixtures("before")
def test_none_are_taken_when_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODE, "never")
    compat = importlib.import_module("robolink.compat")
    assert not compat.activate(compat.ALWAYS)
    assert "std_msgs" in str(raised("import std_msgs"))
    monkeypatch.setenv(MODE, "perhaps")
    with pytest.raises(compat.CompatError, match="expected auto, always, never, got 'perhaps'"):
        compat.activate()


@pytest.mark.usefixtures("ros")
def test_a_real_rclpy_in_use_cannot_be_replaced() -> None:
    importlib.import_module("rclpy")
    compat = importlib.import_module("robolink.compat")
    assert not compat.activate()
    with pytest.raises(compat.CompatError, match=r"rclpy has been imported from .*rclpy.__init__\.py before"):
        compat.activate(compat.ALWAYS)


def test_messages_of_ros_1_do_not_come_between(before: None, tmp_path: Path) -> None:
    site = tmp_path / "noetic/dist-packages/geometry_msgs"
    (site / "msg").mkdir(parents=True)
    for folder in (site, site / "msg"):
        (folder / "__init__.py").write_text("ROS = 1")
    sys.path.insert(0, str(site.parent))
    importlib.import_module("robolink.compat")
    assert not hasattr(importlib.import_module("geometry_msgs.msg"), "ROS")


@pytest.mark.usefixtures("compat")
def test_a_file_of_the_users_own_goes_first_but_for_rclpy(tmp_path: Path) -> None:
    for name in ("tf_transformations", "rclpy"):
        (tmp_path / f"{name}.py").write_text("MINE = True")
    sys.path.insert(0, str(tmp_path))
    importlib.invalidate_caches()
    assert importlib.import_module("tf_transformations").MINE
    assert importlib.import_module("rclpy") is robolink


def test_a_workspace_adds_to_a_package(compat: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("nodes", "interfaces/geometry_msgs/msg"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "interfaces/geometry_msgs/msg/Circle.msg").write_text("float64 radius")
    monkeypatch.setenv(WORKSPACE, str(tmp_path))
    monkeypatch.setattr(WORKSPACE_TYPES, "_added", [])
    use_interfaces()
    module = importlib.import_module("geometry_msgs.msg")
    assert module.Circle().radius == 0.0
    assert module.Twist is interfaces.find("Twist")
    assert importlib.import_module("rclpy") is robolink


@given(
    st.lists(
        st.sampled_from(["rclpy", "tf2_ros", "sensor_msgs_py", "std_msgs", "msg", "_x", "node", "é", ""]), max_size=4
    )
)
def test_any_name_has_a_module_or_none(parts: list[str]) -> None:
    from robolink.compat.maker import room_of

    room = room_of(".".join(parts))
    assert room == "" or room.startswith("robolink")


# In processes of their own.


def begun(*args: str, cwd: Path, **environ: str) -> subprocess.Popen[str]:
    """Start Python in memory, without the variable."""
    settings = {key: value for key, value in os.environ.items() if key != MODE} | {"ROBOLINK_TRANSPORT": "memory://"}
    pipe = subprocess.PIPE
    return subprocess.Popen(
        [sys.executable, *args], cwd=cwd, env={**settings, **environ}, stdout=pipe, stderr=pipe, text=True
    )


def python(*args: str, cwd: Path, **environ: str) -> tuple[int, str, str]:
    """Run Python to its end: exit code, output, errors."""
    with begun(*args, cwd=cwd, **environ) as process:
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err


@pytest.mark.processes
def test_one_import_is_all_that_a_program_needs(tmp_path: Path) -> None:
    code = "import robolink.compat, rclpy; print(rclpy.executors.SingleThreadedExecutor, rclpy.__name__)"
    said = "<class 'robolink.executors.SingleThreadedExecutor'> robolink\n"
    assert python("-c", code, cwd=tmp_path) == (0, said, "")


@pytest.mark.processes
def test_tests_of_the_users_own(tmp_path: Path) -> None:
    for how in ("conftest", "plugin"):
        (tmp_path / how).mkdir()
        (tmp_path / how / "conftest.py").write_text("import robolink.compat\n" if how == "conftest" else "")
        (tmp_path / how / "test_mine.py").write_text(
            "import rclpy\nfrom test_msgs.msg import Empty\nfrom std_msgs.msg import String\n\n"
            "def test_it():\n    with rclpy.init():\n"
            "        rclpy.create_node('n').create_publisher(String, 't', 1)\n"
        )
    (tmp_path / "plugin/pytest.ini").write_text("[pytest]\naddopts = -p robolink.compat\n")
    pytest_on = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "--import-mode=importlib")
    alone = {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # what else is installed costs more than the test
    started = [begun(*pytest_on, ".", cwd=tmp_path / how, **alone) for how in ("conftest", "plugin")]
    for process in started:
        out, _ = process.communicate(timeout=60)
        assert process.returncode == 0, out


@pytest.mark.usefixtures("compat")
@pytest.mark.parametrize("module", ["_struct", "json", "rcssmin", "my_robot"])
def test_a_name_of_others_is_left_to_others(module: str) -> None:
    assert FINDER.find_spec(module) is None


@pytest.mark.processes
def test_run_hides_a_real_rclpy_and_shows_what_is_missing(tmp_path: Path) -> None:
    (tmp_path / "rclpy.py").write_text("raise SystemExit('the real one')")
    good, bad = tmp_path / "good.py", tmp_path / "bad.py"
    good.write_text("import rclpy\nprint(rclpy.__name__)\n")
    bad.write_text("import rclpy\n\nfrom rclpy.node import Nod\n")
    path = {"PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])}
    run = ROBOLINK[1:]
    assert python(*run, "run", str(good), cwd=tmp_path, **path) == (0, "robolink\n", "")
    assert python(*run, "run", str(good), cwd=tmp_path, **path, **{MODE: "never"}) == (1, "", "the real one\n")
    code, out, err = python(*run, "run", str(bad), cwd=tmp_path, **path)
    assert (code, out) == (1, "")
    first, place, line, *_, last = err.splitlines()
    assert (first, line.strip()) == ("Traceback (most recent call last):", "from rclpy.node import Nod")
    assert f'File "{bad}", line 3' in place
    assert last.endswith(f"{VERSION} has no rclpy.node.Nod (did you mean 'Node'?)")
    assert err.count('  File "') == 1
    bad.write_text("import cv_bridge\n")
    code, out, err = python(*run, "run", str(bad), cwd=tmp_path, **path)
    assert (code, out, err.count('  File "')) == (1, "", 1)
    assert f"{VERSION} has no cv_bridge; numpy reads an Image" in err
