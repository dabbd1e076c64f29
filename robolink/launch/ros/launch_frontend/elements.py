"""Elements of a launch file in XML or YAML, read with their lines, and looked up as both spell them."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import yaml

from robolink.documents import yamltext
from robolink.documents.yamlfile import read_text, spell
from robolink.exceptions import DocumentError, nearest
from robolink.launch.ros.launch.bases import Condition, LaunchError, Place, Substitution
from robolink.launch.ros.launch.conditions import IfCondition, UnlessCondition
from robolink.launch.ros.launch.frontend import parse_substitution, unescaped
from robolink.launch.ros.launch.utilities import TextSubstitution
from robolink.system.files import read_plain
from robolink.system.terminal import shown

CONDITIONS = ("if", "unless")
"""Attributes of every action, and of nothing else."""
RENAMED = {
    "ns": "namespace",
    "required": 'on_exit="shutdown"',
    "node-name": "name",
    "launch_prefix": "launch-prefix",
}
"""Words of other versions for attributes, with what ROS 2 reads."""
_MISSING = object()


@dataclass
class Entity:
    """Element of a launch file.

    Args:
        tag: Tag as it is written.
        place: Place in the file.
        attributes: Values by name: texts in XML, what YAML reads in YAML.
        children: Elements inside.
        is_typed: True in YAML, whose values have a type.
    """

    tag: str
    place: Place
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list[Entity] = field(default_factory=list)
    is_typed: bool = False

    @property
    def name(self) -> str:
        """Name of the tag; `-` and `_` are the same in it."""
        return self.tag.replace("-", "_")

    def error(self, message: str) -> DocumentError:
        """Return an error (to raise) with this `message` at the place of the element."""
        return DocumentError(f"{self.tag}: {message}", self.place.file, self.place.line)

    def check(self, attributes: Collection[str], children: Collection[str] = ()) -> None:
        """Raise DocumentError, with the nearest name, unless there are only these `attributes` and `children`."""
        for name in self.attributes:
            if name not in attributes:
                raise self.error(self._unknown(name, attributes))
        for each in self.children:
            if each.name not in children:
                hint = nearest(each.name, children) or (": it holds none" if not children else "")
                raise each.error(f"'{self.tag}' holds no '{shown(each.tag)}'{hint}")

    def _unknown(self, name: str, attributes: Collection[str]) -> str:
        if name in CONDITIONS:
            return f"'{name}' stands in actions such as node, group and include, and not in {self.tag}"
        hint = nearest(name, attributes)
        other = RENAMED.get(name, "")
        advice = f": {other} is" if other.partition("=")[0] in attributes else hint
        return f"no attribute is called '{shown(name)}'{advice}"

    def condition(self) -> Condition | None:
        """Take the condition of an action, `if` or `unless`, from the attributes; None if it has none."""
        if_text, unless_text = (self.optional(each) for each in CONDITIONS)
        for each in CONDITIONS:
            self.attributes.pop(each, None)
        if if_text is not None and unless_text is not None:
            raise self.error("it has 'if' and 'unless': one of them is enough")
        if if_text is not None:
            return IfCondition(if_text)
        return None if unless_text is None else UnlessCondition(unless_text)

    def texts(self, name: str, *kinds: type) -> str | None:
        """Return the text of an attribute, `name`; None if it is not there.

        Raises DocumentError for a list, and in YAML for a value that is neither a text nor of one of these `kinds`.
        """
        value = self.attributes.get(name, _MISSING)
        if value is _MISSING:
            return None
        if isinstance(value, str):
            return value
        if type(value) in kinds:
            return str(value).lower() if isinstance(value, bool) else str(value)
        if isinstance(value, (list, dict)):
            raise self.error(f"'{name}' is one value, not a {'list' if isinstance(value, list) else 'mapping'}")
        if float in kinds and type(value) is int:
            raise self.error(f"'{name}' is a number with a point in ROS 2's YAML: write {name}: {value}.0")
        written = "" if value is None else spell(value)
        raise self.error(f"'{name}' is a text in ROS 2's YAML: write {name}: \"{shown(written, 60)}\"")

    def optional(self, name: str, *kinds: type) -> list[Substitution] | None:
        """Return the substitutions in an attribute, `name`; None if it is not there. Raises DocumentError.

        Args:
            name: Name of the attribute.
            *kinds: Types that it may have in YAML besides that of a text.
        """
        text = self.texts(name, *kinds)
        return None if text is None else self.parsed(text)

    def needed(self, name: str, *kinds: type) -> list[Substitution]:
        """Return the substitutions in `name`, of these `kinds`, as `optional` does. Raises DocumentError if none is."""
        found = self.optional(name, *kinds)
        if found is None:
            raise self.error(f"'{name}' is missing")
        return found

    def plain(self, name: str) -> str:
        """Return the text of an attribute, `name`, which has no substitutions. Raises DocumentError."""
        text = self.texts(name)
        if text is None:
            raise self.error(f"'{name}' is missing")
        return unescaped(text)

    def parsed(self, text: str) -> list[Substitution]:
        """Return a `text` of this element as substitutions. Raises DocumentError."""
        try:
            return parse_substitution(text)
        except LaunchError as error:
            raise self.error(str(error)) from None

    def words(self, name: str) -> list[list[Substitution]]:
        """Return the words of a command line in an attribute, `name`; none if it is not there. Raises DocumentError."""
        text = self.texts(name)
        try:
            return [] if text is None else words_of(self.parsed(text))
        except ValueError as error:
            reason = f"{error}: ROS 2 splits the text at each substitution, so that quotes around one do not close"
            raise self.error(f"'{name}': {reason}") from None

    def inside(self, tag: str) -> Iterator[Entity]:
        """Yield the children with this `tag`."""
        return (each for each in self.children if each.name == tag)


def words_of(parts: Iterable[Substitution]) -> list[list[Substitution]]:
    """Return the words of a command line: texts are split as a shell does, and a substitution is in one word.

    Args:
        parts: The command line, its texts and substitutions.

    Raises:
        ValueError: for a quote that is not closed within its text.
    """
    words: list[list[Substitution]] = [[]]
    for part in parts:
        if not isinstance(part, TextSubstitution):
            words[-1].append(part)
            continue
        pieces = shlex.split(part.text)
        if part.text[:1].isspace():
            words.append([])
        for number, piece in enumerate(pieces):
            words += [[]] if number else []
            words[-1].append(TextSubstitution(text=piece))
        if part.text[-1:].isspace():
            words.append([])
    return [each for each in words if each]


_TAGS = {"rosparam": "<rosparam> is <param from=...> in a node"}
_ATTRIBUTES = {
    ("node", "type"): "type= is exec=",
    ("node", "required"): 'required="true" is on_exit="shutdown"',
    ("node", "clear_params"): "clear_params= has no successor",
    ("include", "ns"): "<include ns=...> is <push_ros_namespace> in a <group>",
    ("include", "clear_params"): "clear_params= has no successor",
    ("include", "pass_all_args"): "pass_all_args= has no successor",
    ("group", "ns"): "<group ns=...> is <push_ros_namespace> in it",
}
_TEXTS = {
    "$(find ": "$(find x) is $(find-pkg-share x)",
    "$(arg ": "$(arg x) is $(var x)",
    "$(optenv ": "$(optenv x y) is $(env x y)",
}


def refuse_ros1(top: Entity) -> None:
    """Raise DocumentError, with the words that have changed, if the elements below `top` are a launch file of ROS 1."""
    mark = next((each for each in _all(top) if _is_ros1(each)), None)
    if mark is not None:
        words = "; ".join(dict.fromkeys(filter(None, _changed(top))))
        raise DocumentError(f"a launch file of ROS 1; in ROS 2 {words}", mark.place.file, mark.place.line)


def _is_ros1(entity: Entity) -> bool:
    """True if an element is one that only ROS 1 has."""
    is_node = entity.name == "node" and "type" in entity.attributes and "exec" not in entity.attributes
    return is_node or entity.name == "rosparam"


def _all(top: Entity) -> Iterator[Entity]:
    waiting = [top]
    while waiting:
        each = waiting.pop(0)
        yield each
        waiting[:0] = each.children


def _changed(top: Entity) -> Iterable[str]:
    """Yield ROS 2's spelling of each word of ROS 1 in a file."""
    for each in _all(top):
        yield _TAGS.get(each.name, "")
        yield from (_ATTRIBUTES.get((each.name, name), "") for name in each.attributes)
        for value in each.attributes.values():
            text = value if isinstance(value, str) else ""
            yield from (words for begin, words in _TEXTS.items() if begin in text)
    if any(each.name == "param" for each in top.children):
        yield "<param> stands in its <node>"


