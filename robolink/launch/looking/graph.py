"""Uses of topics, services and actions by inspected nodes, and their graph as text, in Mermaid or Graphviz's DOT."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Literal, NamedTuple, TypeAlias

from robolink.launch.entry import Entry
from robolink.launch.looking.look import End, Look

Kind: TypeAlias = Literal["topic", "service", "action"]

_EVERY_NODE_HAS = ("rcl_interfaces/", "type_description_interfaces/")
"""Packages whose types belong to the built-in endpoints of every node: logs, parameters, types."""

_ENDS: dict[str, tuple[Kind, str, bool]] = {
    "MP": ("topic", "publishes", True),
    "MS": ("topic", "subscribes to", False),
    "SS": ("service", "serves", True),
    "SC": ("service", "calls", False),
}
_ACTION, _GOAL, _GOAL_TYPE = "/_action/", "/_action/send_goal", "_SendGoal"


class Use(NamedTuple):
    """One node's use of one topic, service or action."""

    node: str
    kind: Kind
    name: str
    type: str
    hash: str
    verb: str
    """Kind of use: publishes, subscribes to, serves, calls."""
    offers: bool
    """True if it publishes or serves."""


def uses_of(look: Look) -> Iterator[Use]:
    """Yield the uses of a node, without the built-in endpoints; an action, which is five endpoints, once."""
    for end in look.ends:
        use = _use(end)
        if use is not None and not end.type.startswith(_EVERY_NODE_HAS):
            yield use


def _use(end: End) -> Use | None:
    kind, verb, offers = _ENDS[end.kind]
    if end.name.endswith(_GOAL):
        name, type_name = end.name.removesuffix(_GOAL), end.type.removesuffix(_GOAL_TYPE)
        return Use(end.node, "action", name, type_name, end.hash, verb, offers)
    if _ACTION in end.name:
        return None
    return Use(end.node, kind, end.name, end.type, end.hash, verb, offers)


# Graph


class Channel(NamedTuple):
    """A topic, service or action that is drawn."""

    kind: Kind
    name: str
    type: str


class Arrow(NamedTuple):
    """An edge: from a node to a channel that it publishes or calls, or from a channel to a node that it reaches."""

    node: str
    channel: Channel
    leaves: bool
    """True if it points from the node to the channel."""


class Graph(NamedTuple):
    """Nodes and edges: full names of nodes in the order of the file, the rest sorted."""

    nodes: list[str]
    channels: list[Channel]
    arrows: list[Arrow]


def drawn(entries: Iterable[Entry], looks: Mapping[str, Look], format_: str = "mermaid") -> str:
    """Return the graph of a launch file's nodes as text; `format_` is `mermaid` or `dot`."""
    return as_text(graph_of(entries, looks), format_)


def as_text(graph: Graph, format_: str) -> str:
    """Return a graph as text; `format_` is `mermaid` or `dot`."""
    return (_dot if format_ == "dot" else _mermaid)(graph)


def graph_of(entries: Iterable[Entry], looks: Mapping[str, Look]) -> Graph:
    """Return the graph of a launch file's nodes. A node that could not be inspected stands alone."""
    nodes: dict[str, None] = {}
    uses: list[Use] = []
    for entry in entries:
        look = looks.get(entry.name, Look())
        nodes.update(dict.fromkeys(look.nodes or [entry.full_name]))
        uses += uses_of(look)
    return graph_of_uses(nodes, uses)


def graph_of_uses(nodes: Iterable[str], uses: Sequence[Use]) -> Graph:
    """Return the graph of nodes and of what they use; a service or action is drawn only if it is called."""
    called = {each.name for each in uses if not each.offers}
    arrows = {_arrow(each) for each in uses if each.kind == "topic" or each.name in called}
    return Graph(list(nodes), sorted({each.channel for each in arrows}), sorted(arrows))


def _arrow(use: Use) -> Arrow:
    leaves = use.offers if use.kind == "topic" else not use.offers
    return Arrow(use.node, Channel(use.kind, use.name, use.type), leaves)


_MERMAID = {"topic": '(["{}"])', "service": '{{{{"{}"}}}}', "action": '[["{}"]]'}


def _mermaid(graph: Graph) -> str:
    ids: dict[str | Channel, str] = {name: f"n{number}" for number, name in enumerate(graph.nodes)}
    ids |= {each: f"p{number}" for number, each in enumerate(graph.channels)}
    lines = ["flowchart LR"]
    lines += [f'    {ids[each]}["{_html(each)}"]' for each in graph.nodes]
    for each in graph.channels:
        label = f"{_html(each.name)}<br/>{_html(each.type)}"
        lines.append(f"    {ids[each]}{_MERMAID[each.kind].format(label)}")
    for node, channel, leaves in graph.arrows:
        ends = (ids[node], ids[channel]) if leaves else (ids[channel], ids[node])
        lines.append(f"    {ends[0]} {'-->' if channel.kind == 'topic' else '-.->'} {ends[1]}")
    return _text(lines)


def _html(text: str) -> str:
    for character, spelled in (("&", "&amp;"), ('"', "&quot;"), ("<", "&lt;"), (">", "&gt;"), ("\n", " ")):
        text = text.replace(character, spelled)
    return text


_SHAPES = {"topic": "ellipse", "service": "hexagon", "action": "component"}


def _dot(graph: Graph) -> str:
    lines = ["digraph system {", "    rankdir=LR;"]
    lines += [f"    {_quoted(f'node {each}')} [label={_quoted(each)}, shape=box];" for each in graph.nodes]
    for each in graph.channels:
        label = _quoted(f"{each.name}\n{each.type}")
        lines.append(f"    {_quoted(_id(each))} [label={label}, shape={_SHAPES[each.kind]}];")
    for node, channel, leaves in graph.arrows:
        ends = [_quoted(f"node {node}"), _quoted(_id(channel))]
        style = "" if channel.kind == "topic" else " [style=dashed]"
        lines.append(f"    {' -> '.join(ends if leaves else ends[::-1])}{style};")
    return _text([*lines, "}"])


def _id(channel: Channel) -> str:
    """Return the unique id of a channel: two nodes may use one name with two types."""
    return " ".join(channel)


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _text(lines: Sequence[str]) -> str:
    return "\n".join(lines) + "\n"
