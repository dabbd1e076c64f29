"""Fixtures for tests of workspaces: a ROS 2 source tree, and a workspace with types of its own."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import interfaces
from robolink.workspace import VARIABLE
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.workspace.modules import FINDER
from tests.support.ros_tree import write_package
from tests.support.zoo import PACKAGES, Write

NODE = "from pkg_a.helpers import WORD\nfrom .helpers import WORD as SAME\ndef main(): return WORD + SAME\n"


@pytest.fixture
def top(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A ROS 2 workspace as the working directory: two packages of Python, one of types, and what is none."""
    src = tmp_path / "ros2_ws/src"
    write_package(
        src,
        "pkg_a",
        {"helpers.py": "WORD = 'a'\n", "first.py": NODE, "second.py": "def main(): return 2\n"},
        "first = pkg_a.first:main",
    )
    write_package(src / "repo/deeper", "pkg_b", {"run.py": "from pkg_a.helpers import WORD\ndef main(): return WORD\n"})
    types = src / "pkg_interfaces"
    (types / "msg").mkdir(parents=True)
    (types / "package.xml").write_text("<package><name> pkg_interfaces </name></package>")
    (types / "msg/Count.msg").write_text("int64 n\n")
    (src / "off").mkdir()
    (src / "off/COLCON_IGNORE").touch()
    write_package(src / "off", "pkg_off", {})
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(src.parent)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    monkeypatch.setattr(FINDER, "makers", list(FINDER.makers))
    monkeypatch.setattr(interfaces, "_sources", ())
    monkeypatch.setattr(WORKSPACE_TYPES, "_added", [])
    importlib.invalidate_caches()
    yield src.parent.resolve()
    for name in [each for each in sys.modules if each.startswith("pkg_")]:
        del sys.modules[name]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A workspace of the user's as the working directory; nothing of it is left in this process."""
    for folder in ("nodes", "configs"):
        (tmp_path / folder).mkdir()
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(sys, "meta_path", [each for each in sys.meta_path if each is not FINDER])
    monkeypatch.setattr(FINDER, "makers", [])
    for name in [each for each in sys.modules if each.partition(".")[0] in PACKAGES]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(interfaces, "_sources", ())
    monkeypatch.setattr(WORKSPACE_TYPES, "_added", [])
    before = dict(sys.modules)
    yield tmp_path.resolve()
    for name in set(sys.modules) - set(before):
        if name.partition(".")[0] in PACKAGES or str(tmp_path) in name:
            del sys.modules[name]


@pytest.fixture
def write(home: Path) -> Write:
    def write(name: str, text: str) -> Path:
        path = home / "interfaces" / name if not name.startswith("nodes/") else home / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def zoo(write: Write) -> None:
    """A message, one that has it, a service and an action."""
    write("zoo_msgs/msg/Animal.msg", "# One of the zoo.\nuint8 BIRD=1\nstring name 'Ada'\ngeometry_msgs/Point place\n")
    write("zoo_msgs/msg/Cage.msg", "Animal[] animals\nbool open\n")
    write("zoo_msgs/srv/Feed.srv", "Animal animal\n---\nbool fed\n")
    write("zoo_msgs/action/Catch.action", "Cage cage\n---\nAnimal[] caught\n---\nfloat32 distance\n")
