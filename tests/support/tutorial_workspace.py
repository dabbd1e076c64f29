"""A workspace of somebody who follows ROS 2's tutorials: packages of `ros2 pkg create`, with texts typed into them."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

import pytest

from robolink.cli.main import main

PACKAGES = Path(__file__).parents[1] / "tutorials" / "packages"
"""The texts that are typed, by package."""
_SCRIPTS = "'console_scripts': ["
_FIRST = "from setuptools import find_packages, setup\n"
_DATA = "('share/' + package_name, ['package.xml']),\n"


class TutorialWorkspace:
    """Workspace in the working directory, with a terminal in it."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.folder = folder
        self._capsys = capsys

    def ros2(self, line: str, code: int = 0) -> str:
        """Type a command; return what it prints."""
        self._capsys.readouterr()
        assert main(shlex.split(line)[1:]) == code
        return self._capsys.readouterr().out

    def create(self, name: str, *scripts: str, data: str = "", options: str = "") -> Path:
        """Create a package in src, type its texts, and return its folder.

        Args:
            name: Name of the package.
            scripts: Entry points to add to its setup.py, which make it a package of ament_python.
            data: Folders whose files its setup.py installs into the share directory, in words.
            options: More options of `ros2 pkg create`.
        """
        kind = "ament_python" if scripts or data else "ament_cmake"
        self.ros2(
            f"ros2 pkg create --build-type {kind} --license Apache-2.0 --destination-directory src {name} {options}"
        )
        package = self.folder / "src" / name
        if (PACKAGES / name).is_dir():
            shutil.copytree(PACKAGES / name, package, dirs_exist_ok=True)
        if kind == "ament_python":
            _fill_in(package / "setup.py", scripts, data.split())
        return package

    def type(self, name: str) -> Path:
        """Type a single program, and return its file."""
        return Path(shutil.copy(PACKAGES / name, self.folder))


def edit(file: Path, *changes: tuple[str, str]) -> None:
    """Replace each first text of a file by its second one, wherever it stands."""
    text = file.read_text()
    for old, new in changes:
        assert old in text, f"{file} has no {old!r}"
        text = text.replace(old, new)
    file.write_text(text)


def _fill_in(setup: Path, scripts: tuple[str, ...], folders: list[str]) -> None:
    """Do what the tutorials say about setup.py: entry points, and files to install."""
    entries = "".join(f"\n            '{each}'," for each in scripts)
    files = "".join(
        f"        (os.path.join('share', package_name, '{each}'), glob(os.path.join('{each}', '*'))),\n"
        for each in folders
    )
    edit(
        setup,
        (_SCRIPTS, _SCRIPTS + entries),
        (_DATA, _DATA + files),
        (_FIRST, f"import os\nfrom glob import glob\n{_FIRST}"),
    )
