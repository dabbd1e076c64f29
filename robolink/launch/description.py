"""What a launch file may say."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

MOST_COPIES = 10_000

Count = Annotated[int, msgspec.Meta(ge=1, le=MOST_COPIES)]


class NodeDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One node of a system, or `count` copies of it, in a process of its own or together with others in one.

    `node` is a name, a file or FILE:function; a relative file is one of the launch file's workspace. `args` are the
    program's own arguments. An `interactive` node has the terminal's keyboard. All nodes that name the same `process`
    run there. With `count`, `{i}` in all that is said of the node but `node` stands for 0, 1, 2 ... in turn.
    """

    node: str
    name: str = ""
    namespace: str = ""
    parameters: dict[str, Any] = {}
    remappings: dict[str, str] = {}
    args: list[str | int | float] = []
    interactive: bool = False
    count: Count = 0  # not given: the file itself cannot say 0
    process: str = ""


class LaunchDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A system: the nodes to start."""

    nodes: list[NodeDescription]
