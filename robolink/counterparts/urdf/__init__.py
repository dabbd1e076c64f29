"""Robot models in URDF: links and joints as data, their parser, and the transform of a joint at a position."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple, TypeVar

from robolink.documents import xmltext
from robolink.documents.foreign import unknown_key, warn, warnings_to
from robolink.documents.xmltext import Element
from robolink.exceptions import DocumentError, nearest
from robolink.geometry.transformations import quaternion_from_euler
from robolink.system.files import read_plain
from robolink.system.terminal import shown
from robolink.tf2.rigid import Rigid, compose

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
    reported: set[str] = set()
    for about, text in _ignored(robot):
        if text not in reported and len(reported) < MOST:
            reported.add(text)
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


MOVING = ("revolute", "continuous", "prismatic")
"""Kinds of joints that one number moves."""
KINDS = (*MOVING, "fixed", "floating", "planar")
"""Kinds of joints."""

Vector = tuple[float, float, float]


class Mimic(NamedTuple):
    """Rule of a joint that follows another: `multiplier` times that one's position, plus `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


class Joint(NamedTuple):
    """A joint: `child` stands in `parent` at `origin`, and moves about or along the unit vector `axis`.

    `lower` and `upper` are limits in rad or m, `soft` those of a safety controller; None where the model has none.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Rigid
    axis: Vector = (1.0, 0.0, 0.0)
    lower: float | None = None
    upper: float | None = None
    soft: tuple[float | None, float | None] = (None, None)
    mimic: Mimic | None = None

    @property
    def moves(self) -> bool:
        """True if one number says where the child is."""
        return self.kind in MOVING


class Robot(NamedTuple):
    """A robot: a tree of links below `root`; `joints` by name, in the order of the text."""

    name: str
    root: str
    links: tuple[str, ...]
    joints: dict[str, Joint]
    notes: tuple[str, ...] = ()
    """Lines about oddities that ROS takes all the same, each with file and line."""


def placed(joint: Joint, position: float = 0.0) -> Rigid:
    """Return the transform of a joint's child in its parent.

    Args:
        joint: The joint.
        position: Position in rad, in m for a prismatic joint; a joint that does not move ignores it.
    """
    x, y, z = joint.axis
    if joint.kind == "prismatic":
        return compose(joint.origin, (position * x, position * y, position * z, 0.0, 0.0, 0.0, 1.0))
    if joint.moves:
        sine = math.sin(position / 2)
        return compose(joint.origin, (0.0, 0.0, 0.0, x * sine, y * sine, z * sine, math.cos(position / 2)))
    return joint.origin


T = TypeVar("T")

XACRO = re.compile(r"\{http://(www\.)?ros\.org/(wiki/xacro|xacro)")
"""Beginning of a tag of xacro, which is left in a text that has not gone through xacro."""
DECLARATION = re.compile(r"<\?xml\s[^>]*\?>")
"""XML's declaration. It speaks of the encoding of a file, so that a text needs none; and XML allows nothing before it,
where files have empty lines and comments."""
PROLOG = 4000
"""Number of characters in which it is looked for."""
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


def read_urdf(path: Path, *, anywhere: bool = False) -> Robot:
    """Read a URDF file; see `parse_urdf`. Raises DocumentError, with file and line, for whatever is wrong in it."""
    try:
        content = read_plain(path, xmltext.LARGEST)
    except (OSError, ValueError) as error:
        raise DocumentError(getattr(error, "strerror", None) or str(error), str(path)) from None
    late = DECLARATION.search(content[:PROLOG].decode("latin-1"))
    if late is not None and late.start() > 0:
        content = _blank(late[0]).encode().join((content[: late.start()], content[late.end() :]))
    return robot_of(xmltext.parse(content, str(path)), anywhere=anywhere)


def read_text(path: Path, *, anywhere: bool = False) -> str:
    """Return the text of a URDF file without a mistake; see `parse_urdf`. Raises DocumentError, with file and line."""
    with warnings_to(lambda _: None):  # they are told when the text is used
        read_urdf(path, anywhere=anywhere)
    return path.read_text(encoding="utf-8", errors="replace")


def parse_urdf(text: str, name: str = "robot_description", *, anywhere: bool = False) -> Robot:
    """Return the robot model of a URDF text.

    Args:
        text: The text.
        name: Name of the text's source in errors.
        anywhere: True takes the first <robot> wherever it is, as joint_state_publisher does; False wants it as the root
            of the text, as urdfdom does.

    Raises:
        DocumentError: for whatever is wrong in it; the text begins with `name` and the line.
    """
    declared = DECLARATION.search(text[:PROLOG])
    if declared is not None:
        text = text[: declared.start()] + _blank(declared[0]) + text[declared.end() :]
    try:
        content = text.encode()
    except UnicodeEncodeError:
        raise DocumentError("it has characters that are none (surrogates)", name) from None
    return robot_of(xmltext.parse(content, name), anywhere=anywhere)


def robot_of(root: Element, *, anywhere: bool = False) -> Robot:
    """Return the robot model of an XML element; see `parse_urdf`. Raises DocumentError."""
    if anywhere:
        root = _first_robot(root) or root
    if root.tag != "robot":
        raise root.mistake(f"expected <robot>, got <{shown(root.tag)}>: this is not URDF")
    try:
        robot = _robot(root)
    except DocumentError as error:
        if any(XACRO.match(each.tag) for each in root.children):  # which are ignored otherwise, as other unknown tags
            hint = "it has tags of xacro: run it through xacro first (robolink run xacro xacro FILE)"
            raise DocumentError(f"{error.message}; {hint}", error.file, error.line) from None
        raise
    tell_ignored(root)
    return robot


def _first_robot(element: Element) -> Element | None:
    if element.tag == "robot":
        return element
    return next(filter(None, map(_first_robot, element.children)), None)


def _robot(root: Element) -> Robot:
    links = _once(root, "link")
    if not links:
        raise root.mistake("a robot needs a <link>")
    joints = {name: _joint(each, links) for name, each in _once(root, "joint").items()}
    places = {each.attributes["name"]: each for each in root.all("joint")}
    notes = tuple(str(each) for each in _odd_mimics(joints, places))
    return Robot(root.attributes.get("name", ""), _root(root, links, joints, places), tuple(links), joints, notes)


def _blank(declaration: str) -> str:
    return "\n" * declaration.count("\n")


def _once(root: Element, tag: str) -> dict[str, Element]:
    """Return the elements of a tag by their names, which are there and differ."""
    found: dict[str, Element] = {}
    for each in root.all(tag):
        # A link may have an empty name: Webots' launch files give such a robot to a publisher that has none to tell of.
        name = "" if tag == "link" and each.attributes.get("name") == "" else _needed(each, "name")
        if name in found:
            raise each.mistake(f"a second {tag} '{shown(name)}'; the first is in line {found[name].line}")
        found[name] = each
    return found


def _needed(element: Element, attribute: str) -> str:
    value = element.attributes.get(attribute, "")
    if not value:
        raise element.mistake(f'<{element.tag}> needs {attribute}="..."')
    return value


def _joint(element: Element, links: dict[str, Element]) -> Joint:
    name, kind = element.attributes["name"], _needed(element, "type")
    if kind not in KINDS:
        raise element.mistake(f"joint '{shown(name)}': unknown type '{shown(kind)}'{nearest(kind, KINDS)}")
    parent, child = (_link(element, end, links) for end in ("parent", "child"))
    limit, safety = _first(element, "limit"), _first(element, "safety_controller")
    if limit is None and kind in ("revolute", "prismatic"):
        raise element.mistake(f'joint \'{shown(name)}\' is {kind} and needs <limit lower="..." upper="..."/>')
    return Joint(
        name,
        kind,
        parent,
        child,
        origin=_origin(_first(element, "origin")),
        axis=_axis(_first(element, "axis"), kind),
        lower=None if limit is None else _number(limit, "lower", 0.0),
        upper=None if limit is None else _number(limit, "upper", 0.0),
        soft=(_soft(safety, "soft_lower_limit"), _soft(safety, "soft_upper_limit")),
        mimic=_mimic(_first(element, "mimic")),
    )


def _link(element: Element, end: str, links: dict[str, Element]) -> str:
    name = element.attributes["name"]
    found = _first(element, end)
    if found is None:
        raise element.mistake(f"joint '{shown(name)}' needs <{end} link=\"...\"/>")
    link = _needed(found, "link")
    if link not in links:
        raise found.mistake(f"joint '{shown(name)}': no link named '{shown(link)}'{nearest(link[:100], links)}")
    return link


def _origin(element: Element | None) -> Rigid:
    if element is None:
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    x, y, z = _vector(element, "xyz", (0.0, 0.0, 0.0))
    qx, qy, qz, qw = quaternion_from_euler(*_vector(element, "rpy", (0.0, 0.0, 0.0)))
    return (x, y, z, float(qx), float(qy), float(qz), float(qw))


def _axis(element: Element | None, kind: str) -> Vector:
    x, y, z = (1.0, 0.0, 0.0) if element is None else _vector(element, "xyz", (1.0, 0.0, 0.0))
    length = math.hypot(x, y, z)
    if length > 0.0:
        return (x / length, y / length, z / length)
    if element is not None and kind not in ("fixed", "floating"):
        raise element.mistake("an axis of length 0 has no direction")
    return (1.0, 0.0, 0.0)


def _mimic(element: Element | None) -> Mimic | None:
    if element is None:
        return None
    return Mimic(_needed(element, "joint"), _number(element, "multiplier", 1.0), _number(element, "offset", 0.0))


def _soft(element: Element | None, attribute: str) -> float | None:
    return None if element is None or attribute not in element.attributes else _number(element, attribute, 0.0)


def _first(element: Element, tag: str) -> Element | None:
    return next(element.all(tag), None)


def _vector(element: Element, attribute: str, default: Vector) -> Vector:
    if attribute not in element.attributes:
        return default
    words = element.attributes[attribute].split()
    if len(words) != 3:
        raise element.mistake(f"{attribute}: expected three numbers, got '{shown(element.attributes[attribute], 60)}'")
    x, y, z = (_as_number(element, attribute, each) for each in words)
    return (x, y, z)


def _number(element: Element, attribute: str, default: float) -> float:
    text = element.attributes.get(attribute)
    return default if text is None else _as_number(element, attribute, text.strip())


def _as_number(element: Element, attribute: str, text: str) -> float:
    value = float(text) if NUMBER.fullmatch(text[:400]) else math.nan
    if not math.isfinite(value):
        raise element.mistake(f"{attribute}: expected a number, got '{shown(text, 60)}'")
    return value


def _odd_mimics(joints: dict[str, Joint], places: dict[str, Element]) -> Iterator[DocumentError]:
    """Yield the faults of joints that follow ones which are not there, or each other in a circle.

    ROS's parser takes them: such a joint moves only where its own position is given.
    """
    followed = {each.name: each.mimic.joint for each in joints.values() if each.mimic is not None}
    for name, other in followed.items():
        if other not in joints:
            yield places[name].mistake(
                f"joint '{shown(name)}' mimics '{shown(other)}', which is not there{nearest(other[:100], joints)}"
            )
    if circle := _circle(followed):
        yield places[circle[0]].mistake(f"joints mimic each other in a circle: {_arrows(circle)}")


def _root(root: Element, links: dict[str, Element], joints: dict[str, Joint], places: dict[str, Element]) -> str:
    """Return the link that no joint moves. Raises DocumentError unless the links form a tree."""
    above: dict[str, Joint] = {}
    for each in joints.values():
        if each.child in above:
            both = f"'{shown(above[each.child].name)}' and '{shown(each.name)}'"
            raise places[each.name].mistake(f"link '{shown(each.child)}' is the child of two joints, {both}")
        above[each.child] = each
    parents = {child: joint.parent for child, joint in above.items()}
    if circle := _circle(parents):
        raise places[above[circle[0]].name].mistake(f"links are below each other in a circle: {_arrows(circle)}")
    first, *others = (each for each in links if each not in above)
    if others:
        reason = f"two roots, '{shown(first)}' and '{shown(others[0])}': a joint has to connect them"
        raise links[others[0]].mistake(reason)
    return first


def _circle(above: dict[str, str]) -> list[str]:
    """Return names that lead to themselves, [] if none does. Looks at each name once."""
    done: set[str] = set()
    for start in above:
        way: dict[str, None] = {}
        name: str | None = start
        while name is not None and name not in done and name not in way:
            way[name] = None
            name = above.get(name)
        if name is not None and name in way:
            names = list(way)
            return names[names.index(name) :]
        done.update(way)
    return []


def _arrows(names: Iterable[str]) -> str:
    listed = [shown(each) for each in names]
    few = listed if len(listed) <= 6 else [*listed[:5], "..."]
    return " -> ".join([*few, listed[0]])
