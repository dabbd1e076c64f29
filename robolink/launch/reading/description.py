"""Format of launch files: its Structs, and the JSON schema by which editors complete and check them."""

from __future__ import annotations

from typing import Annotated, Any, TypeAlias

import msgspec

from robolink.launch.entry import LogLevel, OnExit, Respawn, StartAfter, When
from robolink.networks.limits import Limits

MOST_COPIES = 10_000

Count = Annotated[int, msgspec.Meta(ge=1, le=MOST_COPIES)]
Scalar: TypeAlias = str | int | float | bool
Core = Annotated[int, msgspec.Meta(ge=0)]
Condition: TypeAlias = bool | int | str
"""Type of a condition: true, yes, on and 1, or false, no, off and 0."""
Parameters: TypeAlias = dict[str, Any] | str | list[str | dict[str, Any]]
"""Type of `parameters`: values by name (nested names are joined by dots), a parameter file, or a list of these, of
which the later ones win."""


class NodeDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One node or command of a system, or `count` copies of it, in its own process or in one shared with other nodes.

    `node` is a name, a file, FILE:function or FILE:Class, or a package and its executable; a relative file is one of
    the launch file's workspace. `run` stands in its place: a command and its arguments. `args` are the program's own
    arguments; these, `run` and `env` arrive letter by letter as they are written. An `interactive` node has the
    terminal's keyboard. All nodes that name the same `process` run there; its name is in the namespace of the groups
    and includes around, unless it begins with a slash. `cpu` says on which cores (from 0) it may run. With `count`,
    `{i}` in all that is said of it stands for 0, 1, 2 ... in turn.

    `name` and `namespace` are those of its ROS node, the program's own if empty; `parameters`, `remappings`,
    `log_level` and `enclave`, whose keys and rights it has, are given to it. It is left out unless `if_` is true and
    `unless` is false. It starts once all that `start_after` names is there. `respawn` says when it is started again,
    `on_exit` what its end means for the system; None leaves these two, `log_level` and `cpu` to the groups around it.
    """

    node: str = ""
    run: list[Scalar] = []
    name: str = ""
    namespace: str = ""
    parameters: Parameters = {}
    remappings: dict[str, str] = {}
    args: list[Scalar] = []
    env: dict[str, Scalar] = {}
    if_: Condition = msgspec.field(default=True, name="if")
    unless: Condition = False
    interactive: Condition = False
    count: Count = 0  # not given: the file itself cannot say 0
    process: str = ""
    start_after: str | StartAfter | list[str | StartAfter] = []
    respawn: When | Respawn | None = None
    on_exit: OnExit | None = None
    log_level: LogLevel | None = None
    enclave: str = ""
    cpu: Core | list[Core] | None = None


class IncludeDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Another launch file, by name or path (a relative one from this file's folder), with a namespace in front.

    With `count` it is included as often, and `{i}` stands for 0, 1, 2 ... in what is said here.
    """

    file: str
    namespace: str = ""
    arguments: dict[str, Any] = {}
    if_: Condition = msgspec.field(default=True, name="if")
    unless: Condition = False
    count: Count = 0  # not given


class GroupDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Nodes, includes and groups that have something in common: what each of them says itself counts more.

    Namespaces are joined, and all that `start_after` names is waited for. With `count` the group is there as often,
    and `{i}` stands for 0, 1, 2 ... in all that it holds. Commands take of it what is not for nodes only.
    """

    namespace: str = ""
    parameters: Parameters = {}
    remappings: dict[str, str] = {}
    env: dict[str, Scalar] = {}
    if_: Condition = msgspec.field(default=True, name="if")
    unless: Condition = False
    process: str = ""
    start_after: str | StartAfter | list[str | StartAfter] = []
    respawn: When | Respawn | None = None
    on_exit: OnExit | None = None
    log_level: LogLevel | None = None
    enclave: str = ""
    cpu: Core | list[Core] | None = None
    count: Count = 0  # not given
    nodes: list[NodeDescription] = []
    include: list[IncludeDescription] = []
    groups: list[GroupDescription] = []


class Argument(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Declaration of a launch argument; without a default its value is required.

    A given value is read as YAML: `2` is a number. If the default is a text only by its quotes, such as "8080", the
    value stays a text; if the default is a boolean, `on` and `no` are booleans too.
    """

    default: Any = msgspec.UNSET  # so that null, too, is one
    description: str = ""
    choices: list[Scalar] = []


class LaunchDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A system: the nodes to start, with `{name}` for each of its `arguments`.

    An argument is a default value, nothing where it must be given, or a mapping with `default`, `description` and
    `choices`. `{here}` is the launch file's folder, and `{env:NAME}` a variable of the environment. What is started are
    the `nodes`, those of the launch files in `include`, and those in `groups`. All of them are on one `network`, as
    the command line names it, unless that or ROBOLINK_NETWORK names another; `limits` thin the topics that leave this
    machine. `record` asks for a bag of all that is published: its folder, or true for one with the date in its name;
    included files are not asked.
    """

    description: str = ""
    network: str = ""
    limits: Limits | None = None
    record: bool | str | None = None
    arguments: dict[str, Argument | Scalar | list[Any] | None] = {}
    nodes: list[NodeDescription] = []
    include: list[IncludeDescription] = []
    groups: list[GroupDescription] = []


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
    """Return the JSON schema of launch files. Where it has a number, a text with an argument is valid too."""
    from robolink.documents.json_schema import schema_of  # only `--schema` needs it

    schema = schema_of(LaunchDescription, "A launch file of robolink", MEANINGS)
    default = {"description": "Value unless another is given; without it one must be given."}
    schema["definitions"]["Argument"]["properties"]["default"] = default
    for part in (schema, *schema["definitions"].values()):
        properties = part.get("properties", {})
        for key, value in properties.items():
            properties[key] = _or_substitution(value)
    return schema


def _or_substitution(value: dict[str, Any]) -> dict[str, Any]:
    holds_texts = value.get("type") in ("string", "array", "object") and "enum" not in value
    if holds_texts or not {"type", "enum", "anyOf"} & set(value):
        return value
    beside = {key: each for key, each in value.items() if key in ("description", "default")}
    inner = {key: each for key, each in value.items() if key not in beside}
    return {**beside, "anyOf": [*inner.pop("anyOf", [inner] if inner else []), SUBSTITUTION]}
