"""Parser of ROS 2's parameters in YAML: single values, and files with sections for nodes.

The rules are rcl's where they differ from plain YAML: `yes` and `on` are booleans, `010` is 8, dates and `null`
are strings, and sections may repeat, the last value winning. A tag decides, as in Lyrical: `!!float 10` is 10.0.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from typing import cast

import yaml

from robolink.arguments.overrides import Override, Scalar, Value, by_first_pattern
from robolink.documents import yamltext
from robolink.documents.yamlfile import DocumentNotFoundError, read_text
from robolink.exceptions import DocumentError, nearest
from robolink.system.terminal import shown
from robolink.text.names import NODE_NAME_RULES, find_problem

PARAMETERS_KEY = "ros__parameters"


class ParameterFileError(DocumentError, RuntimeError):
    """A file is not a ROS parameter file (rclpy raises `RuntimeError`); the text begins with file:line:column."""


def read_parameter_file(path: str | os.PathLike[str]) -> list[Override]:
    """Read a ROS parameter file; later entries override earlier ones, sections in the order of their first appearance.

    Raises `DocumentNotFoundError` (a `FileNotFoundError`) where there is no such file, and `ParameterFileError`
    with file:line:column for everything else that is wrong; both are `DocumentError`s.
    """
    try:
        text = read_text(path)
    except DocumentNotFoundError:
        raise
    except DocumentError as error:
        raise ParameterFileError(error.message, error.file, error.line, error.column) from None
    return parse_parameter_file(text, os.fspath(path))


def parse_parameter_file(text: str, name: str) -> list[Override]:
    """Read the text of a ROS parameter file; `name` stands for the file in errors."""
    reader = _Reader(name)
    root = reader.compose(text)
    return [] if root is None else by_first_pattern(reader.sections(root, ()))


def parse_parameter_value(text: str, name: str = "<value>") -> Value:
    """Read one value: a scalar or a list of them, such as `1`, `'1'`, `0x1F`, `.inf` or `[1, 2.5]`.

    Raises `ParameterFileError` with name:line:column.
    """
    reader = _Reader(name)
    node = reader.compose(text)
    if node is None:
        raise ParameterFileError("no value (write '' for an empty string)", name, 1, 1)
    return reader.value(node)


class _Reader:
    """Converter of YAML nodes into parameters; what does not fit becomes errors that know their place."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.seen: set[int] = set()
        self.text = ""

    def compose(self, text: str) -> yaml.Node | None:
        self.text = text
        try:
            return yamltext.compose(text, self.name)
        except DocumentError as error:
            raise ParameterFileError(error.message, error.file, error.line, error.column) from None

    def sections(self, node: yaml.Node, path: tuple[str, ...]) -> Iterator[Override]:
        """Yield the parameters of all sections below a mapping of (parts of) node names."""
        for key, child in self.items(node, "a section for each node"):
            if key.value != PARAMETERS_KEY:
                self.check_section(key, child)
                yield from self.sections(child, (*path, key.value))
            elif not path:
                raise self.error(key, f"the name of a node must stand above {PARAMETERS_KEY}")
            else:
                pattern = self.pattern(key, path)
                for name, value in self.parameters(child, ""):
                    yield Override(pattern, name, value)

    def check_section(self, key: yaml.ScalarNode, child: yaml.Node) -> None:
        if isinstance(child, yaml.MappingNode):
            return
        hint = nearest(key.value, [PARAMETERS_KEY])
        raise self.error(key, f"'{key.value}' must stand below {PARAMETERS_KEY}{hint}")

    def pattern(self, key: yaml.Node, path: tuple[str, ...]) -> str:
        """Join the keys above `ros__parameters`; each token must be a name, '*' or '**'."""
        if len(path[-1]) > 1 and path[-1].endswith("/"):
            raise self.error(key, f"'{path[-1]}' above {PARAMETERS_KEY} ends with a slash, which ROS 2 refuses")
        pattern = "/" + "/".join(part.strip("/") for part in path if part != "/")
        for token in pattern[1:].split("/"):
            problem = find_problem(token, NODE_NAME_RULES)
            if token not in ("*", "**") and problem is not None:
                raise self.error(key, f"node name '{token}' above {PARAMETERS_KEY} {problem.message}")
        return pattern

    def parameters(self, node: yaml.Node, prefix: str) -> Iterator[tuple[str, Value]]:
        """Yield the values below a mapping, nested names joined by dots."""
        for key, child in self.items(node, "parameters"):
            name = prefix + key.value
            if isinstance(child, yaml.MappingNode):
                yield from self.parameters(child, f"{name}.")
            else:
                yield name, self.value(child, f"{name}: ")

    def items(self, node: yaml.Node, expected: str) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
        self.check_alias(node)
        if not isinstance(node, yaml.MappingNode):
            raise self.error(node, f"expected a mapping with {expected}, got {_found(node)}")
        for key, child in node.value:
            if not isinstance(key, yaml.ScalarNode) or not key.value:
                raise self.error(key, f"expected a name, got {_found(key)}")
            self.check_text(key)
            yield key, child

    def value(self, node: yaml.Node, what: str = "") -> Value:
        """Return the value of a scalar or of a list whose items have one type."""
        if isinstance(node, yaml.ScalarNode):
            return self.scalar(node, what)
        self.check_alias(node)
        if not isinstance(node, yaml.SequenceNode):
            raise self.error(node, f"{what}a parameter cannot be a mapping")
        items: list[Scalar] = []
        for child in node.value:
            if not isinstance(child, yaml.ScalarNode):
                raise self.error(child, f"{what}a list cannot hold {_found(child)}")
            items.append(self.scalar(child, what))
            if type(items[0]) is not type(items[-1]):
                raise self.error(child, f"{what}a list holds one type, got {_mixed(items, child.value)}")
        return cast("Value", items)

    def scalar(self, node: yaml.ScalarNode, what: str) -> Scalar:
        self.check_alias(node)
        self.check_text(node)
        text: str = node.value
        tag = self.tag(node)
        if tag in _TAGGED:
            return self.tagged(node, tag, what)
        if node.style or tag == "str":
            return text
        if not text:
            raise self.error(node, f"{what}no value (write '' for an empty string)")
        return parse_scalar(text)

    def tag(self, node: yaml.ScalarNode) -> str:
        """Return the name behind `!!` that a scalar carries in the text; '' for none, and for another kind of tag."""
        known = node.tag.startswith(_YAML_TAG) and _TAG.match(self.text, node.start_mark.index) is not None
        return node.tag.removeprefix(_YAML_TAG) if known else ""

    def tagged(self, node: yaml.ScalarNode, tag: str, what: str) -> Scalar:
        """Return the value of a scalar whose tag decides, as in Lyrical's rcl (rcl#1275).

        Kilted's reads a tag other than `!!str` as if it were not there.
        """
        value = parse_scalar(node.value)
        if tag == "float" and type(value) is int:
            value = float(value)
        if type(value) is not _TAGGED[tag]:
            raise self.error(node, f"{what}!!{tag} stands before '{node.value}', which is not one")
        return value

    def check_alias(self, node: yaml.Node) -> None:
        """Refuse aliases, as rcl does: a node that is met twice stands for one."""
        if id(node) in self.seen:
            raise self.error(node, "aliases are not allowed among parameters")
        self.seen.add(id(node))

    def check_text(self, node: yaml.ScalarNode) -> None:
        """Refuse half a surrogate pair, which an escape can spell and no message can carry."""
        if not node.value.isascii() and any("\ud800" <= each <= "\udfff" for each in node.value):
            raise self.error(node, "half a surrogate pair is not a character")

    def error(self, node: yaml.Node, message: str) -> ParameterFileError:
        return ParameterFileError(shown(message, 200), self.name, *yamltext.place(node.start_mark))


