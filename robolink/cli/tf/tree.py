"""Tree of frames for `robolink tf tree`: all frames, their rates and ages, and what is wrong with them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any, NamedTuple

from robolink.cli.shared.output import say, say_json
from robolink.cli.shared.session import node_of, opened
from robolink.cli.tf.watch import TOPICS, NoTransformsError, Seen, Watch
from robolink.system import clocks
from robolink.system.terminal import shown
from robolink.tf2.listing import Frame, as_dot

S = 10**9

LATE = 1.0
"""Age from which a moving frame counts as old, in seconds, beyond two periods."""

NAMED_WITHIN = 1.0
"""Timeout of the announcements of publishers, in seconds, even on a busy machine."""

NEAR = 10 * S
"""Upper bound of a stamp's distance to this computer's clock, in ns: beyond, stamps are of another clock."""


class Node(NamedTuple):
    """A frame in the tree: its link that was heard last, and the publishers of that link."""

    name: str
    link: Seen
    senders: list[str]
    age: float | None
    """Age of its last stamp, in seconds; None of a static one."""


def run(wait: float, topics: tuple[str, str], form: str) -> None:
    """Listen, then show the tree as ``text``, ``json`` or ``dot``. Raises NoTransformsError if nothing comes."""
    watch = listened(wait, topics)
    links, now = list(watch.links.values()), clocks.now()
    found = nodes(links, now)
    wrong = [*problems(found, links), *refusals(watch.refused)]
    if form == "json":
        say_json(_data(found, wrong))
    elif form == "dot":
        say(graph(links, now))
    else:
        say("\n".join([*map(_drawable, lines(found)), *(f"! {each}" for each in wrong)]))


def listened(wait: float, topics: tuple[str, str] = TOPICS) -> Watch:
    """Return all that is heard of transforms within `wait` seconds. Raises NoTransformsError if nothing comes."""
    with opened() as context:
        watch = Watch(node_of(context), topics)
        watch.listen(wait)
        watch.await_names(NAMED_WITHIN)
        if not watch.links:
            raise NoTransformsError(f"no transforms within {wait:g} s; {watch.why_nothing()}")
    return watch


def graph(links: list[Seen], now: int) -> str:
    """Return the tree as a graph for Graphviz; `now` is this computer's clock in ns."""
    return as_dot([_in_graph(each) for each in nodes(links, now).values()], reference(links, now))


def nodes(links: list[Seen], now: int) -> dict[str, Node]:
    """Return one node for all links of a child; its parent is the one that was heard last."""
    clock = reference(links, now)
    found = {}
    for child in dict.fromkeys(each.child for each in links):
        own = sorted((each for each in links if each.child == child), key=lambda each: each.arrivals[-1])
        last = own[-1]
        senders = sorted({each.sender for each in own if each.parent == last.parent})
        age = None if last.static else (clock - max(last.stamps)) / S
        found[child] = Node(child, last, senders, age)
    return found


def reference(links: list[Seen], now: int) -> int:
    """Return the time that ages count from: now, or the latest stamp if stamps are of another clock."""
    newest = max((max(each.stamps) for each in links if not each.static), default=now)
    return now if abs(now - newest) < NEAR else newest


# What is wrong


def problems(found: dict[str, Node], links: list[Seen]) -> Iterator[str]:
    """Yield the problems of the tree with which look-ups fail."""
    for child, node in found.items():
        own = [each for each in links if each.child == child]
        parents = {each.parent: each.sender for each in own}
        if len(parents) > 1:
            reported = " and ".join(f"'{shown(parent)}' (from {sender})" for parent, sender in parents.items())
            yield f"'{shown(child)}' has {len(parents)} parents: {reported}: lookups jump between them"
        elif len(node.senders) > 1:
            yield f"'{shown(child)}' is published by {' and '.join(node.senders)}: they overwrite each other"
        if len({each.static for each in own}) > 1:
            yield f"'{shown(child)}' is both static and moving: each makes a buffer forget the other"
        if not node.link.static:
            yield from _old(node)
    tops = roots(found)
    if len(tops) > 1:
        names = ", ".join(f"'{shown(each)}'" for each in tops)
        yield f"{len(tops)} trees that nothing connects, below {names}: no lookup leads from one to another"


