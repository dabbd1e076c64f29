"""ROS 2's names in the processes that `multiprocessing` starts afresh, by "spawn" and "forkserver".

Such a process has nothing of its parent but what is pickled for it, and imports the program's file anew before any code
of the program runs: `import rclpy` would find nothing. Spawn is the default of macOS and Windows, forkserver that of
Python 3.14 on Linux.
"""

from __future__ import annotations

import functools
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from robolink.compat.opencv import prepare_opencv
from robolink.workspace.modules import FINDER, Fill

_ENTRY = "robolink names"


def hand_on(mode: str) -> None:
    """Take ROS 2's names, in this mode, into all processes that are started from now on."""
    changes: dict[str, Fill] = {
        "multiprocessing.spawn": functools.partial(_change_spawn, mode),
        "multiprocessing.forkserver": _change_forkserver,
    }
    for name, change in changes.items():
        FINDER.change(name, change)
        if name in sys.modules:
            change(sys.modules[name])


class _Names:
    """Entry of what is pickled for a new process: it is unpickled before all that needs these names."""

    def __init__(self, mode: str) -> None:
        self._mode = mode

    def __reduce__(self) -> tuple[Any, ...]:
        loaded = [name for name in list(sys.modules) if name.endswith(".py") and Path(name).is_absolute()]
        return enter, (self._mode, "cv2" in FINDER.changes, loaded)


def enter(mode: str, with_opencv: bool, files: list[str]) -> None:
    """Take the names in a new process, and load the files that its parent has loaded by their paths.

    Args:
        mode: Mode of `robolink.compat.activate`.
        with_opencv: True prepares OpenCV, too.
        files: Paths, which are the names of their modules; of these is what is pickled.
    """
    from robolink import compat
    from robolink.workspace.load import load_module

    if compat.activate(mode) and with_opencv:
        prepare_opencv()
    for each in files:
        load_module(Path(each))


def _change_spawn(mode: str, spawn: ModuleType) -> None:
    real = spawn.get_preparation_data
    if hasattr(real, "__wrapped__"):
        return

    @functools.wraps(real)
    def get_preparation_data(name: str) -> dict[str, Any]:
        return {_ENTRY: _Names(mode), **real(name)}

    spawn.get_preparation_data = get_preparation_data  # type: ignore[attr-defined]


def _change_forkserver(forkserver: ModuleType) -> None:
    """Have the server from which processes are forked import this, and not the program's file, which it could not."""
    server = forkserver._forkserver
    if server._preload_modules == ["__main__"]:  # else the program wants it otherwise
        server.set_forkserver_preload([__name__])
