"""JSON schema of launch files, by which editors complete and check them."""

from __future__ import annotations

from typing import Any

from robolink.documents.json_schema import schema_of
from robolink.launch.reading.description import LaunchDescription

MEANINGS = {
    "LaunchDescription.description": "What the system is for, in one line.",
    "LaunchDescription.network": "Network: localhost, lan, HOST[:PORT], or a name of networks.yaml.",
    "LaunchDescription.limits": "Limits of what leaves this machine.",
    "LaunchDescription.record": "Bag of all that is published: its folder, or true for one with the date in its name.",
    "LaunchDescription.arguments": "Arguments by name: a default, nothing where a value must be given, or a mapping.",
    "Argument.description": "What the argument is for.",
    "Argument.choices": "Values that may be given.",
    "IncludeDescription.file": "Another launch file, by name or path.",
    "IncludeDescription.namespace": "Namespace in front of all that is included.",
    "IncludeDescription.arguments": "Values of the other file's arguments.",
    "GroupDescription.namespace": "Namespace in front of all names in the group.",
    "Limits.control": "Topics and services that go before all that waits.",
    "Limits.rate": "Most messages a second, by full name of the topic.",
    "Limits.size": "Largest message in bytes, by full name of the topic; larger ones are not sent.",
    "Limits.interfaces": "Network interfaces to which all this applies; all but loopback by default.",
    "Limits.buffer": "Buffer of each link in bytes; 0: the system's own choice.",
    "NodeDescription.node": "Node: a name, a file, FILE:Class, FILE:function, or a package and its executable.",
    "NodeDescription.run": "Command with its arguments, in the place of a node.",
    "NodeDescription.name": "Name of the ROS node; the program's own by default.",
    "NodeDescription.namespace": "Namespace of the ROS node.",
    "NodeDescription.args": "The program's own arguments.",
    "NodeDescription.interactive": "True: it has the terminal's keyboard.",
    "Respawn.when": "When it is started again.",
    "Respawn.delay": "Seconds before the first restart; twice as long each time.",
    "Respawn.delay_max": "Longest wait in seconds.",
    "Respawn.most": "Starts after which the process is given up.",
    "Respawn.within": "Seconds in which `most` starts count.",
    "StartAfter.node": "Node that must be announced: its name in this file, or its full name.",
    "StartAfter.topic": "Topic that somebody must publish.",
    "StartAfter.service": "Service that somebody must serve.",
    "count": "Number of copies; {i} stands for 0, 1, 2 ... in each.",
    "cpu": "Core, from 0, or cores on which it may run.",
    "enclave": "Enclave whose keys and rights it has.",
    "env": "Variables of the environment.",
    "groups": "Groups of nodes that have something in common.",
    "if": "Left out unless this is true.",
    "include": "Other launch files.",
    "log_level": "Least level that is logged.",
    "nodes": "What is started: nodes and commands.",
    "on_exit": "What its end means for the system: shutdown ends all.",
    "parameters": "Parameters by name, a parameter file, or a list of these, of which later ones win.",
    "process": "Name of a process: all that name it run there.",
    "remappings": "Other names for its topics and services: FROM: TO.",
    "respawn": "When it is started again: always, on_failure, never, or a mapping.",
    "start_after": "What must be there before it starts: the name of a node, or a mapping.",
    "unless": "Left out if this is true.",
}
"""Descriptions of keys, which editors show: by Struct and key, or by a key that means the same everywhere."""

SUBSTITUTION = {"type": "string", "pattern": "[{].*[}]"}
"""Schema of a text with an argument in it, which may stand for any value: `"{speed}"`."""


def launch_schema() -> dict[str, Any]:
    """Return the schema as plain data. Where a number or a choice is wanted, a text with an argument is right, too."""
    schema = schema_of(LaunchDescription, "A launch file of robolink", MEANINGS)
    default = {"description": "Value unless another is given; without it one must be given."}
    schema["definitions"]["Argument"]["properties"]["default"] = default
    for part in (schema, *schema["definitions"].values()):
        properties = part.get("properties", {})
        for key, value in properties.items():
            properties[key] = _or_substitution(value)
    return schema


def _or_substitution(value: dict[str, Any]) -> dict[str, Any]:
    if value.get("type") in ("string", "array", "object") and "enum" not in value:
        return value
    if not {"type", "enum", "anyOf"} & set(value):
        return value
    kept = {key: each for key, each in value.items() if key in ("description", "default")}
    inner = {key: each for key, each in value.items() if key not in kept}
    return {**kept, "anyOf": [*inner.pop("anyOf", [inner] if inner else []), SUBSTITUTION]}
