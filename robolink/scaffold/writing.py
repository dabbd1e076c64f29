"""Writer of new projects, nodes and worlds: no file that is there already is changed."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from robolink.scaffold.naming import ScaffoldError, checked, checked_module, class_name
from robolink.scaffold.rendering import rendered
from robolink.scaffold.requirement import WHEELS, requirement
from robolink.system.files import expanded, write_new
from robolink.workspace import built_in_workspace, user_workspace
from robolink.workspace.source import Folder

MODELINE = "# yaml-language-server: $schema="
"""First words of a YAML file that tell editors its schema, a file beside it."""
PARTS = ("nodes", "configs")
"""Folders of which a workspace of robolink's own kind has one at least."""


class Made(NamedTuple):
    """Record of what was made: its name, the folder that it is in, and the files, relative to that folder."""

    name: str
    folder: Path
    files: list[str]


def new_project(path: str) -> Made:
    """Make a workspace that runs and tests at once: a node, a world, a launch file, a test, a CI file.

    Args:
        path: The folder, which must not be there yet, or be empty; its last part is the project's name.

    Raises:
        ScaffoldError: (a ValueError) if the name is not valid, or the folder holds something.
        OSError: if the files cannot be written.
    """
    folder = expanded(path).absolute()
    name = checked("project", folder.name if path else "")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ScaffoldError(f"{path} is there already and not empty: take another name, or an empty folder")
    needs = requirement()
    words = {
        "NAME": name,
        "REQUIREMENT": f"# {needs.note}\n{needs.line}" if needs.note else needs.line,
        "STEP": f"{needs.step}\n" if needs.step else "",
        "NOTE": f"{needs.note}\n\n" if needs.note else "",
    }
    files: dict[str, str | bytes] = {**_with_schemas(rendered("project", words), folder)}
    if needs.wheel is not None:
        files[f"{WHEELS}/{needs.wheel.name}"] = needs.wheel.read_bytes()
    return written(folder, name, files)


def new_node(name: str, *, workspace: Folder = None) -> Made:
    """Make a node and its test, in the workspace; without one, the node alone in the working directory.

    Args:
        name: Name of the node, with or without `.py`.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        ScaffoldError: (a ValueError) if the name is not valid, or a file of this name is there.
        OSError: if the files cannot be written.
    """
    taken = [each.stem for each in (built_in_workspace() / "nodes").glob("*.py")]
    name = checked_module("node", name.removesuffix(".py"), taken).replace("-", "_")
    files = rendered("node", {"NAME": name, "CLASS": class_name(name)})
    folder = _workspace(workspace)
    if folder is None:
        return written(Path.cwd(), name, {f"{name}.py": files[f"nodes/{name}.py"]})
    return written(folder, name, files)


def new_world(name: str, *, workspace: Folder = None) -> Made:
    """Make a world to simulate, in the workspace; without one, in the working directory.

    Args:
        name: Name of the world, with or without `.yaml`.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        ScaffoldError: (a ValueError) if the name is not valid, or a file of this name is there.
        OSError: if the file cannot be written.
    """
    taken = [each.stem for each in (built_in_workspace() / "configs/worlds").glob("*.yaml")]
    name = checked("world", name.removesuffix(".yaml"), taken)
    files = rendered("world", {"NAME": name})
    folder = _workspace(workspace)
    if folder is None:
        _, _, text = files[f"configs/worlds/{name}.yaml"].partition("\n")  # there is no schema beside it
        return written(Path.cwd(), name, {f"{name}.yaml": text})
    return written(folder, name, _with_schemas(files, folder))


def _with_schemas(files: Mapping[str, str], folder: Path) -> dict[str, str]:
    """Return the files, and the schemas that they name and that are not in the folder yet."""
    made = dict(files)
    for path, text in files.items():
        line = text.partition("\n")[0]
        if line.startswith(MODELINE):
            schema = f"{Path(path).parent.as_posix()}/{line.removeprefix(MODELINE)}"
            if not (folder / schema).exists():
                made[schema] = (built_in_workspace() / schema).read_text(encoding="utf-8")
    return made


def _workspace(asked: Folder) -> Path | None:
    """Return the user's workspace if it has folders of robolink's own: packages of ROS 2 have other places."""
    found = user_workspace(asked)
    if found is None or (asked is None and not any((found / each).is_dir() for each in PARTS)):
        return None
    return found


def written(folder: Path, name: str, files: Mapping[str, str | bytes]) -> Made:
    """Write `files`, contents by relative path, into a `folder`, and return the record of the thing called `name`.

    All of them are written, or none.

    Raises:
        ScaffoldError: (a ValueError) if one of them is there already.
        OSError: if one cannot be written.
    """
    there = [each for each in files if os.path.lexists(folder / each)]
    if there:
        raise ScaffoldError(f"{folder / there[0]} is there already, and stays as it is: take another name")
    with contextlib.ExitStack() as undo:
        for path, content in files.items():
            _make_folder((folder / path).parent, undo)
            write_new(folder / path, content.encode() if isinstance(content, str) else content)
            undo.callback((folder / path).unlink)
        undo.pop_all()
    return Made(name, folder, list(files))


def _make_folder(folder: Path, undo: contextlib.ExitStack) -> None:
    """Make a folder and those above it that are not there, and note how to remove them."""
    for each in (*reversed(folder.parents), folder):
        if not each.exists():
            each.mkdir()
            undo.callback(each.rmdir)
