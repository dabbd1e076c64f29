"""robolink.compat: all of ROS 2's names or none, what is missing is said well, and processes of their own."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import robolink
from robolink import interfaces
from robolink.workspace import VARIABLE as WORKSPACE
from robolink.workspace import use_interfaces
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.workspace.modules import FINDER
from tests.support.commands import ROBOLINK
from tests.support.ros_names import MODE, VERSION, raised

WEBOTS = pytest.param("webots_ros2_driver", marks=pytest.mark.annex("webots"))


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
@pytest.mark.parametrize("name", ["launch", "launch_ros", "tf2_py", "rosidl_runtime_py", WEBOTS])
def test_a_checkout_of_what_runs_from_no_folder_is_none_that_is_installed(name: str, tmp_path: Path) -> None:
    (tmp_path / name).mkdir()
    (tmp_path / name / "__init__.py").write_text("raise ImportError('it is not built')")
    sys.path.insert(0, str(tmp_path))
    importlib.invalidate_caches()
    importlib.import_module("robolink.compat")
    assert importlib.import_module(name).__name__.startswith("robolink.")


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
            "import rclpy\nfrom std_msgs.msg import Empty\nfrom std_msgs.msg import String\n\n"
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
    bad.write_text("import image_transport\n")
    code, out, err = python(*run, "run", str(bad), cwd=tmp_path, **path)
    assert (code, out, err.count('  File "')) == (1, "", 1)
    assert f"{VERSION} has no image_transport; publish and subscribe to sensor_msgs.msg.Image" in err


@pytest.mark.usefixtures("compat")
def test_a_module_of_several_names_says_what_it_lacks_under_the_package_s() -> None:
    maker = importlib.import_module("robolink.compat.maker")
    for name in ("launch_ros.actions.ros_timer", "launch_ros.actions"):
        maker.room_fill(name)(ModuleType(name))
    lacked = raised("from launch_ros.actions import Nod")
    assert str(lacked) == f"{VERSION} has no launch_ros.actions.Nod (did you mean 'Node'?)"
