"""Tables of `robolink top`: rows of nodes and topics from what was measured, filtered, sorted and laid out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from robolink.cli.shared.graph import is_hidden


class NodeRow(NamedTuple):
    """Row of the nodes of one process.

    `pid`, `cpu` (percent of one core) and `memory` (bytes) are None where they are not known: on other machines, other
    users' processes, and CPU at the first look. `rate` (Hz) and `bandwidth` (bytes/s) are of what the nodes publish.
    """

    names: tuple[str, ...]
    pid: int | None = None
    cpu: float | None = None
    memory: int | None = None
    rate: float | None = None
    bandwidth: float | None = None


class TopicRow(NamedTuple):
    """Row of a topic: `rate` in Hz, `bandwidth` in bytes/s, `age` of the last message in s; None where not known.

    `lost` counts the messages that publishers have numbered and that did not arrive here; `missed` those that the
    nodes' own subscriptions have lost, on the way or since their callbacks are too slow, as the nodes report it.
    """

    name: str
    types: tuple[str, ...]
    rate: float | None = None
    bandwidth: float | None = None
    age: float | None = None
    lost: int = 0
    publishers: int = 0
    subscriptions: int = 0
    missed: int = 0


class Shown(NamedTuple):
    """One look at a system."""

    nodes: Sequence[NodeRow]
    topics: Sequence[TopicRow]


class View(NamedTuple):
    """Selection of what is shown: order, text that a name or type must have, hidden names, order turned around."""

    order: str = "name"
    filter: str = ""
    hidden: bool = False
    is_reversed: bool = False


def _most(of: Callable[[Any], float | None]) -> Callable[[Any], tuple[float, str]]:
    """Return a sort key that has the largest first, then by name; what is not known comes last."""
    return lambda row: (-v if (v := of(row)) is not None else float("inf"), _name(row))


def _name(row: NodeRow | TopicRow) -> str:
    return row.names[0] if isinstance(row, NodeRow) else row.name


ORDERS: dict[str, Callable[[Any], Any]] = {
    "name": _name,
    "cpu": _most(lambda row: getattr(row, "cpu", None)),
    "memory": _most(lambda row: getattr(row, "memory", None)),
    "rate": _most(lambda row: row.rate),
    "bandwidth": _most(lambda row: row.bandwidth),
    "age": _most(lambda row: getattr(row, "age", None)),
    "lost": _most(lambda row: row.lost + row.missed if isinstance(row, TopicRow) else None),
}
"""Orders of rows, by name; nodes have no age and topics no CPU: they are by name then."""


def chosen(shown: Shown, view: View) -> Shown:
    """Return the rows that a view shows, in its order."""
    nodes = [row for row in shown.nodes if _is_chosen(row.names, (), view)]
    topics = [row for row in shown.topics if _is_chosen((row.name,), row.types, view)]
    key = ORDERS[view.order]
    return Shown(sorted(nodes, key=key, reverse=view.is_reversed), sorted(topics, key=key, reverse=view.is_reversed))


def _is_chosen(names: Sequence[str], types: Sequence[str], view: View) -> bool:
    if not view.hidden and all(is_hidden(each) for each in names):
        return False
    text = view.filter.lower()
    return not text or any(text in each.lower() for each in (*names, *types))


def summary(shown: Shown, domain: int) -> str:
    """Return the line above the tables: how much there is, and what it carries in all."""
    names = sum(len(each.names) for each in shown.nodes)
    rates = [each.rate for each in shown.topics if each.rate is not None]
    text = f"domain {domain}: {_count(names, 'node')}, {_count(len(shown.topics), 'topic')}"
    if rates:
        carried = sum(each.bandwidth or 0.0 for each in shown.topics)
        text += f", {sum(rates):.0f} messages/s, {as_bytes(carried)}/s"
    lost = sum(each.lost for each in shown.topics)
    missed = sum(each.missed for each in shown.topics)
    return text + (f", {lost} lost" if lost else "") + (f", {missed} missed by nodes" if missed else "")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


NODE_HEADER = ["NODE", "PID", "CPU", "MEMORY", "SENDS", "BANDWIDTH"]
TOPIC_HEADER = ["TOPIC", "TYPE", "RATE", "BANDWIDTH", "AGE", "LOST", "MISSED", "PUBS", "SUBS"]
_LEFT = {"NODE", "TOPIC", "TYPE"}
NARROWEST = 12
"""Least width of a column of names, however narrow the terminal is."""


def node_cells(row: NodeRow) -> list[str]:
    """Return the cells of a node's row."""
    first, *others = row.names
    name = f"{first} (+{len(others)})" if len(others) > 2 else ", ".join(row.names)
    cpu = "-" if row.cpu is None else f"{row.cpu:.0f} %"
    memory = "-" if row.memory is None else as_bytes(row.memory)
    return [name, "-" if row.pid is None else str(row.pid), cpu, memory, _rate(row.rate), _bandwidth(row.bandwidth)]


