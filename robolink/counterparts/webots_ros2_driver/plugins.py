"""Plugins of a driver: Python classes with `init(webots_node, properties)`, and `step()` at each step of the world."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink import compat
from robolink.counterparts.webots_ros2_driver.section import Plugin
from robolink.exceptions import RobolinkError, nearest
from robolink.system.terminal import shown
from robolink.webots_controller.robot import Robot
from robolink.workspace import find_package, reach_module, workspace_of

IMU = "webots_ros2_driver::Ros2IMU"
"""The plugin in C++ that has a counterpart here, among the relays."""
INSTEAD = {
    "webots_ros2_control::Ros2Control": "it needs ros2_control; the world takes cmd_vel, and publishes odom, tf and "
    "joint_states",
}


class PluginError(RobolinkError, ImportError):
    """A plugin that a robot description names is not there, or is none; the text begins with the place."""


class WebotsNode:
    """Argument of a plugin's `init`: `robot` is Webots' class Robot."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot


def why_left_out(plugin: Plugin) -> str:
    """Return why a plugin is left out; '' for one in Python, and for the one that is among the relays."""
    if "::" not in plugin.kind or plugin.kind == IMU:
        return ""
    return INSTEAD.get(plugin.kind, "it is C++, and robolink runs Python")


def load_plugin(plugin: Plugin) -> Callable[[], Any]:
    """Return the class of a plugin. Raises PluginError; and what its module raises while it is imported."""
    module, _, name = plugin.kind.rpartition(".")
    if not module:
        raise _error(plugin, f"expected PACKAGE.MODULE.CLASS, got '{shown(plugin.kind)}'")
    top = module.partition(".")[0]
    compat.activate(compat.ALWAYS)
    folder = find_package(top) or _beside(plugin, top)
    if folder is not None:
        reach_module(top, folder)
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not f"{module}.".startswith(f"{error.name}."):
            raise  # it is something that the module itself imports
        raise _error(plugin, f"there is no module '{shown(error.name)}'{_siblings(module, folder)}") from None
    if not callable(getattr(found, name, None)):
        known = [each for each, value in vars(found).items() if isinstance(value, type)]
        raise _error(plugin, f"'{module}' has no class '{shown(name)}'{nearest(name, known)}")
    made: Callable[[], Any] = getattr(found, name)
    return made


def _beside(plugin: Plugin, top: str) -> Path | None:
    """Return the folder of a package in the workspace of the robot description itself."""
    workspace = workspace_of(Path(plugin.element.file).resolve().parent)
    return None if workspace is None else find_package(top, workspace=workspace)


def _siblings(module: str, folder: Path | None) -> str:
    top, _, rest = module.partition(".")
    if folder is None:
        return f": no package '{shown(top)}' is in the workspace"
    return nearest(rest, [each.stem for each in (folder / top).glob("*.py")])


def _error(plugin: Plugin, text: str) -> PluginError:
    return PluginError(f"{plugin.element.file}:{plugin.element.line}: {text}")
