"""The seam between nodes and a network: bytes, keys and attachments, never a message class.

A transport may call a sink on any thread. A sink must only enqueue; whoever drains the queue turns what arrived
into bytes with `read` (samples, replies) or `accept` (queries), on its own thread and in its own time. That keeps
what Zenoh's threads do down to one C call.
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from robolink.exceptions import TransportError
from robolink.qos import QoSProfile

if TYPE_CHECKING:
    from robolink.transport.reach import Link

LARGEST_MESSAGE = 1 << 30
"""Bytes, with all that Zenoh adds: rmw_zenoh's limit. A session throws away, without a word, what is larger."""

LARGEST_PAYLOAD = LARGEST_MESSAGE - (1 << 16)
"""Bytes of one message, less what the network adds."""

Sink = Callable[[Any], object]
"""Called on any thread with something that `Transport.read` or `Transport.accept` understands. Must not block."""


class Sample(NamedTuple):
    """What was published, or replied."""

    payload: bytes
    attachment: bytes


make_sample: Callable[[tuple[bytes, bytes]], Sample] = functools.partial(tuple.__new__, Sample)
"""Half the time of Sample(), whose `__new__` is Python: for what is run once a message."""


def refuse_giant(key: str, payload: bytes) -> None:
    """Raise TransportError for a payload that every receiver would throw away without a word."""
    if len(payload) > LARGEST_PAYLOAD:
        raise TransportError(
            f"{key[:200]}: a message of {len(payload):,} bytes is larger than ROS 2's network carries"
            f" ({LARGEST_PAYLOAD:,}): send it in parts"
        )


class Handle(Protocol):
    """What a declaration gives back; after `close` returns, its sink is not called again."""

    def close(self) -> None:
        """Undeclare. Safe to call twice."""


class Outlet(Handle, Protocol):
    """A declared publisher."""

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send to every matching subscription.

        Raises TransportClosedError after close, TransportError for more than LARGEST_PAYLOAD bytes.
        """

    @property
    def matched(self) -> bool:
        """Whether anybody subscribes, here or elsewhere, as far as is known."""


class Query(Protocol):
    """A call that arrived at a server. It ends when it is closed, answered or not."""

    payload: bytes
    attachment: bytes

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Answer, from any thread. Nothing happens when the caller is gone."""

    def close(self) -> None:
        """Say that nothing more will come."""


class Transport(ABC):
    """One session on a network. Every method may be called from any thread."""

    url: str
    session_id: str
    """The session's id on the wire: lower-case hex, as Zenoh prints it."""
    threaded: bool
    """Whether sinks are called on threads of the transport's own (Zenoh), not only inside `put` (memory)."""

    @abstractmethod
    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher. With TRANSIENT_LOCAL it keeps the last `qos.depth` samples for late joiners."""

    @abstractmethod
    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`, this session's own included.

        With TRANSIENT_LOCAL the samples that publishers kept come first.
        """

    @abstractmethod
    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`; `accept` turns what it gets into a Query."""

    @abstractmethod
    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Ask whoever serves `key`. `sink` gets each reply, then None once: no more will come.

        There is no timeout here, since time belongs to clocks: whoever waits gives up by closing the handle, after
        which neither replies nor the end come. Closing the session ends its calls.
        """

    @abstractmethod
    def announce(self, token: str) -> Handle:
        """Show `token` to all who watch, until closed or until this process is gone."""

    @abstractmethod
    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches `pattern`, those already there first.

        This one is called on a thread of the transport's own and may do a little work. It may give False for a
        token that it has no use for: that one is not remembered, so that nonsense costs no memory, and may be told
        of again.
        """

    @abstractmethod
    def tokens(self, pattern: str) -> list[str]:
        """List the tokens that match `pattern` now, sorted: also those of peers that this session only just found.

        A session of long standing knows them all; one that has just been opened waits until nothing more comes
        (some 50 ms; half a second where a peer is frozen, 3 s at the most on a busy machine).
        Not from within `on_change` nor a sink.
        """

    def links(self) -> list[Link]:
        """List the connections to other sessions; a transport without a network has none."""
        return []

    @abstractmethod
    def read(self, arrived: Any) -> Sample:
        """Turn what a subscription's or a call's sink got into bytes. Raises TransportError on an error reply."""

    def size(self, arrived: Any) -> int:
        """Tell how many bytes the payload of what a subscription's sink got has, without copying them."""
        return len(self.read(arrived).payload)

    @abstractmethod
    def accept(self, arrived: Any) -> Query:
        """Turn what a server's sink got into a Query."""

    @abstractmethod
    def close(self) -> None:
        """Undeclare everything and leave the network, in well under 0.2 s. Safe to call twice."""
