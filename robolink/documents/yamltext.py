"""YAML parser: text to nodes with their places, and nodes to plain data, with YAML 1.2's scalars.

Differences from YAML 1.1, all on purpose: `on`, `off`, `yes`, `no`, dates and `12:30:00` are strings, `012`
is 12, `1e3` is 1000.0, mapping keys are strings as they were written, and a key given twice is an error.
"""

from __future__ import annotations

import contextlib
import gc
import re
from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

import yaml
from yaml.composer import Composer
from yaml.resolver import Resolver

from robolink.exceptions import DocumentError
from robolink.system.files import size
from robolink.system.terminal import shown, with_article

try:
    from yaml._yaml import CParser
except ImportError:  # a PyYAML that was built without libyaml
    CParser = None  # type: ignore[assignment,misc]

MAX_BYTES = 5_000_000
"""Largest YAML file, in bytes."""
MAX_NODES = 100_000
"""Most nodes of a document: values, keys, lists and mappings."""
MAX_SLOW_NODES = 20_000
"""Most nodes where PyYAML has no libyaml, which is five times as fast."""
SHORT = 20_000
"""Longest text, in characters, that PyYAML's own parser reads again for its error message, if libyaml's refuses it."""
MAX_DEPTH = 64
LONGEST_INT = 1000
"""Most digits of an integer: Python does not print one of more than 4,300, though it parses it from hexadecimal."""
MAX_REPEATED = 100_000
"""Most values that aliases may add: a few lines of nested aliases could fill the memory (billion laughs)."""

Data: TypeAlias = "bool | int | float | str | list[Data] | dict[str, Data] | None"

_TAG = "tag:yaml.org,2002:"
_MERGE = _TAG + "merge"
_PLAIN = [
    ("null", "~|null|Null|NULL|", ["~", "n", "N", ""]),
    ("bool", "true|True|TRUE|false|False|FALSE", list("tTfF")),
    ("int", r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+", list("-+0123456789")),
    (
        "float",
        r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)",
        list("-+0123456789."),
    ),
    ("merge", "<<", ["<"]),
]


class _Bounded(Composer):
    """A composer with YAML 1.2's scalars, and with limits on nesting and on the number of nodes."""

    yaml_implicit_resolvers: dict[str, list[tuple[str, re.Pattern[str]]]] = {}
    most = MAX_NODES
    _depth = _count = 0
    peek_event: Callable[[], Any]
    dispose: Callable[[], None]

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        self._depth += 1
        self._count += 1
        if parent is not None and self._depth > MAX_DEPTH:
            raise yaml.MarkedYAMLError(None, None, f"nested more than {MAX_DEPTH} levels deep", parent.start_mark)
        if parent is not None and self._count > self.most:
            mark = self.peek_event().start_mark
            raise yaml.MarkedYAMLError(None, None, f"more than {self.most} values: that is too large a document", mark)
        node = super().compose_node(parent, index)
        self._depth -= 1
        return node


class _Loader(_Bounded, yaml.SafeLoader):
    """PyYAML's own loader, for errors of short texts, and for all where there is no libyaml."""

    most = MAX_SLOW_NODES


if CParser is not None:

    class _FastLoader(_Bounded, CParser, Resolver):
        """libyaml's parser, which gives the same places, but for a value that is left out."""

        def __init__(self, text: str) -> None:
            self._is_short = len(text) <= SHORT
            CParser.__init__(self, text)
            Composer.__init__(self)
            Resolver.__init__(self)

        def compose_scalar_node(self, anchor: Any) -> yaml.ScalarNode:
            node = super().compose_scalar_node(anchor)
            if self._is_short and not node.value and not node.style:
                raise yaml.YAMLError("a value is left out")  # PyYAML's own parser knows its place
            node.style = node.style or None  # as PyYAML's own parser has it for a plain scalar
            return node


for _name, _pattern, _first in _PLAIN:
    for _each in _first:
        _Bounded.yaml_implicit_resolvers.setdefault(_each, []).append((_TAG + _name, re.compile(rf"(?:{_pattern})\Z")))


def compose(text: str, name: str) -> yaml.Node | None:
    """Parse one document into nodes; `None` when it is empty. `name` is for errors: `name:line:column`.

    The `index` of a node's marks counts characters from the beginning of the text. Raises `DocumentError`, and
    nothing else, whatever the text.
    """
    if len(text) > MAX_BYTES:
        raise DocumentError(f"longer than {size(MAX_BYTES)}", name)
    if strange := yaml.reader.Reader.NON_PRINTABLE.search(text):
        message = f"character U+{ord(strange[0]):04X} is not allowed in YAML"
        raise DocumentError(message, name, *_place(text, strange.start()))
    if CParser is None or text.startswith("\ufeff"):  # a mark that libyaml does not count
        return _composed(_Loader(text), name)
    try:
        return _composed(_FastLoader(text), name)
    except DocumentError:
        if len(text) > SHORT:
            raise
        return _composed(_Loader(text), name)  # five times as slow, and its error messages are the clearer ones


