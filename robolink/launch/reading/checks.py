"""Validation of single nodes and commands of a launch file, without a look at their code."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, get_args

from robolink.arguments.remapping import parse_remap_rule
from robolink.documents.yamlfile import spell
from robolink.launch.entry import Entry, Respawn, When
from robolink.launch.reading import limits
from robolink.launch.reading.description import NodeDescription
from robolink.launch.reading.section import Section
from robolink.launch.reading.substitution import Step
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name

_FOR_NODES = {
    "parameters": "give them to the program in `run`",
    "remappings": "give them to the program in `run`",
    "log_level": "give it to the program in `run`",
    "enclave": "give its program ROS_SECURITY_ENCLAVE_OVERRIDE by `env`",
    "process": "a command is a process of its own",
}


def check_node(section: Section, said: NodeDescription) -> None:
    """Raise `DocumentError` if the keys of a node or command are wrong or contradict each other."""
    if not said.node and not said.run:
        key = next((each for each in ("node", "run") if each in section), None)
        if key is None:
            raise section.error([], "missing key 'node' (or 'run', for a command)")
        example = "a node, such as `node: world`" if key == "node" else "a program, such as `run: [python, -V]`"
        raise section.error([key], f"nothing to start: name {example}")
    if said.node and said.run:
        raise section.error(["run"], "either `node` or `run`: a command is not a node", key=True)
    if said.run:
        for key, instead in _FOR_NODES.items():
            if key in section:
                raise section.error([key], f"only a node has `{key}`: {instead}", key=True)
    if said.name:
        section.check(validate_node_name, said.name, "name")
    for key, texts in (("args", said.args), ("run", said.run)):
        _check_texts(section, key, enumerate(texts))
    check_shared(section, said)


def check_shared(section: Section, said: Any) -> None:
    """Raise `DocumentError` for wrong keys of a node or a group: process, remappings, environment, respawn."""
    if said.process:
        section.check(_check_process_name, said.process, "process")
    if said.enclave:
        section.check(_check_enclave, said.enclave, "enclave")
    if len(said.remappings) > limits.MOST_REMAPPINGS:
        raise section.error(["remappings"], f"more than {limits.MOST_REMAPPINGS:,} remappings")
    for match, replacement in said.remappings.items():
        section.check(parse_remap_rule, f"{match}:={replacement}", "remappings", match, key=True)
    for name in said.env:
        if not name or "=" in name or "\0" in name:
            raise section.error(["env", name], f"'{name}' is not a name for a variable", key=True)
    _check_texts(section, "env", said.env.items())
    if isinstance(said.respawn, Respawn):
        _check_respawn(section, said.respawn)
    if said.cpu == []:
        raise section.error(["cpu"], "no core is left to run on: give one, or leave `cpu` out")


def check_words(section: Section) -> None:
    """Raise `DocumentError` for common type mistakes, with what to write instead."""
    if isinstance(named := section.get("node"), dict | list):
        kind = "mapping" if isinstance(named, dict) else "list"
        raise section.error(["node"], f"expected a node's name, such as `node: world`, got {kind}")
    for key in ("run", "args"):
        if isinstance(text := section.get(key), str):
            raise section.error([key], f"expected a list, such as [{', '.join(text.split())}]")
    for key, right in (("remappings", "{from: to}"), ("env", "{NAME: value}")):
        if isinstance(section.get(key), list):
            raise section.error([key], f"expected a mapping, such as {right}")
    _check_parameters(section)
    respawn, awaited = section.get("respawn"), section.get("start_after")
    if respawn is not None and not isinstance(respawn, str | dict):
        words = ", ".join(get_args(When))
        raise section.error(["respawn"], f"expected one of {words}, or a mapping with `when`, got '{spell(respawn)}'")
    for steps, each in _listed("start_after", awaited):
        if isinstance(each, int | float):
            reason = f"expected a node, {{topic: NAME}} or {{service: NAME}}, got '{spell(each)}'"
            raise section.error(steps, f"{reason}: nothing waits for a time")


def _check_parameters(section: Section) -> None:
    for steps, each in _listed("parameters", section.get("parameters", {})):
        if not isinstance(each, str | dict):
            found = "a list" if isinstance(each, list) else "nothing" if each is None else f"'{spell(each)}'"
            raise section.error(steps, f"expected parameters, as {{NAME: VALUE}}, or a parameter file, got {found}")


def _listed(key: str, data: Any) -> Iterator[tuple[tuple[Step, ...], Any]]:
    """Yield the item or items under a key, one value or a list, each with the steps to it."""
    if isinstance(data, list):
        yield from (((key, index), each) for index, each in enumerate(data))
    else:
        yield (key,), data


def check_terminal(entries: Iterable[Entry]) -> None:
    """Raise `DocumentError` if two entries want the keyboard, or one in a shared process does."""
    interactive = [each for each in entries if each.node.interactive]
    if len(interactive) > 1:
        raise interactive[1].error(["interactive"], f"there is one keyboard, and '{interactive[0].name}' has it")
    for each in interactive:
        if each.node.process:
            raise each.error(["interactive"], "a node with the keyboard cannot share a process: leave `process` out")


def _check_process_name(name: str) -> None:
    """Raise an error if this is no process name; it may have namespaces in front."""
    namespace, _, own = name.rpartition("/")
    validate_node_name(own)
    if namespace:
        validate_namespace(namespace if namespace.startswith("/") else f"/{namespace}")


def _check_enclave(name: str) -> None:
    """Raise an error if this is not a name of an enclave."""
    from robolink.security.keystore import checked_enclave  # few files name any

    checked_enclave(name)


def _check_texts(section: Section, key: str, texts: Iterable[tuple[Step, Any]]) -> None:
    for at, text in texts:
        if "\0" in str(text):
            raise section.error([key, at], "a zero byte ends a text: no program can be given one")


def _check_respawn(section: Section, respawn: Respawn) -> None:
    for key in ("delay", "delay_max", "within"):
        if not math.isfinite(getattr(respawn, key)):
            raise section.error(["respawn", key], f"expected seconds, got {getattr(respawn, key)}")
    if respawn.delay_max < respawn.delay:
        at = "delay_max" if "delay_max" in section.get("respawn") else "delay"
        default = "" if "delay_max" in section.get("respawn") else " if nothing is said: give that, too"
        reason = f"delay {respawn.delay} is more than delay_max, which is {respawn.delay_max}{default}"
        raise section.error(["respawn", at], reason)
