"""Words of URDF: warnings about tags and attributes that ROS's parser ignores silently, as it does misspelt ones."""

from __future__ import annotations

from collections.abc import Iterator

from robolink.documents.foreign import unknown_key, warn
from robolink.documents.xmltext import Element

TAGS = {
    "robot": "link joint material transmission gazebo sensor ros2_control webots group link_state joint_state",
    "link": "visual collision inertial sensor gazebo contact self_collision_checking verbose capsule",
    "joint": "origin parent child axis calibration dynamics limit mimic safety_controller gazebo hardwareInterface",
}
"""Tags within others, with those of extensions that are in wide use; their own content is not looked at."""

ATTRIBUTES = {
    "robot": "name version",
    "link": "name type",
    "joint": "name type",
    "origin": "xyz rpy quat_xyzw",
    "parent": "link",
    "child": "link",
    "axis": "xyz",
    "limit": "lower upper effort velocity acceleration deceleration jerk",
    "mimic": "joint multiplier offset",
    "safety_controller": "soft_lower_limit soft_upper_limit k_position k_velocity",
    "dynamics": "damping friction",
    "calibration": "rising falling reference_position",
}

MOST = 20
"""Most warnings about one file."""


def tell_ignored(robot: Element) -> None:
    """Emit a `FileWarning` for each word in a robot, its links and its joints that URDF does not have."""
    told: set[str] = set()
    for about, text in _ignored(robot):
        if text not in told and len(told) < MOST:
            told.add(text)
            warn(about.mistake(text))


def _ignored(element: Element) -> Iterator[tuple[Element, str]]:
    attributes, tags = ATTRIBUTES.get(element.tag, "").split(), TAGS.get(element.tag, "").split()
    for name in element.attributes:
        if attributes and name not in attributes and "}" not in name:
            yield element, f"<{element.tag}>: {unknown_key(name, attributes)}"
    for child in element.children:
        if "}" in child.tag or ":" in child.tag or not tags:  # of another namespace, as those of extensions are
            continue
        if child.tag not in tags:
            yield child, f"<{element.tag}>: {unknown_key(child.tag, tags)}"
        elif child.tag in ATTRIBUTES:
            yield from _ignored(child)