def _composed(loader: _Bounded, name: str) -> yaml.Node | None:
    """Return the node of the one document that a loader reads."""
    try:
        with _no_collection():
            return loader.get_single_node()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark or _mark(loader)
        raise DocumentError(_problem(error), name, *place(mark)) from None
    except (yaml.YAMLError, ValueError, OverflowError) as error:  # such as for '\UFFFFFFFF', '%YAML 9999...'
        raise DocumentError(shown(str(error)), name, *place(_mark(loader))) from None
    finally:
        loader.dispose()


def _mark(loader: _Bounded) -> yaml.Mark:
    """Return the current position of a loader; libyaml's does not have one."""
    known = getattr(loader, "get_mark", None)
    return yaml.Mark("", 0, 0, 0, None, 0) if known is None else known()


def plain(node: yaml.Node | None, name: str) -> Data:
    """Convert a node to plain data; raises `DocumentError` for a node without a plain value."""
    with _no_collection():
        return None if node is None else _Builder(name).build(node)


def texts(node: yaml.Node | None, name: str) -> Data:
    """Convert a node to plain data whose scalars stay as they were written: strings, or None for null.

    Raises `DocumentError` like `plain`.
    """
    with _no_collection():
        return None if node is None else _TextBuilder(name).build(node)


@contextlib.contextmanager
def _no_collection() -> Iterator[None]:
    """Pause the garbage collector, which would scan the growing number of nodes again and again."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def place(mark: yaml.Mark) -> tuple[int, int]:
    """Return line and column of a mark, counted from 1 as in editors."""
    return mark.line + 1, mark.column + 1


def pairs(node: yaml.MappingNode) -> Iterator[tuple[yaml.Node, yaml.Node]]:
    """Yield a mapping's own (key, value) nodes, then those that `<<` merges into it, nearest first."""
    merged: list[yaml.Node] = []
    for key, value in node.value:
        if key.tag == _MERGE:
            merged += value.value if isinstance(value, yaml.SequenceNode) else [value]
        else:
            yield key, value
    for each in merged:
        if isinstance(each, yaml.MappingNode):
            yield from pairs(each)


