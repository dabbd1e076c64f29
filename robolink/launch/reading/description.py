"""Schema of launch files, as Structs."""

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