def _found(node: yaml.Node) -> str:
    if isinstance(node, yaml.ScalarNode):
        return f"'{node.value}'" if node.value else "nothing"
    return f"a {yamltext.kind(node)}"


def _mixed(items: list[Scalar], text: str) -> str:
    """Return in words what a list mixes; integers among numbers of floating point need a point."""
    first, other = type(items[0]), type(items[-1])
    cure = {(float, int): f": write {text}.0", (int, float): f": write {items[0]}.0"}.get((first, other), "")
    return f"{other.__name__} after {first.__name__}{cure}"


_TAG = re.compile(r"(?:&\S*\s+)?!")
_YAML_TAG = "tag:yaml.org,2002:"
_TAGGED = {"bool": bool, "int": int, "float": float}
"""Types by the tags that decide."""


_TRUE = re.compile(r"[Yy]|yes|Yes|YES|true|True|TRUE|on|On|ON")
_FALSE = re.compile(r"[Nn]|no|No|NO|false|False|FALSE|off|Off|OFF")
_INTEGERS = (
    (re.compile(r"[-+]?(?:0|[1-9][0-9]*)"), 10),
    (re.compile(r"[-+]?0[xX][0-9a-fA-F]+"), 16),
    (re.compile(r"[-+]?0[0-7]+"), 8),
)
_FLOAT = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_NAN = re.compile(r"\.(?:nan|NaN|NAN)|[-+]?(?i:nan)")
_INF = re.compile(r"[-+]?(?:\.(?:inf|Inf|INF)|(?i:inf|infinity))")
_LONGEST_NUMBER = 400
"""Number of digits beyond which more cannot change a 64-bit number."""


def parse_scalar(text: str) -> Scalar:
    """Read a plain scalar as rcl does: a boolean, a 64-bit integer, a number, or else a string.

    >>> [parse_scalar(each) for each in ("yes", "0x1F", "1e3", "-.inf", "12:30")]
    [True, 31, 1000.0, -inf, '12:30']
    """
    if _TRUE.fullmatch(text) or _FALSE.fullmatch(text):
        return _TRUE.fullmatch(text) is not None
    return text if len(text) > _LONGEST_NUMBER else _parse_number(text)


def _parse_number(text: str) -> int | float | str:
    for pattern, base in _INTEGERS:
        if pattern.fullmatch(text) and -(2**63) <= int(text, base) < 2**63:
            return int(text, base)
    if _FLOAT.fullmatch(text):
        number = float(text)
        return number if math.isfinite(number) else text
    if _NAN.fullmatch(text):
        return math.nan
    if _INF.fullmatch(text):
        return -math.inf if text.startswith("-") else math.inf
    return text
