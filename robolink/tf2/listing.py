"""All frames of a buffer as text: YAML, lines for people, and a graph for Graphviz, each in tf2's form."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import NamedTuple

from robolink.system.terminal import shown
from robolink.tf2.cache import LATEST, StaticCache, TimeCache, seconds

AT_ONCE = 100_000
"""Lower bound of the time span of which a rate is computed, in ns, as tf2 has it."""

NOT_TEXT = frozenset(["y", "n", "yes", "no", "true", "false", "on", "off", "null"])
"""Words that are not a text in YAML."""

Caches = Mapping[str, "TimeCache | StaticCache | None"]


class Frame(NamedTuple):
    """A row of a list of frames; times in ns."""

    name: str
    parent: str
    authority: str
    number: int
    newest: int
    oldest: int

    @property
    def span(self) -> int:
        """Time from the earliest to the latest transform, in ns."""
        return self.newest - self.oldest

    @property
    def rate(self) -> float:
        """Transforms a second; a static one counts as 10 kHz, which is how tf2's tools recognize it."""
        return self.number * 1e9 / max(self.span, AT_ONCE)


def known(caches: Caches, authorities: Mapping[str, str]) -> list[Frame]:
    """Return the frames that have a parent now."""
    found = []
    for name, cache in caches.items():
        if cache is not None and len(cache):
            authority = authorities.get(name, "no recorded authority")
            found.append(Frame(name, cache.at(LATEST).parent, authority, len(cache), cache.newest, cache.oldest))
    return found


def as_yaml(frames: list[Frame]) -> str:
    """Return the YAML that the service tf2_frames answers with."""
    lines = []
    for each in frames:
        lines += [
            f"{_key(each.name)}: ",
            f"  parent: {_quoted(each.parent)}",
            f"  broadcaster: {_quoted(each.authority)}",
            f"  rate: {each.rate:.3f}",
            f"  most_recent_transform: {seconds(each.newest)}",
            f"  oldest_transform: {seconds(each.oldest)}",
            f"  buffer_length: {each.span / 1e9:.3f}",
        ]
    return "".join(f"{line}\n" for line in lines) or "[]"


def _key(name: str) -> str:
    """Return a name as tf2 spells it, bare, unless YAML would read something else in it."""
    letters = name.replace("_", "").replace("/", "")
    bare = letters.isascii() and letters.isalnum() and not letters[0].isdigit() and name.lower() not in NOT_TEXT
    return name if bare else _quoted(name)


def _quoted(text: str) -> str:
    if text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    return '"' + shown(text.replace("\\", "\\\\").replace('"', '\\"'), sys.maxsize) + '"'


def as_text(caches: Caches) -> str:
    """Return a line for each frame that has, or had, a parent."""
    lines = []
    for name, cache in caches.items():
        if cache is not None:
            parent = cache.at(LATEST).parent if len(cache) else "NO_PARENT"
            lines.append(f"Frame {name} exists with parent {parent}.\n")
    return "".join(lines)


def as_dot(frames: list[Frame], now: int | None) -> str:
    """Return the tree as a Graphviz graph; with the time `now` in ns, also the age of each transform."""
    if not frames:
        return 'digraph G {\n"no tf data received"\n}'
    lines = ["digraph G {"]
    for each in frames:
        age = "" if now is None else f"({(now - each.newest) / 1e9:.3f} sec old)"
        label = [
            f"Broadcaster: {each.authority}",
            f"Average rate: {each.rate:.3f} Hz",
            f"Most recent transform: {seconds(each.newest)} {age}",
            f"Buffer length: {each.span / 1e9:.3f} sec",
        ]
        text = "\\n".join(_in_dot(line) for line in label)
        lines.append(f'"{_in_dot(each.parent)}" -> "{_in_dot(each.name)}"[label="{text}\\n"];')
    return "\n".join([*lines, "}"])


def _in_dot(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
