"""Data model of a faults file: faults of messages, connections, nodes and clocks, and their times."""

from __future__ import annotations

from typing import Annotated, TypeAlias

import msgspec

from robolink.constants import MOST_SEED

MOST = 1e9
"""Upper bound of times in s, and of lengths of bursts in messages: about thirty years."""

MOST_DRIFT = 0.1
"""Upper bound of a clock's drift in s per s; a cheap crystal has 0.0001."""

Seed = Annotated[int, msgspec.Meta(ge=0, le=MOST_SEED)]
Share = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Seconds = Annotated[float, msgspec.Meta(ge=0.0, le=MOST)]
Names: TypeAlias = str | list[str]
"""One name or several; `*` stands for any letters of one token of a name, `**` for any number of tokens."""


class MessageFault(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Loss, delay or duplication of the messages of some topics, or of the calls of some services, between two nodes.

    `topic` or `service` name them, `from` (here `from_`) and `to` the nodes; without any of them all are meant. A
    call has two directions: its request goes from the client to the server, its response back. `loss` and
    `duplication` are probabilities from 0 to 1, `latency` and `jitter` seconds. With `burst`, losses come in runs of
    so many messages on average. Messages keep their order unless `reorder`. The fault holds from `after` until
    `until`, seconds of the run.
    """

    topic: Names = []
    service: Names = []
    from_: Names = msgspec.field(default_factory=list, name="from")
    to: Names = []
    loss: Share = 0.0
    burst: Annotated[float, msgspec.Meta(ge=1.0, le=MOST)] | None = None
    duplication: Share = 0.0
    latency: Seconds = 0.0
    jitter: Seconds = 0.0
    reorder: bool = False
    after: Seconds = 0.0
    until: Seconds | None = None


class Partition(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Partition of the network: nodes of different groups do not reach each other from `after` until `until`.

    The groups are `between`, lists of nodes; times are seconds of the run, and None is its end.

    A node belongs to the first group that names it; nodes that no group names reach everybody.
    """

    between: list[Names]
    after: Seconds = 0.0
    until: Seconds | None = None


class Crash(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Crash of `node`: its process is killed at `at` seconds of the run, and started again `restart_after` s later.

    Without `restart_after` the launch file's rules apply: `respawn` and `on_exit`.
    """

    node: str
    at: Seconds
    restart_after: Seconds | None = None


class ClockFault(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Wrong clock of `node`: `offset` seconds ahead (behind, if negative), and gaining `drift` seconds per second."""

    node: Names
    offset: Annotated[float, msgspec.Meta(ge=-MOST, le=MOST)] = 0.0
    drift: Annotated[float, msgspec.Meta(ge=-MOST_DRIFT, le=MOST_DRIFT)] = 0.0


class FaultsDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """All faults of a run.

    Args:
        description: Text for people.
        seed: Seed of their random numbers, unless the run itself is given one.
        messages: Losses, delays and duplications of messages.
        partitions: Partitions of the network.
        crashes: Crashes of nodes.
        clocks: Wrong clocks of nodes.
    """

    description: str = ""
    seed: Seed | None = None
    messages: list[MessageFault] = []
    partitions: list[Partition] = []
    crashes: list[Crash] = []
    clocks: list[ClockFault] = []