LONGEST, DEEPEST, MOST = 5_000_000, 64, 100_000
"""Largest file in bytes, deepest nesting, and most elements."""


def read_xml(path: Path) -> Entity:
    """Return the `launch` element of an XML file, `path`. Raises DocumentError with its line."""
    file = str(path)
    try:
        text = read_plain(path, LONGEST)
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror}", file) from None
    reader = _Reader(file)
    try:
        reader.parser.Parse(text, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise DocumentError(f"no XML: {reason}", file, error.lineno, error.offset + 1) from None
    top = reader.top
    if top is None or top.name != "launch":
        raise DocumentError("a launch file begins with <launch>", file, 1)
    refuse_ros1(top)
    if reader.stray is not None:
        raise reader.stray
    return top


class _Reader:
    """Handler of the parser's events."""

    def __init__(self, file: str) -> None:
        self._file, self._open, self._count = file, list[Entity](), 0
        self.top: Entity | None = None
        self.stray: DocumentError | None = None
        """Error about the first text between elements; ROS 1 has some there."""
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.EntityDeclHandler = self._refuse

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        entity = Entity(tag, Place(self._file, line), dict(attributes))
        self._count += 1
        if len(self._open) >= DEEPEST or self._count > MOST:
            raise DocumentError(f"nested over {DEEPEST} deep, or more than {MOST:,} elements", self._file, line)
        if self._open:
            self._open[-1].children.append(entity)
        else:
            self.top = entity
        self._open.append(entity)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _text(self, text: str) -> None:
        if text.strip() and self.stray is None:
            self.stray = self._open[-1].error(f"text stands in attributes, got '{text.strip()[:40]}'")

    def _refuse(self, name: str, *_: object) -> None:
        raise DocumentError(
            f"no entities are declared here, such as '{name[:40]}'", self._file, self.parser.CurrentLineNumber
        )


LISTED = ("arg", "let", "param", "remap", "env", "choice", "composable_node", "extra_arg", "keep", "children")
"""Keys whose list holds elements, not values."""
HOLDERS = ("launch", "group", "timer", "ros_timer")
"""Elements whose list holds actions."""


def read_yaml(path: Path) -> Entity:
    """Return the `launch` element of a YAML file, `path`. Raises DocumentError with line and column."""
    file = str(path)
    root = yamltext.compose(read_text(path), file)
    keys = [key.value for key, _ in root.value] if isinstance(root, yaml.MappingNode) else []
    if {"nodes", "include", "groups"} & set(keys):
        raise DocumentError(
            "it is one of robolink's own launch files, and those of ROS 2 include none of these", file, 1
        )
    if not isinstance(root, yaml.MappingNode) or keys != ["launch"]:
        raise DocumentError("a launch file of ROS 2 has one key, `launch`, with a list of actions", file, 1)
    return _element("launch", root.value[0][1], file)


def _element(tag: str, node: yaml.Node, file: str) -> Entity:
    """Return the element that stands under a key: a mapping of attributes, or a list of actions."""
    entity = Entity(tag, Place(file, node.start_mark.line + 1), is_typed=True)
    if isinstance(node, yaml.SequenceNode) and entity.name in HOLDERS:
        entity.children = _actions(node, file)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            _add(entity, str(key.value), value, file)
    elif isinstance(node, yaml.ScalarNode) and not node.value.strip():
        pass
    else:
        raise entity.error("a mapping of its attributes is expected")
    return entity


def _add(entity: Entity, key: str, node: yaml.Node, file: str) -> None:
    is_held = key != "children" or entity.name in HOLDERS
    if key.replace("-", "_") in LISTED and isinstance(node, yaml.SequenceNode) and is_held:
        if key == "children":
            entity.children += _actions(node, file)
        else:
            entity.children += [_element(key, each, file) for each in node.value]
        return
    entity.attributes[key] = _value(node, file)


def _actions(node: yaml.SequenceNode, file: str) -> list[Entity]:
    found = []
    for each in node.value:
        if not isinstance(each, yaml.MappingNode) or len(each.value) != 1:
            line = each.start_mark.line + 1
            raise DocumentError("each action is a mapping with one key, such as `- node: {...}`", file, line)
        (key, value) = each.value[0]
        element = _element(str(key.value), value, file)
        element.place = Place(file, key.start_mark.line + 1)
        found.append(element)
    return found


def _value(node: yaml.Node, file: str) -> Any:
    """Return YAML's value of a text: a scalar, or a list of them."""
    if isinstance(node, yaml.SequenceNode):
        return [_value(each, file) for each in node.value]
    line = node.start_mark.line + 1
    if not isinstance(node, yaml.ScalarNode):
        raise DocumentError(f"a value is a text, a number or a list, got a mapping: {shown(str(node.tag))}", file, line)
    if node.style is not None:
        return str(node.value)
    try:
        return yaml.safe_load(node.value)
    except (yaml.YAMLError, ValueError):
        return str(node.value)
