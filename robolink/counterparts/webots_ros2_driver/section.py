"""The tag `<webots>` of a robot description: the topics of a robot's devices, and the plugins of its driver."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from robolink import compat
from robolink.counterparts.xacro import expanded
from robolink.documents import xmltext
from robolink.documents.foreign import unknown_key, warn
from robolink.documents.xmltext import Element
from robolink.exceptions import DocumentError, RobolinkError, nearest
from robolink.system.terminal import shown
from robolink.webots_controller.robot import Robot
from robolink.workspace import find_package, reach_module, workspace_of

TAGS = ("device", "plugin")

SETTINGS = ("topicName", "frameName", "updateRate", "alwaysOn", "enabled", "imageSuffix", "cameraInfoSuffix")

NO_EFFECT = ("pointCloudSuffix",)
"""Tags of <webots>, and of a device's <ros>, with those of no effect here; Webots' driver ignores others silently."""

IMU = "webots_ros2_driver::Ros2IMU"
"""The plugin in C++ that has a counterpart here, among the relays."""

INSTEAD = {
    "webots_ros2_control::Ros2Control": "it needs ros2_control; the world takes cmd_vel, and publishes odom, tf and "
    "joint_states",
}


class Device(NamedTuple):
    """Device with settings of its own, each a text by its tag."""

    name: str
    kind: str
    """Webots' name of its kind, such as DistanceSensor; '' if it is not said."""
    settings: dict[str, str]
    element: Element


class Plugin(NamedTuple):
    """Plugin of the driver: a Python class, or one in C++, whose name has ``::``."""

    kind: str
    """Its full name, `my_package.my_robot_driver.MyRobotDriver`."""
    settings: dict[str, str]
    element: Element


class Section(NamedTuple):
    """All that the tag says."""

    devices: list[Device]
    plugins: list[Plugin]


def read_section(description: str, mappings: Iterable[str] = ()) -> Section:
    """Return the section of a robot description; an empty one if it has none.

    Args:
        description: Path of a file with the suffix .urdf or .xacro, or the URDF itself; '' for none.
        mappings: Arguments of xacro, `name:=value`.

    Raises:
        DocumentError: for a mistake, with file and line.
        XacroMissingError: for a .xacro file where the package xacro is not installed.
    """
    if not description:
        return Section([], [])
    root = _root(description, mappings)
    if root.tag != "robot":
        raise root.mistake(f"expected <robot>, got <{shown(root.tag)}>: this is not URDF")
    webots = next(root.all("webots"), None)
    if webots is None:
        return Section([], [])
    for each in webots.children:
        if each.tag not in TAGS:
            warn(each.mistake(f"<webots>: {unknown_key(each.tag, TAGS)}"))
    return Section([_device(each) for each in webots.all("device")], [_plugin(each) for each in webots.all("plugin")])


def _root(description: str, mappings: Iterable[str]) -> Element:
    if description.endswith(".urdf"):
        return xmltext.read(Path(description))
    if description.endswith(".xacro"):
        return xmltext.parse(expanded([description, *mappings]).encode(), description)
    if "<" not in description:
        raise DocumentError(
            f"expected the path of a .urdf or .xacro file, got '{shown(description)[:80]}'", "robot_description"
        )
    return xmltext.parse(description.lstrip().encode(errors="replace"), "robot_description")


def _device(element: Element) -> Device:
    name = element.attributes.get("reference", "")
    if not name:
        raise element.mistake('a <device> needs its name in the world: <device reference="ds0" type="DistanceSensor">')
    settings = {each.tag: each.text for ros in element.all("ros") for each in ros.children}
    for each in (each for ros in element.all("ros") for each in ros.children if each.tag not in SETTINGS):
        reason = f"'{each.tag}' has no effect here" if each.tag in NO_EFFECT else unknown_key(each.tag, SETTINGS)
        warn(each.mistake(f"device '{shown(name)}': {reason}"))
    return Device(name, element.attributes.get("type", ""), settings, element)


def _plugin(element: Element) -> Plugin:
    kind = element.attributes.get("type", "")
    if not kind:
        raise element.mistake('a <plugin> needs its class: <plugin type="my_package.my_robot_driver.MyRobotDriver"/>')
    return Plugin(kind, {each.tag: each.text for each in element.children}, element)


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
