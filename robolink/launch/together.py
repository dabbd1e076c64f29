"""How a process is told which nodes to run together: as JSON on its standard input.

A command line of Windows ends at 32,000 characters, which a hundred nodes with their parameters easily have, and one
node alone that gets a robot's description.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from robolink.exceptions import RobolinkError

COMMAND = "run-together"
"""What `robolink` is asked to do then; no command for people."""


class TogetherError(RobolinkError, ValueError):
    """What came on standard input is no list of nodes."""


class Member(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One of several nodes of a process: its name for people, what `find_node` finds, and its program's arguments."""

    name: str
    node: str
    args: list[str]


def written(members: Sequence[Member]) -> bytes:
    """Write what `read` reads."""
    return msgspec.json.encode(members)


def read(text: bytes) -> list[Member]:
    """Read what a launcher has written. Raises `TogetherError`."""
    try:
        return msgspec.json.decode(text, type=list[Member])
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise TogetherError(f"standard input: expected a list of nodes in JSON: {error}") from None
