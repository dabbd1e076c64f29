"""ROS 2's names in the processes that `multiprocessing` starts afresh, by "spawn" and "forkserver".

Such a process has nothing of its parent but what is pickled for it, and imports the program's file anew before any code
of the program runs: `import rclpy` would find nothing. Spawn is the default of macOS and Windows, forkserver that of
Python 3.14 on Linux.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, TypeAlias

from robolink.workspace.modules import FINDER, Fill

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
