"""The tag `<webots>` of a robot description: the topics of a robot's devices, and the plugins of its driver."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from robolink.counterparts.xacro import expanded
from robolink.documents import xmltext
from robolink.documents.foreign import unknown_key, warn
from robolink.documents.xmltext import Element
from robolink.exceptions import DocumentError
from robolink.system.terminal import shown

TAGS = ("device", "plugin")
SETTINGS = ("topicName", "frameName", "updateRate", "alwaysOn", "enabled", "imageSuffix", "cameraInfoSuffix")
NO_EFFECT = ("pointCloudSuffix",)
"""Tags of <webots>, and of a device's <ros>, with those of no effect here; Webots' driver ignores others silently."""


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
