"""Protocol of a shared process: the launcher writes the nodes to run together as JSON to its standard input.

A command line of Windows ends at 32,000 characters, which a hundred nodes with their parameters easily have, and one
node alone that gets a robot's description.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from robolink.exceptions import RobolinkError

COMMAND = "run-together"
"""Hidden sub-command of `robolink` that reads it; not for people."""


class TogetherError(RobolinkError, ValueError):
    """Standard input is not a list of nodes."""


class Member(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A node of a process: its name for people, its `find_node` spec, and its program's arguments."""

    name: str
    node: str
    args: list[str]


def written(members: Sequence[Member]) -> bytes:
    """Encode members as `read` parses them."""
    return msgspec.json.encode(members)


def read(text: bytes) -> list[Member]:
    """Parse the members that a launcher has written; raises `TogetherError` for anything else."""
    try:
        return msgspec.json.decode(text, type=list[Member])
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise TogetherError(f"standard input: expected a list of nodes in JSON: {error}") from None
