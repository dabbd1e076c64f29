"""What a launch file may say."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

import msgspec

MOST_COPIES = 10_000

Count = Annotated[int, msgspec.Meta(ge=1, le=MOST_COPIES)]
Seconds = Annotated[float, msgspec.Meta(ge=0.0)]
Scalar: TypeAlias = str | int | float | bool
Core = Annotated[int, msgspec.Meta(ge=0)]
Condition: TypeAlias = bool | int | str
"""Whether something is wanted: true, yes, on and 1, or false, no, off and 0."""
When = Literal["never", "on_failure", "always"]
OnExit = Literal["shutdown", "ignore"]
LogLevel = Literal["debug", "info", "warn", "error", "fatal"]
Parameters: TypeAlias = dict[str, Any] | str | list[str | dict[str, Any]]
"""Parameters by name (nested ones are joined by dots), a parameter file, or several of these: the last word counts."""


class Respawn(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Whether a process that ends is started again.

    It waits `delay` seconds, twice as long each time, up to `delay_max`. After `most` starts `within` so many seconds
    it is given up, and its end counts as an end.
    """

    when: When = "on_failure"
    delay: Seconds = 1.0
    delay_max: Seconds = 30.0
    most: Annotated[int, msgspec.Meta(ge=1)] = 5
    within: Seconds = 60.0


class StartAfter(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What is waited for before a process is started: one of these.

    A node that is announced, by the name it has in this launch file or by its full name; a topic that somebody
    publishes; a service that somebody serves. Relative names are in the namespace of who waits.
    """

    node: str = ""
    topic: str = ""
    service: str = ""


class NodeDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One node or command of a system, or `count` copies of it, in a process of its own or with other nodes in one.

    `node` is a name, a file, FILE:function or FILE:Class, or a package and its executable; a relative file is one of
    the launch file's workspace. `run` stands in its place: a command and its arguments. `args` are the program's own
    arguments; these, `run` and `env` arrive letter by letter as they are written. An `interactive` node has the
    terminal's keyboard. All nodes that name the same `process` run there; its name is in the namespace of the groups
    and includes around, unless it begins with a slash. `cpu` says on which cores (from 0) it may run. With `count`,
    `{i}` in all that is said of it stands for 0, 1, 2 ... in turn.
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
    cpu: Core | list[Core] | None = None
    count: Count = 0  # not given
    nodes: list[NodeDescription] = []
    include: list[IncludeDescription] = []
    groups: list[GroupDescription] = []


class Argument(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Something that is asked for when the file is launched; without a default it must be given.

    What is given is read as YAML: `2` is a number. A default that is a text only by its quotes, such as "8080", makes
    what is given a text, and one of true or false makes `on` and `no` these.
    """

    default: Any = msgspec.UNSET  # so that null, too, is one
    description: str = ""
    choices: list[Scalar] = []


class LaunchDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A system: the nodes to start, with `{name}` for each of its `arguments`.

    An argument is a default value, nothing where it must be given, or a mapping with `default`, `description` and
    `choices`. `{here}` is the launch file's folder, and `{env:NAME}` a variable of the environment.
    """

    description: str = ""
    arguments: dict[str, Argument | Scalar | list[Any] | None] = {}
    nodes: list[NodeDescription] = []
    include: list[IncludeDescription] = []
    groups: list[GroupDescription] = []
