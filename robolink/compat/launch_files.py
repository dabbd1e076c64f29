"""Names of ROS 2 that mean one thing in a launch file and another in a program here.

`webots_ros2_driver.webots_controller.WebotsController` is a launch action in ROS 2. Here it has been a node class for
programs, and both must work in one process: that of a test, or of `robolink simulate`. So the module differs while
the code of launch files runs.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from robolink.compat.maker import hidden, room_of
from robolink.extensions.optional import is_here

ROOMS = {"webots_ros2_driver.webots_controller": "robolink.launch.ros.webots_ros2_driver"}
"""Modules for launch files, by ROS 2's name."""


@contextmanager
def names_of_launch_files() -> Iterator[None]:
    """Let ROS 2's names be those that launch files mean while the block runs."""
    taken = [name for name in ROOMS if hidden(name.partition(".")[0]) and is_here(ROOMS[name])]
    before = {name: sys.modules.get(name) for name in taken}
    parents = {name: importlib.import_module(room_of(name.rpartition(".")[0])) for name in taken}
    attributes = {name: vars(parents[name]).get(name.rpartition(".")[2]) for name in taken}
    for name in taken:
        _put(name, parents[name], importlib.import_module(ROOMS[name]))
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
