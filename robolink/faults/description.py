"""What a faults file may say: what happens to messages, to connections, to nodes and to clocks, and when."""

from __future__ import annotations

from typing import Annotated, TypeAlias

import msgspec

MOST = 1e9
"""Of seconds, and of messages: thirty years."""

MOST_DRIFT = 0.1
"""Of a clock, in seconds per second; a cheap crystal has 0.0001."""

MOST_SEED = 2**32 - 1
"""What numpy's own generator takes."""

Seed = Annotated[int, msgspec.Meta(ge=0, le=MOST_SEED)]
Share = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Seconds = Annotated[float, msgspec.Meta(ge=0.0, le=MOST)]
Names: TypeAlias = str | list[str]
"""One name or several; `*` stands for any letters of one token of a name, `**` for any number of tokens."""


class MessageFault(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What happens to the messages of some topics, or to the calls of some services, on the way between two nodes.

    `topic` or `service` say which, `from` and `to` between which nodes; all of them where nothing is said. A call has
    two ways: its request goes from the client to the server, its answer back. `loss` and `duplication` are shares of
    all messages, `latency` and `jitter` seconds. With `burst`, losses come in runs of so many messages on average.
    Messages keep their order unless `reorder` says otherwise. It holds from `after` until `until`, seconds of the run.
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
    """A network that falls apart: nodes of different groups do not reach each other from `after` until `until`.

    A node belongs to the first group that names it; nodes that no group names reach everybody.
    """

    between: list[Names]
    after: Seconds = 0.0
    until: Seconds | None = None


class Crash(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A node's process is killed `at` so many seconds, and started again `restart_after` so many more.

    Without `restart_after` it is the launch file that says what follows: `respawn` and `on_exit`.
    """

    node: str
    at: Seconds
    restart_after: Seconds | None = None


class ClockFault(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A node's clock: ahead by `offset` seconds (behind, if negative), and gaining `drift` seconds per second."""

    node: Names
    offset: Annotated[float, msgspec.Meta(ge=-MOST, le=MOST)] = 0.0
    drift: Annotated[float, msgspec.Meta(ge=-MOST_DRIFT, le=MOST_DRIFT)] = 0.0


class FaultsDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """All that goes wrong in a run, and the seed from which it is drawn."""

    description: str = ""
    seed: Seed | None = None
    messages: list[MessageFault] = []
    partitions: list[Partition] = []
    crashes: list[Crash] = []
    clocks: list[ClockFault] = []
