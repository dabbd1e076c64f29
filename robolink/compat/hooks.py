"""Hooks of ROS 2's names: OpenCV, new processes, types of workspaces, and names that launch files mean otherwise."""

from __future__ import annotations

import functools
import importlib
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.compat.maker import LIBRARIES, TOPS, defined_in, fill_private, hidden, room_fill, room_of
from robolink.extensions.optional import is_here
from robolink.interfaces import KINDS
from robolink.interfaces.standard import INTERFACES
from robolink.workspace.modules import FINDER, Fill

if TYPE_CHECKING:
    from pathlib import Path

_OPENCV = "robolink.companions.opencv"
"""Module that prepares OpenCV, by name: it is imported when a program imports cv2, and not before."""


def prepare_opencv() -> None:
    """Prepare cv2 for programs: at its import, or now if it has been imported. A second call does nothing."""
    if "cv2" in FINDER.changes:
        return
    FINDER.change("cv2", _prepare)
    loaded = sys.modules.get("cv2")
    if loaded is not None and hasattr(loaded, "imshow"):
        _prepare(loaded)


def _prepare(cv2: ModuleType) -> None:
    importlib.import_module(_OPENCV).prepare(cv2)


Enter: TypeAlias = Callable[[str, bool, list[str]], None]
"""Function that takes the names in a mode, prepares OpenCV if it shall, and loads files by their paths."""

_ENTRY = "robolink names"


def hand_on(enter: Enter, mode: str) -> None:
    """Take ROS 2's names into all processes that are started from now on.

    Args:
        enter: Function that a new process calls before anything else, by its module's name.
        mode: Its first argument.
    """
    changes: dict[str, Fill] = {
        "multiprocessing.spawn": functools.partial(_change_spawn, enter, mode),
        "multiprocessing.forkserver": functools.partial(_change_forkserver, enter.__module__),
    }
    for name, change in changes.items():
        FINDER.change(name, change)
        if name in sys.modules:
            change(sys.modules[name])


class _Names:
    """Entry of what is pickled for a new process: it is unpickled before all that needs these names."""

    def __init__(self, enter: Enter, mode: str) -> None:
        self._enter, self._mode = enter, mode

    def __reduce__(self) -> tuple[Any, ...]:
        from pathlib import Path  # late, as in all that most programs do without: it takes their start 3 ms

        loaded = [name for name in list(sys.modules) if name.endswith(".py") and Path(name).is_absolute()]
        return self._enter, (self._mode, "cv2" in FINDER.changes, loaded)


def _change_spawn(enter: Enter, mode: str, spawn: ModuleType) -> None:
    real = spawn.get_preparation_data
    if hasattr(real, "__wrapped__"):
        return

    @functools.wraps(real)
    def get_preparation_data(name: str) -> dict[str, Any]:
        return {_ENTRY: _Names(enter, mode), **real(name)}

    spawn.get_preparation_data = get_preparation_data  # type: ignore[attr-defined]


def _change_forkserver(ours: str, forkserver: ModuleType) -> None:
    """Let the server from which processes are forked import ours instead of the program's file, which it could not."""
    server = forkserver._forkserver
    if server._preload_modules == ["__main__"]:  # else the program wants it otherwise
        server.set_forkserver_preload([ours])


_OWN = os.path.dirname(os.path.dirname(__file__)) + os.sep  # noqa: PTH120
_IMPORTERS = ("<frozen importlib", "<frozen zipimport", os.path.dirname(importlib.__file__) + os.sep)  # noqa: PTH120


def workspace_types(fullname: str) -> Fill | None:
    """Return the function that fills the module `fullname`, `my_msgs` or `my_msgs.msg`; None if nobody has it.

    Workspaces and entry points are read for a name that is installed nowhere, so that imports stay fast; and not for
    those that libraries look for in vain: `pickle` tries `org.python.core`, `platform` `java.lang`, and msgspec
    `typing_extensions`.
    """
    top, dot, inner = fullname.partition(".")
    kind, _, private = inner.partition(".")
    if top in TOPS or top in sys.stdlib_module_names or top in LIBRARIES or (dot and kind not in KINDS):
        return None
    real = None if dot else FINDER.real(top)
    if real is not None and real.loader is not None:  # a folder that is not a package has none
        return None
    fill = _private(fullname) if private else _of_workspace(fullname)
    if fill is None and top in INTERFACES.added():  # last: reading entry points takes ten milliseconds
        return room_fill(fullname)
    return fill


def _private(fullname: str) -> Fill | None:
    """Return the function that fills `my_msgs.msg._level`, where rosidl defines a type of a workspace."""
    parent, _, last = fullname.rpartition(".")
    types = defined_in(last, dir(sys.modules.get(parent)))
    return functools.partial(fill_private, fullname, types) if types else None


def _of_workspace(fullname: str) -> Fill | None:
    from robolink.workspace.find import workspace_of  # late: most imports are not those of a workspace's types
    from robolink.workspace.interfaces import WORKSPACE_TYPES, interface_module, use_interfaces

    file = _importing_file()
    home = None if file is None else workspace_of(file.parent)
    with WORKSPACE_TYPES.forgetting():
        if home is not None:
            WORKSPACE_TYPES.add(home)
        fill = interface_module(fullname)
    if fill is not None:
        use_interfaces(home)
    return fill


def _importing_file() -> Path | None:
    """Return the file whose code imports at this moment; None for code that is in no file."""
    from pathlib import Path

    frame: FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename.startswith((_OWN, *_IMPORTERS)):
        frame = frame.f_back
    if frame is None or not Path(frame.f_code.co_filename).is_file():
        return None
    return Path(frame.f_code.co_filename)


_IN_LAUNCH_FILES = {"webots_ros2_driver.webots_controller": "robolink.launch.ros.webots_ros2_driver"}
"""Modules for launch files, by ROS 2's name.

WebotsController is a launch action in ROS 2. Here it has been a node class for programs, and both must work in one
process: that of a test, or of `robolink simulate`. So the module differs while the code of launch files runs.
"""


@contextmanager
def names_of_launch_files() -> Iterator[None]:
    """Let ROS 2's names be those that launch files mean while the block runs."""
    taken = [name for name in _IN_LAUNCH_FILES if hidden(name.partition(".")[0]) and is_here(_IN_LAUNCH_FILES[name])]
    before = {name: sys.modules.get(name) for name in taken}
    parents = {name: importlib.import_module(room_of(name.rpartition(".")[0])) for name in taken}
    attributes = {name: vars(parents[name]).get(name.rpartition(".")[2]) for name in taken}
    for name in taken:
        _put(name, parents[name], importlib.import_module(_IN_LAUNCH_FILES[name]))
    try:
        yield
    finally:
        for name in taken:
            _put(name, parents[name], attributes[name])
            _set(sys.modules, name, before[name])


def _put(name: str, parent: ModuleType, module: ModuleType | None) -> None:
    """Let a module, or none, be found by its name and as an attribute of its package."""
    _set(sys.modules, name, module)
    _set(vars(parent), name.rpartition(".")[2], module)


def _set(values: dict[str, ModuleType], name: str, value: ModuleType | None) -> None:
    if value is None:
        values.pop(name, None)
    else:
        values[name] = value
