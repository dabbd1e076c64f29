"""Find a launch file by what is typed: its name or path, or a package and the name of a file of it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.workspace import Folder, find_launch, find_package, list_packages

LAUNCH_FOLDER = "launch"
"""Where a ROS 2 package has its launch files."""

YAML = (".yaml", ".yml")
_PROGRAMS = {".py": "a Python program", ".xml": "XML"}


class LaunchKindError(RobolinkError, ValueError):
    """A launch file that ROS 2 reads and robolink does not."""


def find(names: Sequence[str], *, workspace: Folder = None) -> Path:
    """Find a launch file by its name or path, or by a package and the file's name in it.

    Raises `NotFoundError` with the nearest name, and `LaunchKindError` for one that is no YAML.
    """
    _check_kind(names[-1])
    if len(names) == 1:
        return find_launch(names[0], workspace=workspace)
    package, name = names
    folder = find_package(package, workspace=workspace)
    if folder is None:
        known = list_packages(workspace=workspace)
        raise NotFoundError("package", package, known, "the workspace (an argument is given as NAME:=VALUE)")
    return _in_package(folder, package, name)


def _check_kind(name: str) -> None:
    kind = _PROGRAMS.get(Path(name).suffix)
    if kind is not None:
        raise LaunchKindError(
            f"{name} is {kind}, and robolink launches YAML: list its nodes in a .yaml file, as in `nodes: [node: NAME]`"
        )


def _in_package(folder: Path, package: str, name: str) -> Path:
    """Find a file in a package: `robot`, `robot.yaml` and `robot.launch.yaml` are the same."""
    there = [each for each in sorted((folder / LAUNCH_FOLDER).glob("*")) if each.suffix in YAML]
    for each in there:
        if name in (each.name, each.stem, each.stem.removesuffix(".launch")):
            return each
    for suffix in (".py", ".xml"):
        for end in ("", suffix, f".launch{suffix}"):
            if (file := folder / LAUNCH_FOLDER / f"{name}{end}").is_file():
                _check_kind(file.name)
    raise NotFoundError("launch file", name, [each.name for each in there], f"package {package}")
