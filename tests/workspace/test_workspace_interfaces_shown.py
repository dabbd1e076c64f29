"""A workspace's types beside installed ones of the same name, and on the command line."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from robolink.workspace import VARIABLE, use_interfaces
from robolink.workspace.modules import ModuleFinder
from tests.support.commands import ROBOLINK
from tests.support.zoo import Write, imported


@pytest.mark.usefixtures("zoo")
def test_an_installed_package_is_not_hidden(tmp_path: Path) -> None:
    installed = tmp_path / "site"
    (installed / "zoo_msgs/msg").mkdir(parents=True)
    (installed / "zoo_msgs/__init__.py").write_text("REAL = True")
    (installed / "zoo_msgs/msg/__init__.py").write_text("REAL = True")
    sys.path.insert(0, str(installed))
    use_interfaces()
    assert imported("zoo_msgs").REAL
    assert imported("zoo_msgs.msg").REAL
    assert imported("zoo_msgs.srv").Feed  # it has no such module


@pytest.mark.usefixtures("zoo")
def test_a_mere_folder_of_the_same_name_does_not_hide_the_types(tmp_path: Path) -> None:
    (tmp_path / "interfaces/zoo_msgs/helpers.py").write_text("HELP = True")
    sys.path.insert(0, str(tmp_path / "interfaces"))  # as `python -m robolink` has the working directory
    use_interfaces()
    assert imported("zoo_msgs.msg").Animal
    assert imported("zoo_msgs.helpers").HELP


def test_a_finder_takes_any_makers(home: Path) -> None:
    finder = ModuleFinder()

    def fill(module: ModuleType) -> None:
        module.WHO = module.__name__  # type: ignore[attr-defined]

    def instead(module: ModuleType) -> None:
        sys.modules[module.__name__] = importlib.import_module("robolink.qos")

    makers = {"plain": fill, "plain.nodes": fill, "plain.qos": instead, "json": fill}
    finder.makers = [lambda name: makers.get(name)]
    sys.meta_path.insert(0, finder)
    assert imported("plain.nodes").WHO == "plain.nodes"
    assert imported("plain.qos") is importlib.import_module("robolink.qos")
    assert importlib.import_module("robolink.qos").__name__ == "robolink.qos"
    assert finder.find_spec("json", None) is None


def robolink(*args: str, cwd: Path, workspace: str = "") -> subprocess.CompletedProcess[str]:
    environ = {**os.environ, "ROBOLINK_TRANSPORT": "memory://alone", **({VARIABLE: workspace} if workspace else {})}
    return subprocess.run([*ROBOLINK, *args], cwd=cwd, env=environ, capture_output=True, text=True, timeout=30)


@pytest.mark.processes
def test_run_imports_them_and_a_wrong_file_is_one_line(home: Path, write: Write) -> None:
    write("zoo_msgs/msg/Animal.msg", "string name")
    wrong = write("zoo_msgs/msg/Wrong.msg", "string name\nfloat speed")
    write("nodes/right.py", "from zoo_msgs.msg import Animal\nprint(Animal(name='Ada'))\n")
    left = write("nodes/left.py", "from zoo_msgs.msg import Wrong\n")
    assert robolink("run", "right", cwd=home).stdout == "zoo_msgs.msg.Animal(name='Ada')\n"
    refused = robolink("run", "left", cwd=home)
    assert (refused.returncode, refused.stderr) == (
        1,
        f"robolink: {wrong}:2:1: 'float' is not a type (did you mean 'float32'?) (at {left}:1)\n",
    )


@pytest.mark.processes
def test_every_command_knows_them(home: Path, write: Write, tmp_path_factory: pytest.TempPathFactory) -> None:
    write("zoo_msgs/msg/Animal.msg", "string name")
    for cwd, workspace in ((home / "nodes", ""), (tmp_path_factory.mktemp("elsewhere"), str(home))):
        done = robolink("pub", "--once", "-w", "0", "/zoo", "Animal", "{name: Ada}", cwd=cwd, workspace=workspace)
        assert "zoo_msgs.msg.Animal(name='Ada')" in done.stdout, done.stderr