def topic_cells(row: TopicRow) -> list[str]:
    """Return the cells of a topic's row."""
    age = "-" if row.age is None else f"{row.age:.1f} s" if row.age < 100 else f"{row.age:.0f} s"
    types = ", ".join(row.types)
    numbers = [str(row.lost or "-"), str(row.missed or "-"), str(row.publishers), str(row.subscriptions)]
    return [row.name, types, _rate(row.rate), _bandwidth(row.bandwidth), age, *numbers]


def _rate(rate: float | None) -> str:
    return "-" if rate is None else f"{rate:.1f} Hz" if rate < 100 else f"{rate:.0f} Hz"


def _bandwidth(bandwidth: float | None) -> str:
    return "-" if bandwidth is None else f"{as_bytes(bandwidth)}/s"


def as_bytes(number: float) -> str:
    """Return bytes as text: B, kB, MB or GB, of a thousand each.

    >>> [as_bytes(each) for each in (12, 4_500, 46_000_000, 12e9)]
    ['12 B', '4.5 kB', '46 MB', '12 GB']
    """
    for unit, size in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if number >= size:
            value = number / size
            return f"{value:.1f} {unit}" if value < 10 else f"{value:.0f} {unit}"
    return f"{number:.0f} B"


def laid_out(header: Sequence[str], rows: Iterable[Sequence[str]], widest: int = 60, columns: int = 0) -> list[str]:
    """Return the lines of a table, numbers to the right; a cell that is longer than `widest` is cut in its middle.

    Args:
        header: Titles of the columns.
        rows: Cells of each row.
        widest: Upper bound of a cell's length.
        columns: Width of the terminal: types, then names are cut further until all numbers are seen; 0 for any.
    """
    cells = [list(header), *map(list, rows)]
    widths = [min(max(map(len, column)), widest) for column in zip(*cells, strict=True)]
    left = [title in _LEFT for title in header]
    over = sum(widths) + 2 * (len(widths) - 1) - columns if columns else 0
    for at in reversed([number for number, is_left in enumerate(left) if is_left]):
        less = max(0, min(over, widths[at] - NARROWEST))
        widths[at], over = widths[at] - less, over - less
    return [
        "  ".join(
            _cut(cell, width).ljust(width) if is_left else cell.rjust(width)
            for cell, width, is_left in zip(row, widths, left, strict=True)
        ).rstrip()
        for row in cells
    ]


def _cut(text: str, widest: int) -> str:
    half = (widest - 1) // 2
    return text if len(text) <= widest else f"{text[:half]}…{text[len(text) - (widest - 1 - half) :]}"


def lines(shown: Shown, domain: int) -> list[str]:
    """Return all tables as lines, for where there is no terminal."""
    nodes = laid_out(NODE_HEADER, (node_cells(each) for each in shown.nodes))
    topics = laid_out(TOPIC_HEADER, (topic_cells(each) for each in shown.topics))
    return [summary(shown, domain), "", *nodes, "", *topics, ""]


def data(shown: Shown) -> dict[str, Any]:
    """Return one look for JSON, in the units of the rows."""
    return {
        "nodes": [each._asdict() for each in shown.nodes],
        "topics": [each._asdict() for each in shown.topics],
    }
