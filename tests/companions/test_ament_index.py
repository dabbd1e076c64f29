"""Packages and their folders by name: of the workspace, robolink's own, and what ROS 2 has installed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from robolink.companions.ament_index import (
    InvalidResourceNameError,
    InvalidResourceTypeNameError,
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
    get_resource,
    get_resource_types,
    get_resources,
    get_search_paths,
    has_resource,
)
from robolink.workspace import VARIABLE, built_in_workspace
from tests.support.ros_tree import write_package


@pytest.fixture
def top(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    folder = write_package(tmp_path / "ros2_ws/src", "meu_robo_py", {})
    (folder / "config").mkdir()
    (folder / "config/robot.yaml").touch()
    monkeypatch.chdir(tmp_path / "ros2_ws")
    return (tmp_path / "ros2_ws").resolve()


@pytest.fixture
def installed(top: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """What colcon has built: two prefixes, the first before the second."""
    for prefix, packages in (("one", ["turtle", "both"]), ("two", ["both", "bare"])):
        index = tmp_path / prefix / "share/ament_index/resource_index"
        for package in packages:
            for kind in ("packages", "rviz"):
                (index / kind).mkdir(parents=True, exist_ok=True)
                (index / kind / package).write_text(f"{prefix} {package}")
            if package != "bare":
                (tmp_path / prefix / "share" / package).mkdir(parents=True)
        (index / "packages/.hidden").touch()
        (index / "packages/folder").mkdir()
    found = os.pathsep.join(str(tmp_path / each) for each in ("one", "gone", "two"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", found)
    return tmp_path


def test_the_share_directory_of_a_source_package_is_its_folder(top: Path) -> None:
    share = get_package_share_directory("meu_robo_py")
    assert share == str(top / "src/meu_robo_py") == get_package_prefix("meu_robo_py")
    assert Path(share, "config", "robot.yaml").is_file()
    assert get_package_share_path("meu-robo-py") / "config" == top / "src/meu_robo_py/config"


def test_the_workspace_robolink_and_packages_of_types_have_folders_too(top: Path) -> None:
    assert get_package_share_directory("ros2_ws") == str(top)
    assert get_package_share_path("robolink") == built_in_workspace()
    assert get_package_share_path("geometry_msgs").is_dir()
    assert {"meu_robo_py", "ros2_ws", "robolink", "std_msgs"} <= set(get_packages_with_prefixes())


@pytest.mark.usefixtures("top")
def test_a_package_that_is_not_there() -> None:
    with pytest.raises(PackageNotFoundError) as caught:
        get_package_share_directory("meu_robo")
    assert str(caught.value).startswith("no package named 'meu_robo' in ")
    assert str(caught.value).endswith("(did you mean 'meu_robo_py'?)")
    assert isinstance(caught.value, KeyError)
    for name in ("_package", "package a", "package/a", "../x", "", "/etc"):
        with pytest.raises(ValueError, match="is not a valid package name"):
            get_package_prefix(name)


def test_what_is_installed_comes_after_the_workspace(installed: Path, top: Path) -> None:
    one, two = str(installed / "one"), str(installed / "two")
    assert get_search_paths() == [one, two]
    assert get_package_prefix("turtle") == one
    assert get_package_prefix("both") == one
    assert get_package_share_directory("both") == str(installed / "one/share/both")
    assert get_package_prefix("meu_robo_py") == str(top / "src/meu_robo_py")
    with pytest.warns(UserWarning, match=r"the share directory of bare, .*, does not exist"):
        get_package_share_directory("bare")
    assert get_package_share_path("bare", print_warning=False) == installed / "two/share/bare"
    known = get_packages_with_prefixes()
    assert (known["bare"], known["both"], known["ros2_ws"]) == (two, one, str(top))
    assert not {".hidden", "folder"} & set(known)


def test_resources(installed: Path, top: Path) -> None:
    one, two = str(installed / "one"), str(installed / "two")
    assert get_resource("rviz", "both") == ("one both", one)
    assert get_resources("rviz") == {"turtle": one, "both": one, "bare": two}
    assert get_resource_types() == {"packages", "rviz", "rosidl_interfaces"}
    assert has_resource("packages", "meu_robo_py") == str(top / "src/meu_robo_py")
    assert has_resource("packages", "nothing") is False
    assert "msg/Twist.msg" in get_resource("rosidl_interfaces", "geometry_msgs")[0].splitlines()
    assert "std_srvs" in get_resources("rosidl_interfaces")
    assert get_resources("nothing") == {}
    with pytest.raises(LookupError, match=r"no resource of type 'rviz' named 'bot' .did you mean 'both'"):
        get_resource("rviz", "bot")


@pytest.mark.parametrize("name", ["/invalid/name", "invalid\\name"])
def test_names_that_would_leave_the_index(name: str) -> None:
    for ask in (get_resource, has_resource):
        with pytest.raises(InvalidResourceTypeNameError):
            ask(name, "x")
        with pytest.raises(InvalidResourceNameError):
            ask("packages", name)
    with pytest.raises(InvalidResourceTypeNameError):
        get_resources(name)


def test_without_ros_there_is_no_path(top: Path) -> None:
    assert get_search_paths() == []
    assert get_resources("packages")["ros2_ws"] == str(top)
