"""Files of a new project, node or world: their templates, the names that they take, and what they require."""

from __future__ import annotations

import contextlib
import json
import keyword
import os
import re
import sys
from collections.abc import Collection, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit
from urllib.request import url2pathname

from robolink.exceptions import RobolinkError
from robolink.system.files import expanded, write_new
from robolink.workspace import built_in_workspace, user_workspace
from robolink.workspace.source import Folder

TEMPLATES = Path(__file__).parent / "files"
"""Folder of the templates: one folder for each kind, with the files as they are to lie."""

_SUFFIX, _DOT = ".template", "dot_"


def rendered(kind: str, words: Mapping[str, str]) -> dict[str, str]:
    """Return the files of a kind by their relative path, in the order of their names.

    Args:
        kind: Folder of templates: ``project``, ``node`` or ``world``.
        words: What stands for each placeholder; ``@NAME@`` is filled by ``words["NAME"]``, in names of files too.
    """
    folder = TEMPLATES / kind
    found = sorted(each for each in folder.rglob(f"*{_SUFFIX}"))
    return {
        _filled(_path(each.relative_to(folder)), words): _filled(each.read_text(encoding="utf-8"), words)
        for each in found
    }


def _path(template: Path) -> str:
    parts = [f".{each[len(_DOT) :]}" if each.startswith(_DOT) else each for each in template.parts]
    return "/".join(parts).removesuffix(_SUFFIX)


def _filled(text: str, words: Mapping[str, str]) -> str:
    for name, value in words.items():
        text = text.replace(f"@{name}@", value)
    return text


LONGEST = 60
"""Most letters of a name."""

_PATTERN = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_DEVICE = re.compile(r"(con|prn|aux|nul|(com|lpt)[0-9])", re.IGNORECASE)
"""Names that no file can have on Windows, with any suffix."""
_IMPORTED = ("Node", "String", "ExternalShutdownException")
"""Classes that the program of a new node imports."""


class ScaffoldError(RobolinkError, ValueError):
    """Nothing can be made under this name, or there is something already; the text says what to do."""


def checked(kind: str, name: str, taken: Collection[str] = ()) -> str:
    """Return a name that is fit for files, launch files and Python; raise ScaffoldError for any other.

    Args:
        kind: Word for what gets the name: ``project``, ``node`` or ``world``.
        name: The name as somebody typed it.
        taken: Names of what comes with robolink, which a new thing would hide.
    """
    if not _PATTERN.fullmatch(name) or len(name) > LONGEST:
        raise ScaffoldError(
            f"'{name[:LONGEST]}' is not a name for a {kind}: a letter, then letters, digits, '_' or '-',"
            f" {LONGEST} at most; such as my_{kind}"
        )
    if any(keyword.iskeyword(each) or keyword.issoftkeyword(each) for each in (name.lower(), name.capitalize())):
        raise ScaffoldError(f"'{name}' is a word of Python: take another name, such as my_{name.lower()}")
    if _DEVICE.fullmatch(name):
        raise ScaffoldError(f"'{name}' is a device of Windows: take another name, such as my_{name.lower()}")
    if _as_file(name) in map(_as_file, taken):
        raise ScaffoldError(
            f"a {kind} '{name}' comes with robolink, and a new one would hide it: take another name, such as my_{name}"
        )
    return name


def checked_module(kind: str, name: str, taken: Collection[str] = ()) -> str:
    """Return a name that is fit for a file or folder that Python imports and that hides no other.

    Args:
        kind: Word for what gets the name: ``package`` or ``node``.
        name: The name as somebody typed it.
        taken: More names that a new thing would hide.

    Raises:
        ScaffoldError: (a ValueError) if it is not valid, or a module of Python or of robolink has it.
    """
    from robolink.compat.maker import TOPS  # late: few commands need it
    from robolink.workspace import program_names

    module = checked(kind, name, {"robolink", *TOPS, *program_names(), *taken}).replace("-", "_")
    if module.casefold() in map(str.casefold, sys.stdlib_module_names):
        raise ScaffoldError(f"'{name}' is a module of Python: take another name, such as my_{module}")
    return name


def _as_file(name: str) -> str:
    """Return a name as file systems compare it that know no capitals, with `-` as `_`."""
    return name.replace("-", "_").casefold()


def class_name(name: str) -> str:
    """Return the name of a class for a node: `wall_watcher` is WallWatcher.

    >>> class_name("wall_watcher"), class_name("Talker2"), class_name("node")
    ('WallWatcher', 'Talker2', 'NodeNode')
    """
    joined = "".join(part[:1].upper() + part[1:] for part in re.split("[_-]+", name))
    return f"{joined}Node" if joined in _IMPORTED else joined


WHEELS = "wheels"
"""Folder of a project that has robolink's wheel, where no index has it."""


class Requirement(NamedTuple):
    """Requirement on robolink that can be met on this machine, on others, and in CI."""

    line: str
    """Line of requirements.txt."""
    note: str = ""
    """Comment on it, and a sentence of the README."""
    step: str = ""
    """Command that has to be typed before; '' if there is none."""
    wheel: Path | None = None
    """Wheel that belongs into the project."""


def requirement() -> Requirement:
    """Return the requirement by which a project gets the robolink that made it."""
    found = metadata.distribution("robolink")
    return required(json.loads(found.read_text("direct_url.json") or "{}"), found.version)


def required(origin: dict[str, Any], version: str) -> Requirement:
    """Return the requirement by which a project gets a robolink.

    Args:
        origin: Content of its direct_url.json; empty if it came from a package index.
        version: Its version.
    """
    url = str(origin.get("url", ""))
    if not url:
        return Requirement("robolink[test]")
    if "vcs_info" in origin:
        vcs = origin["vcs_info"]
        return Requirement(f"robolink[test] @ {vcs['vcs']}+{url}@{vcs['commit_id']}")
    if urlsplit(url).scheme != "file":
        return Requirement(f"robolink[test] @ {url}")
    path = Path(url2pathname(urlsplit(url).path))
    if "dir_info" not in origin and path.suffix == ".whl":
        wheel, step = path.name, "" if path.is_file() else f"cp PATH/OF/{path.name} {WHEELS}/"
    else:
        wheel = f"robolink-{version}-py3-none-any.whl"
        step = f'pip wheel --no-deps --wheel-dir {WHEELS} "{path if path.exists() else "PATH/OF/THE/CLONE"}"'
    note = f"robolink is on no package index yet: its wheel, in {WHEELS}/, belongs into the repository, for CI too."
    return Requirement(f"./{WHEELS}/{wheel}[test]", note, step, path if not step else None)


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


def _workspace(requested: Folder) -> Path | None:
    """Return the user's workspace if it has folders of robolink's own: packages of ROS 2 have other places."""
    found = user_workspace(requested)
    if found is None or (requested is None and not any((found / each).is_dir() for each in PARTS)):
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
