"""The share directory of a package that was never built has both its own layout and the one that it installs."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from robolink.companions.ament_index import get_package_share_directory
from robolink.workspace import share
from robolink.workspace.setup_files import data_files
from robolink.workspace.share import share_directory
from tests.support.ros_tree import write_package

FILES = {
    "launch/robot.launch.py": "one",
    "config/robot.yaml": "two",
    "resource/urdf/robot.urdf": "three",
    "resource/meshes/wheel.stl": "four",
    "more/launch/other.launch.py": "five",
}
USUAL = """
from glob import glob
import os
from setuptools import setup
package_name = 'robot'
setup(name=package_name, data_files=[
    ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
    ('share/' + package_name, ['package.xml']),
    (os.path.join('share', package_name, 'launch'), glob(os.path.join('launch', '*launch.[pxy][yma]*'))),
    (f'share/{package_name}/config', glob('config/*.yaml')),
])
"""
ELSEWHERE = """
from glob import glob
from setuptools import setup
files = [('share/robot', ['package.xml'])]
files.append(('share/robot', glob('launch/*.py')))
files += [('share/robot/urdf', glob('resource/**/*.urdf', recursive=True))]
files.extend([('share/robot/launch', ['more/launch/other.launch.py', 'gone.py']), ('etc', ['package.xml']), unknown()])
setup(data_files=files)
"""
CMAKE = """
project(robot)
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
install(DIRECTORY resource/urdf DESTINATION share/${PROJECT_NAME}/)
install(DIRECTORY more/launch/ DESTINATION share/${PROJECT_NAME}/launch)
install(FILES launch/robot.launch.py DESTINATION share/${PROJECT_NAME} RENAME start.py)
install(FILES package.xml DESTINATION share/${PROJECT_NAME}/../../../../oops)
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package in a workspace, which is the working directory; folders of links are beside it."""
    monkeypatch.setenv(share.HOME, str(tmp_path / "links"))
    folder = write_package(tmp_path / "ws/src", "robot", {})
    for name, text in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    monkeypatch.chdir(folder)
    return folder


def test_the_usual_package_has_its_own_folder(package: Path) -> None:
    (package / "setup.py").write_text(USUAL)
    assert ("share/robot/config", ["config/robot.yaml"]) in data_files(package)
    assert share_directory(package) == package
    (package / "setup.py").unlink()
    (package / "CMakeLists.txt").write_text("project(robot)\ninstall(DIRECTORY launch config DESTINATION share/robot/)")
    assert get_package_share_directory("robot") == str(package)


def read(folder: Path) -> set[str]:
    """All that is found in a folder, by its path, through links."""
    return {
        (Path(at) / name).relative_to(folder).as_posix()
        for at, _, names in os.walk(folder, followlinks=True)
        for name in names
    }


@pytest.mark.parametrize("way", ["links", "copies"])
def test_files_that_setup_py_puts_elsewhere_are_there_too(
    package: Path, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if way == "copies":
        for name in ("pathlib.Path.symlink_to", "os.link"):
            monkeypatch.setattr(name, refuse)
    (package / "setup.py").write_text(ELSEWHERE)
    found = Path(get_package_share_directory("robot"))
    added = {"robot.launch.py", "urdf/robot.urdf", "launch/other.launch.py"}
    assert read(found) == read(package) | added
    assert (found / "robot.launch.py").read_text() == "one"
    assert (found / "launch/other.launch.py").read_text() == "five"
    assert (found / "package.xml").is_symlink() == (way == "links")
    assert found.name == "robot"


def refuse(*args: object) -> None:
    raise OSError("not allowed")


def test_files_that_cmake_puts_elsewhere_are_there_too(package: Path) -> None:
    (package / "setup.py").unlink()
    (package / "CMakeLists.txt").write_text(CMAKE)
    found = share_directory(package)
    assert read(found) == read(package) | {"urdf/robot.urdf", "launch/other.launch.py", "start.py"}
    assert share_directory(package) == found
    (package / "worlds").mkdir()
    (package / "worlds/room.yaml").touch()
    assert "worlds/room.yaml" in read(share_directory(package))
    (package / "resource/urdf/arm.urdf").touch()
    assert "urdf/arm.urdf" in read(share_directory(package))


def test_where_nothing_can_be_written_it_is_the_packages_folder(
    package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (package / "setup.py").write_text(ELSEWHERE)
    (tmp_path / "file").touch()
    monkeypatch.setenv(share.HOME, str(tmp_path / "file"))
    warned: list[str] = []
    monkeypatch.setattr("robolink.impl.rcutils_logger.RcutilsLogger.warning", lambda self, text: warned.append(text))
    assert share_directory(package) == package
    assert [each.partition(":")[0] for each in warned] == ["files that robot installs elsewhere are not there"]


def test_links_that_lead_in_a_circle_end(package: Path) -> None:
    (package / "more/launch/loop").symlink_to(package / "more/launch")
    (package / "launch/loop").symlink_to(package / "launch")
    (package / "CMakeLists.txt").write_text(CMAKE)
    assert "start.py" in {each.name for each in share_directory(package).iterdir()}