def _old(node: Node) -> Iterator[str]:
    if not any(node.link.stamps):
        yield f"'{shown(node.name)}' has no stamps: all are 0, so that only the latest can be looked up"
    elif node.age is not None and node.age > LATE + 2.0 / (node.link.rate or 2.0):
        yield f"'{shown(node.name)}' is old: its last transform is of {node.age:.1f} s ago"
    elif node.age is not None and node.age < -LATE:
        yield f"'{shown(node.name)}' is ahead of time: its last transform is of {-node.age:.1f} s from now"


def refusals(refused: dict[tuple[str, str, str, str], int]) -> Iterator[str]:
    """Yield a line for each kind of transform that buffers refuse."""
    for (parent, child, sender, why), count in refused.items():
        yield f"refused {count} of '{shown(parent)}' -> '{shown(child)}' from {sender}: {why}"


# How it is shown


def roots(found: dict[str, Node]) -> list[str]:
    """Return the roots of all trees; one frame of each cycle."""
    tops = list(dict.fromkeys(each.link.parent for each in found.values() if each.link.parent not in found))
    reached = {name for top in tops for name, _ in _below(found, top)}
    for name in found:
        if name not in reached:
            tops.append(_in_ring(found, name))
            reached |= {tops[-1], *(below for below, _ in _below(found, tops[-1]))}
    return tops


def _in_ring(found: dict[str, Node], name: str) -> str:
    """Return a frame of the cycle that is above this one."""
    seen: set[str] = set()
    while name not in seen:
        seen.add(name)
        name = found[name].link.parent
    return name


def _below(found: dict[str, Node], top: str) -> Iterator[tuple[str, str]]:
    """Yield all frames below one, each once and with what is drawn before it."""
    children: dict[str, list[str]] = {}
    for each in found.values():
        children.setdefault(each.link.parent, []).append(each.name)
    seen = {top}
    stack = [(name, "", False) for name in reversed(children.get(top, []))]
    if stack:
        stack[0] = (stack[0][0], "", True)
    while stack:
        name, before, is_last = stack.pop()
        if name in seen:
            continue
        seen.add(name)
        yield name, f"{before}{'└─ ' if is_last else '├─ '}"
        inner = before + ("   " if is_last else "│  ")
        own = list(reversed(children.get(name, [])))
        stack += [(each, inner, at == 0) for at, each in enumerate(own)]


def lines(found: dict[str, Node]) -> list[str]:
    """Return the lines of the trees: frames to the left, their figures to the right."""
    rows: list[tuple[str, str]] = []
    for top in roots(found):
        rows.append((shown(top), ""))
        rows += [(before + shown(name), _about(found[name])) for name, before in _below(found, top)]
    width = max(len(left) for left, _ in rows)
    return [f"{left:<{width}}  {right}".rstrip() for left, right in rows]


def _drawable(line: str) -> str:
    """Return a line drawn with ASCII if the output's encoding lacks box characters, as that of a pipe on Windows."""
    try:
        "└├─│".encode(getattr(sys.stdout, "encoding", None) or "ascii")
    except UnicodeEncodeError:
        return line.translate(_ASCII)
    return line


_ASCII = str.maketrans({"└": "`", "├": "|", "─": "-", "│": "|"})


def _about(node: Node) -> str:
    senders = ", ".join(node.senders)
    if node.link.static:
        return f"static                {senders}"
    rate = f"{node.link.rate:.1f} Hz" if node.link.rate else "once"
    return f"{rate:>9}  {f'{node.age:.2f} s':>9}  {senders}"


def _data(found: dict[str, Node], wrong: list[str]) -> dict[str, Any]:
    frames = [
        {
            "frame": each.name,
            "parent": each.link.parent,
            "publishers": each.senders,
            "static": each.link.static,
            "rate": None if each.link.static else each.link.rate,
            "age": each.age,
        }
        for each in found.values()
    ]
    return {"roots": roots(found), "frames": frames, "problems": wrong}


def _in_graph(node: Node) -> Frame:
    link = node.link
    stamps = [0] if link.static else link.stamps
    return Frame(node.name, link.parent, ", ".join(node.senders), len(stamps), max(stamps), min(stamps))
