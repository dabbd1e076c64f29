"""Mistakes in single sections of a launch file: unknown keys, and nodes and groups that contradict themselves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple, get_args

import msgspec

from robolink.arguments.remapping import parse_remap_rule
from robolink.documents.mistakes import Step
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, NameValidationException, RobolinkError, nearest
from robolink.launch.entry import Respawn, When
from robolink.launch.reading.description import (
    GroupDescription,
    IncludeDescription,
    LaunchDescription,
    NodeDescription,
)
from robolink.launch.reading.document import LaunchFile
from robolink.launch.reading.section import Problem, not_boolean
from robolink.system.terminal import shown
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name

MOST_REMAPPINGS = 1_000
"""Most remappings of a node or a group."""

_FOR_NODES = {
    "parameters": "give them to the program in `run`",
    "remappings": "give them to the program in `run`",
    "log_level": "give it to the program in `run`",
    "enclave": "give its program ROS_SECURITY_ENCLAVE_OVERRIDE by `env`",
    "process": "a command is a process of its own",
}


# Before conversion: words that types would refuse less clearly


def wrong_words(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the common type mistakes in a node or a group, with what to write instead.

    Args:
        data: Its keys, substituted.
    """
    if isinstance(named := data.get("node"), dict | list):
        kind = "mapping" if isinstance(named, dict) else "list"
        yield Problem(("node",), f"expected a node's name, such as `node: world`, got {kind}")
    for key in ("run", "args"):
        if isinstance(text := data.get(key), str):
            yield Problem((key,), f"expected a list, such as [{', '.join(text.split())}]")
    for key, right in (("remappings", "{from: to}"), ("env", "{NAME: value}")):
        if isinstance(data.get(key), list):
            yield Problem((key,), f"expected a mapping, such as {right}")
    for steps, each in _listed("parameters", data.get("parameters", {})):
        if not isinstance(each, str | dict):
            yield Problem(steps, f"expected parameters, as {{NAME: VALUE}}, or a parameter file, got {_kind(each)}")
    respawn = data.get("respawn")
    if respawn is not None and not isinstance(respawn, str | dict):
        words = ", ".join(get_args(When))
        yield Problem(("respawn",), f"expected one of {words}, or a mapping with `when`, got '{spell(respawn)}'")
    yield from _times_to_wait(data)
    if "interactive" in data:
        yield from not_boolean("interactive", data["interactive"])


def _times_to_wait(data: Mapping[str, Any]) -> Iterator[Problem]:
    for steps, each in _listed("start_after", data.get("start_after")):
        if isinstance(each, int | float):
            reason = f"expected a node, {{topic: NAME}} or {{service: NAME}}, got '{spell(each)}'"
            yield Problem(steps, f"{reason}: nothing waits for a time")


def _kind(data: Any) -> str:
    return "a list" if isinstance(data, list) else "nothing" if data is None else f"'{spell(data)}'"


def _listed(key: str, data: Any) -> Iterator[tuple[tuple[Step, ...], Any]]:
    """Yield the item or items under a key, one value or a list, each with the steps to it."""
    if isinstance(data, list):
        yield from (((key, index), each) for index, each in enumerate(data))
    else:
        yield (key,), data


# After conversion


def wrong_in_node(node: NodeDescription, data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the mistakes in the keys of a node or command, also those that contradict each other.

    Args:
        node: The node.
        data: Its keys, substituted; those that were not given are not there.
    """
    if not node.node and not node.run:
        key = next((each for each in ("node", "run") if each in data), None)
        example = "a node, such as `node: world`" if key == "node" else "a program, such as `run: [python, -V]`"
        if key is None:
            yield Problem((), "missing key 'node' (or 'run', for a command)")
        else:
            yield Problem((key,), f"nothing to start: name {example}")
    if node.node and node.run:
        yield Problem(("run",), "either `node` or `run`: a command is not a node", is_key=True)
    for key, instead in _FOR_NODES.items() if node.run else ():
        if key in data:
            yield Problem((key,), f"only a node has `{key}`: {instead}", is_key=True)
    if node.name:
        yield from _refused(validate_node_name, node.name, "name")
    for key, texts in (("args", node.args), ("run", node.run)):
        yield from _unfit_texts(key, enumerate(texts))
    yield from wrong_in_both(node, data)


def wrong_in_both(described: NodeDescription | GroupDescription, data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the mistakes in the keys that nodes and groups have; the arguments are those of `wrong_in_node`."""
    if described.process:
        yield from _refused(_check_process_name, described.process, "process")
    if described.enclave:
        yield from _refused(_check_enclave, described.enclave, "enclave")
    if len(described.remappings) > MOST_REMAPPINGS:
        yield Problem(("remappings",), f"more than {MOST_REMAPPINGS:,} remappings")
    for match, replacement in described.remappings.items():
        yield from _refused(parse_remap_rule, f"{match}:={replacement}", "remappings", match, is_key=True)
    for name in described.env:
        if not name or "=" in name or "\0" in name:
            yield Problem(("env", name), f"'{name}' is not a name for a variable", is_key=True)
    yield from _unfit_texts("env", described.env.items())
    if isinstance(described.respawn, Respawn):
        yield from _wrong_respawn(described.respawn, data["respawn"])
    if described.cpu == []:
        yield Problem(("cpu",), "no core is left to run on: give one, or leave `cpu` out")
    yield from wrong_namespace(described.namespace)


def wrong_namespace(namespace: str) -> Iterator[Problem]:
    """Yield a problem if the namespace of a section is invalid."""
    if namespace:
        yield from _refused(validate_namespace, _absolute(namespace), "namespace")


def _absolute(namespace: str) -> str:
    return namespace if namespace.startswith("/") else f"/{namespace}"


def _refused(check: Callable[[str], object], text: str, *steps: Step, is_key: bool = False) -> Iterator[Problem]:
    """Yield the error of a check, if it raises one."""
    try:
        check(text)
    except NameValidationException as error:
        yield Problem(steps, f"'{shown(error.name)}' {error.error_msg}", is_key)
    except (RobolinkError, ValueError) as error:
        yield Problem(steps, str(error), is_key)


def _check_process_name(name: str) -> None:
    """Raise an error if this is not the name of a process; it may have namespaces in front."""
    namespace, _, own = name.rpartition("/")
    validate_node_name(own)
    if namespace:
        validate_namespace(_absolute(namespace))


def _check_enclave(name: str) -> None:
    """Raise an error if this is not the name of an enclave."""
    from robolink.security.keystore import checked_enclave  # few files name any

    checked_enclave(name)


def _unfit_texts(key: str, texts: Iterable[tuple[Step, Any]]) -> Iterator[Problem]:
    for at, text in texts:
        if "\0" in str(text):
            yield Problem((key, at), "a zero byte ends a text: no program can be given one")


def _wrong_respawn(respawn: Respawn, data: Mapping[str, Any]) -> Iterator[Problem]:
    for key in ("delay", "delay_max", "within"):
        if not math.isfinite(getattr(respawn, key)):
            yield Problem(("respawn", key), f"expected seconds, got {getattr(respawn, key)}")
    if respawn.delay_max < respawn.delay:
        at = "delay_max" if "delay_max" in data else "delay"
        default = "" if "delay_max" in data else " if nothing is said: give that, too"
        reason = f"delay {respawn.delay} is more than delay_max, which is {respawn.delay_max}{default}"
        yield Problem(("respawn", at), reason)


# Unknown keys


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