class _Builder:
    """Converts nodes to plain data, counting the values that aliases repeat."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.seen: set[int] = set()
        self.repeated = 0
        self.depth = 0

    def build(self, node: yaml.Node) -> Data:
        self._count(node)
        if isinstance(node, yaml.ScalarNode):
            return self._scalar(node)
        self.depth += 1
        data: Data
        if isinstance(node, yaml.SequenceNode):
            self._check_tag(node, "seq")
            data = [self.build(each) for each in node.value]
        else:
            assert isinstance(node, yaml.MappingNode)
            data = self._mapping(node)
        self.depth -= 1
        return data

    def _count(self, node: yaml.Node) -> None:
        """Raise DocumentError for an alias that contains itself, and for aliases that multiply."""
        if self.depth > MAX_DEPTH:
            raise self._error(node, f"nested more than {MAX_DEPTH} levels deep by aliases")
        if id(node) in self.seen:
            self.repeated += 1
        if self.repeated > MAX_REPEATED:
            raise self._error(node, f"aliases repeat more than {MAX_REPEATED} values")
        self.seen.add(id(node))

    def _mapping(self, node: yaml.MappingNode) -> dict[str, Data]:
        self._check_tag(node, "map")
        self._check_merges(node)
        self._check_duplicates(node)
        data: dict[str, Data] = {}
        for key, value in pairs(node):
            name = self._key(key)
            if name not in data:
                data[name] = self.build(value)
        return data

    def _check_merges(self, node: yaml.MappingNode, depth: int = 0) -> None:
        for key, value in node.value:
            if key.tag != _MERGE:
                continue
            for each in value.value if isinstance(value, yaml.SequenceNode) else [value]:
                if not isinstance(each, yaml.MappingNode):
                    raise self._error(each, "'<<' can merge only mappings")
                self._count(each)
                if depth > MAX_DEPTH:
                    raise self._error(each, "'<<' merges a mapping into itself")
                self._check_merges(each, depth + 1)

    def _check_duplicates(self, node: yaml.MappingNode) -> None:
        first: dict[str, yaml.Node] = {}
        for key, _ in node.value:
            name = self._key(key)
            if name in first:
                line = first[name].start_mark.line + 1
                raise self._error(key, f"key '{shown(name)}' is given twice, first in line {line}")
            first[name] = key

    def _key(self, key: yaml.Node) -> str:
        if not isinstance(key, yaml.ScalarNode):
            raise self._error(key, f"a key must be a word, got a {kind(key)}")
        return self._text(key)

    def _text(self, node: yaml.ScalarNode) -> str:
        text: str = node.value
        if not text.isascii() and any("\ud800" <= each <= "\udfff" for each in text):
            raise self._error(node, "half a surrogate pair is not a character")
        return text

    def _scalar(self, node: yaml.ScalarNode) -> Data:
        text = self._text(node)
        convert = _SCALARS.get(node.tag.removeprefix(_TAG))
        if convert is None:
            raise self._error(node, f"unknown tag '{_shown_tag(node)}'")
        try:
            return convert(text)
        except (ValueError, KeyError):
            raise self._error(node, f"'{shown(text)}' is not {with_article(node.tag.removeprefix(_TAG))}") from None

    def _check_tag(self, node: yaml.Node, tag: str) -> None:
        if node.tag != _TAG + tag:
            raise self._error(node, f"unknown tag '{_shown_tag(node)}'")

    def _error(self, node: yaml.Node, message: str) -> DocumentError:
        return DocumentError(message, self.name, *place(node.start_mark))


class _TextBuilder(_Builder):
    """Converts nodes to plain data without a type for any scalar: `012` stays "012"."""

    def _scalar(self, node: yaml.ScalarNode) -> Data:
        return None if node.tag == _TAG + "null" else self._text(node)


def kind(node: yaml.Node) -> str:
    """Return the kind of a node: `mapping`, `list` or `value`."""
    return _KINDS.get(type(node), "value")


_KINDS: dict[type[yaml.Node], str] = {yaml.MappingNode: "mapping", yaml.SequenceNode: "list"}


def _int(text: str) -> int:
    if len(text) > LONGEST_INT:
        raise ValueError("too many digits")
    prefix = text[:2].lower()
    return int(text, {"0x": 16, "0o": 8}.get(prefix, 10))


def _float(text: str) -> float:
    return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))


def _bool(text: str) -> bool:
    return {"true": True, "false": False}[text.lower()]


def _null(text: str) -> None:
    {"~": None, "null": None, "": None}[text.lower()]


_SCALARS: dict[str, Callable[[str], Data]] = {
    "null": _null,
    "bool": _bool,
    "int": _int,
    "float": _float,
    "str": str,
    "merge": str,
}


def _shown_tag(node: yaml.Node) -> str:
    return shown(node.tag.replace(_TAG, "!!"))


def _place(text: str, position: int) -> tuple[int, int]:
    before = text[:position]
    return before.count(chr(10)) + 1, position - before.rfind(chr(10))


_CLEARER = {
    "exceeded maximum nesting depth": f"nested more than {MAX_DEPTH} levels deep",  # libyaml's own limit
    "'\\t'": "a tab where only spaces may stand",
    "mapping values are not allowed here": "a second ': ' in one value, or a key that is indented wrongly",
    "expected <block end>": "this does not go on with the block above it: check its indentation and its '-'",
    "found unexpected end of stream": "a quote is opened and never closed",
    "but found another document": "a second document begins here, and one file holds one",
    "second occurrence": "this anchor is given twice",
    "expected escape sequence of": "a backslash in double quotes begins an escape: use '/' or single quotes",
    "found unknown escape character": "a backslash in double quotes begins an escape: use '/' or single quotes",
    "found character '@' that": "a plain value cannot begin with '@': put it in quotes",
    "found character '`' that": "a plain value cannot begin with '`': put it in quotes",
    "found character '%' that": "a plain value cannot begin with '%': put it in quotes",
}
"""Clearer words for PyYAML's messages."""


def _problem(error: yaml.MarkedYAMLError) -> str:
    """Return PyYAML's two-part message in one line, in clearer words if there are any."""
    theirs = error.problem or "cannot be read"
    ours = next((better for part, better in _CLEARER.items() if part in theirs), theirs)
    problem = shown(ours.replace("'<stream end>'", "the end of the text"), 200)
    if error.context and error.context_mark and "while" in error.context:
        return f"{problem} ({error.context} that begins in line {error.context_mark.line + 1})"
    return problem
