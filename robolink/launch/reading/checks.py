"""What is wrong with the nodes and commands of a launch file, as far as that shows without looking at their code."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, get_args

from robolink.launch.reading import limits
from robolink.launch.reading.description import NodeDescription, Respawn, When
from robolink.launch.reading.entry import Entry
from robolink.launch.reading.part import Part
from robolink.launch.reading.substitution import Step
from robolink.remapping import parse_remap_rule
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.yamlfile import spell

_FOR_NODES = {
    "parameters": "give them to the program in `run`",
    "remappings": "give them to the program in `run`",
    "log_level": "give it to the program in `run`",
    "process": "a command is a process of its own",
}


def check_node(part: Part, said: NodeDescription) -> None:
    """Check what a node or command says of itself. Raises `DocumentError`."""
    if not said.node and not said.run:
        key = next((each for each in ("node", "run") if each in part), None)
        if key is None:
            raise part.error([], "missing key 'node' (or 'run', for a command)")
        example = "a node, such as `node: world`" if key == "node" else "a program, such as `run: [python, -V]`"
        raise part.error([key], f"nothing to start: name {example}")
    if said.node and said.run:
        raise part.error(["run"], "either `node` or `run`: a command is no node", key=True)
    if said.run:
        for key, instead in _FOR_NODES.items():
            if key in part:
                raise part.error([key], f"only a node has `{key}`: {instead}", key=True)
    if said.name:
        part.check(validate_node_name, said.name, "name")
    for key, texts in (("args", said.args), ("run", said.run)):
        _check_texts(part, key, enumerate(texts))
    check_shared(part, said)


def check_shared(part: Part, said: Any) -> None:
    """Check what a node or a group says: process, remappings, environment and respawn. Raises `DocumentError`."""
    if said.process:
        part.check(_check_process_name, said.process, "process")
    if len(said.remappings) > limits.MOST_REMAPPINGS:
        raise part.error(["remappings"], f"more than {limits.MOST_REMAPPINGS:,} remappings")
    for match, replacement in said.remappings.items():
        part.check(parse_remap_rule, f"{match}:={replacement}", "remappings", match, key=True)
    for name in said.env:
        if not name or "=" in name or "\0" in name:
            raise part.error(["env", name], f"'{name}' is no name for a variable", key=True)
    _check_texts(part, "env", said.env.items())
    if isinstance(said.respawn, Respawn):
        _check_respawn(part, said.respawn)
    if said.cpu == []:
        raise part.error(["cpu"], "no core is left to run on: give one, or leave `cpu` out")


def check_words(part: Part) -> None:
    """Refuse what would be called a wrong type, and say what to write instead. Raises `DocumentError`."""
    if isinstance(named := part.get("node"), dict | list):
        kind = "mapping" if isinstance(named, dict) else "list"
        raise part.error(["node"], f"expected a node's name, such as `node: world`, got {kind}")
    for key in ("run", "args"):
        if isinstance(text := part.get(key), str):
            raise part.error([key], f"expected a list, such as [{', '.join(text.split())}]")
    for key, right in (("remappings", "{from: to}"), ("env", "{NAME: value}")):
        if isinstance(part.get(key), list):
            raise part.error([key], f"expected a mapping, such as {right}")
    _check_parameters(part)
    respawn, awaited = part.get("respawn"), part.get("start_after")
    if respawn is not None and not isinstance(respawn, str | dict):
        words = ", ".join(get_args(When))
        raise part.error(["respawn"], f"expected one of {words}, or a mapping with `when`, got '{spell(respawn)}'")
    for steps, each in _listed("start_after", awaited):
        if isinstance(each, int | float):
            reason = f"expected a node, {{topic: NAME}} or {{service: NAME}}, got '{spell(each)}'"
            raise part.error(steps, f"{reason}: nothing waits for a time")


def _check_parameters(part: Part) -> None:
    for steps, each in _listed("parameters", part.get("parameters", {})):
        if not isinstance(each, str | dict):
            found = "a list" if isinstance(each, list) else "nothing" if each is None else f"'{spell(each)}'"
            raise part.error(steps, f"expected parameters, as {{NAME: VALUE}}, or a parameter file, got {found}")


def _listed(key: str, data: Any) -> Iterator[tuple[tuple[Step, ...], Any]]:
    """Yield what is said under a key, be it one thing or a list, with the steps to each."""
    if isinstance(data, list):
        yield from (((key, index), each) for index, each in enumerate(data))
    else:
        yield (key,), data


def check_terminal(entries: Iterable[Entry]) -> None:
    """Check who has the keyboard. Raises `DocumentError`."""
    interactive = [each for each in entries if each.node.interactive]
    if len(interactive) > 1:
        raise interactive[1].error(["interactive"], f"there is one keyboard, and '{interactive[0].name}' has it")
    for each in interactive:
        if each.node.process:
            raise each.error(["interactive"], "a node with the keyboard cannot share a process: leave `process` out")


def _check_process_name(name: str) -> None:
    """Check a name, which may have namespaces in front."""
    namespace, _, own = name.rpartition("/")
    validate_node_name(own)
    if namespace:
        validate_namespace(namespace if namespace.startswith("/") else f"/{namespace}")


def _check_texts(part: Part, key: str, texts: Iterable[tuple[Step, Any]]) -> None:
    for at, text in texts:
        if "\0" in str(text):
            raise part.error([key, at], "a zero byte ends a text: no program can be given one")


def _check_respawn(part: Part, respawn: Respawn) -> None:
    for key in ("delay", "delay_max", "within"):
        if not math.isfinite(getattr(respawn, key)):
            raise part.error(["respawn", key], f"expected seconds, got {getattr(respawn, key)}")
    if respawn.delay_max < respawn.delay:
        at = "delay_max" if "delay_max" in part.get("respawn") else "delay"
        default = "" if "delay_max" in part.get("respawn") else " if nothing is said: give that, too"
        reason = f"delay {respawn.delay} is more than delay_max, which is {respawn.delay_max}{default}"
        raise part.error(["respawn", at], reason)
