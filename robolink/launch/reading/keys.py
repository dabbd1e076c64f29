"""Unknown keys of a launch file, with a suggestion for each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import msgspec

from robolink.exceptions import DocumentError, nearest
from robolink.launch.reading.description import GroupDescription, IncludeDescription, LaunchDescription, NodeDescription
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.substitution import Step
from robolink.system.terminal import shown


class _Kind(NamedTuple):
    """Kind of a mapping: its name, its valid keys, and their names in other launch systems."""

    title: str
    struct: type[msgspec.Struct]
    others: dict[str, str]

    @property
    def keys(self) -> tuple[str, ...]:
        return self.struct.__struct_encode_fields__


_PACKAGE = "`node: PACKAGE EXECUTABLE`, or `node: NAME`"
_SHARED = {
    "param": "`parameters`",
    "params": "`parameters`",
    "parameter": "`parameters`",
    "remap": "`remappings: {from: to}`",
    "remaps": "`remappings: {from: to}`",
    "ns": "`namespace`",
    "environment": "`env`",
    "set_env": "`env`",
    "depends_on": "`start_after`",
    "wait_for": "`start_after`",
    "restart": "`respawn`",
    "container": "`process`, the same for all nodes that share one",
    "when": "`if`",
    "condition": "`if`",
    "delay": "nothing waits for a time: `start_after` names what must be there",
    "respawn_delay": "`respawn: {delay: SECONDS}`",
    "respawn_max_retries": "`respawn: {most: N, within: SECONDS}`",
}
_NODE_OTHERS = {
    **_SHARED,
    "package": _PACKAGE,
    "pkg": _PACKAGE,
    "executable": "`node: NAME`, or `run: [program, ...]`",
    "exec": "`node: NAME`, or `run: [program, ...]`",
    "plugin": "`node: FILE.py:Class`, with `process` for nodes that share one",
    "arguments": "`args`",
    "ros_arguments": "`parameters`, `remappings`, `log_level` and `enclave`",
    "cmd": "`run: [program, ...]`",
    "command": "`run: [program, ...]`",
    "stdin": "`interactive: true`",
    "affinity": "`cpu`",
    "output": "leave it out: output is shown and written to the log folder",
    "prefix": "`run: [program, ...]`, the whole command",
    "emulate_tty": "leave it out: output is line-buffered as it is",
}
_TOP_OTHERS = {
    "bag": "`record: FOLDER`, or `record: true`",
    "launch": "at the top stand `arguments`, `nodes`, `include` and `groups`",
    "node": "`nodes`, a list",
    "group": "`groups`, a list",
    "includes": "`include`, a list",
    "arg": "`arguments: {name: default}`",
    "args": "`arguments: {name: default}`",
}
_TOP = _Kind("a launch file", LaunchDescription, _TOP_OTHERS)
_NODE = _Kind("a node", NodeDescription, _NODE_OTHERS)
_GROUP = _Kind("a group", GroupDescription, {**_SHARED, "node": "`nodes`, a list", "group": "`groups`, a list"})
_AROUND = "a group around the include can say it"
_INCLUDE_OTHERS = {
    **dict.fromkeys(
        ("parameters", "remappings", "env", "process", "start_after", "respawn", "on_exit", "enclave"), _AROUND
    ),
    "path": "`file`",
    "args": "`arguments`",
    "ns": "`namespace`",
}
_INCLUDE = _Kind("an include", IncludeDescription, _INCLUDE_OTHERS)
_KINDS = (_NODE, _GROUP, _INCLUDE, _TOP)
_PARTS = {"nodes": _NODE, "include": _INCLUDE, "groups": _GROUP}
"""Kinds of the mappings that a launch file and a group list under these keys."""


def unknown_keys(file: LaunchFile) -> Iterator[DocumentError]:
    """Yield an error for each unknown key of a file, also in sections that are switched off.

    It suggests the nearest key, or the one that has this name in other launch systems.
    """
    for steps, key, meant in _unknown(file.data, _TOP, []):
        yield file.error([*steps, key], f"unknown key '{shown(key)}'{meant}", key=True)


def _unknown(data: Any, kind: _Kind, steps: list[Step]) -> Iterator[tuple[list[Step], str, str]]:
    """Yield the unknown keys of a mapping and of those within: steps, key and suggestion; none for other data."""
    if not isinstance(data, dict):
        return
    for key, value in data.items():
        if key not in kind.keys:
            yield steps, key, _meant(key, kind) or _named(key, value, kind)
        elif kind in (_TOP, _GROUP) and key in _PARTS and isinstance(value, list):
            for index, each in enumerate(value):
                yield from _unknown(each, _PARTS[key], [*steps, key, index])


def _meant(key: str, kind: _Kind) -> str:
    if key in kind.others:
        instead = kind.others[key]
        return f": write {instead}" if instead.startswith("`") else f": {instead}"
    if key.startswith("-"):
        return f": write '- {key[1:]}', with a space"
    if near := nearest(key, kind.keys):
        return near
    owners = [each.title for each in _KINDS if each is not kind and key in each.keys]
    return f": it is said of {' or '.join(owners)}, not of {kind.title}" if owners else ""


def _named(key: str, value: Any, kind: _Kind) -> str:
    """Return a hint for a key that is like no other: perhaps it is a node's name, as in `- world: {...}`."""
    if kind is _NODE and (value is None or isinstance(value, dict)) and key:
        return f" in a node: write `node: {shown(key, 40)}`"
    if kind is _TOP and key in ("world", "walls", "robots"):
        return f" in {kind.title}: is this a world? robolink run world -p world:=FILE shows one"
    return f" in {kind.title}"
