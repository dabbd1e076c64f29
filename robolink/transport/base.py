"""Transport interface between nodes and a network: bytes, keys and attachments, never a message class.

A transport may call a sink on any thread. A sink must only enqueue; the consumer of the queue converts items to
bytes with `read` (samples, replies) or `accept` (queries), on its own thread and in its own time. That keeps
the work of Zenoh's threads down to one C call.
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from collections.abc import Callable, Sized
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from robolink.constants import LARGEST_MESSAGE
from robolink.exceptions import TransportError
from robolink.qos import QoSProfile

if TYPE_CHECKING:
    from robolink.transport.reach import Link

LARGEST_PAYLOAD = LARGEST_MESSAGE - (1 << 16)
"""Largest payload of one message, in bytes: without the network's overhead."""

Sink = Callable[[Any], object]
"""Callback that is called on any thread with an item for `Transport.read` or `Transport.accept`. Must not block."""


class Sample(NamedTuple):
    """A published payload, or a reply, with its attachment."""

    payload: bytes
    attachment: bytes


make_sample: Callable[[tuple[bytes, bytes]], Sample] = functools.partial(tuple.__new__, Sample)
"""Fast constructor of Sample, in half the time of Sample(), whose `__new__` is Python: for once a message."""


def refuse_giant(key: str, payload: Sized) -> None:
    """Raise TransportError for a payload that every receiver would silently drop."""
    if len(payload) > LARGEST_PAYLOAD:
        raise TransportError(
            f"{key[:200]}: a message of {len(payload):,} bytes is larger than ROS 2's network carries"
            f" ({LARGEST_PAYLOAD:,}): send it in parts"
        )


class Handle(Protocol):
    """Handle of a declaration; after `close` returns, its sink is not called again."""

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
        """True if a subscription is known, here or elsewhere."""


class NumberingOutlet(Outlet, Protocol):
    """Outlet with a lock of its own, under which a message is numbered too: its publisher needs no second one."""

    def put_numbered(self, payload: bytes, attachment: Callable[[], bytes]) -> bytes:
        """Send as `put` does, with the attachment that `attachment()` makes under the lock; return that."""


class Query(Protocol):
    """A request that arrived at a server. It ends when it is closed, answered or not."""

    payload: bytes
    attachment: bytes

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Send a reply, from any thread. Does nothing when the caller is gone."""

    def close(self) -> None:
        """Finish the call: no more replies will come."""


class Transport(ABC):
    """One session on a network. All methods are thread-safe."""

    url: str
    session_id: str
    """Id of the session on the wire: lower-case hex, as Zenoh prints it."""
    threaded: bool
    """True if sinks are called on threads of the transport's own (Zenoh), not only inside `put` (memory)."""
    enclave: str = ""
    """Enclave whose keys and rights it has; "" where there is no security."""

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
        """Send a request to all servers of `key`. `sink` gets each reply, then None once as the end.

        There is no timeout here, since time belongs to clocks: the caller gives up by closing the handle, after
        which neither replies nor the end come. Closing the session ends its calls.
        """

    @abstractmethod
    def announce(self, token: str) -> Handle:
        """Declare a liveliness token, visible to all watches until it is closed or this process is gone."""

    @abstractmethod
    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches `pattern`, those already there first.

        It is called on a thread of the transport's own and may do a little work. It may return False for a token
        that it has no use for: that one is not remembered, so that nonsense costs no memory, and may be reported
        again.
        """

    @abstractmethod
    def tokens(self, pattern: str) -> list[str]:
        """Return the tokens that match `pattern` now, sorted: also those of peers that this session only just found.

        A session that has been open for a while knows them all; a new one waits until nothing more comes
        (some 50 ms; half a second where a peer is frozen, 3 s at most on a busy machine).
        Must not be called from within `on_change` or a sink.
        """

    def links(self) -> list[Link]:
        """Return the connections to other sessions; a transport without a network has none."""
        return []

    @abstractmethod
    def read(self, arrived: Any) -> Sample:
        """Convert an item of a subscription's or a call's sink to bytes.

        Raises TransportError on an error reply, OverwrittenError for a message that its sender has overwritten.
        """

    def opener(self, check: Callable[[bytes], object], decode: Callable[[bytes], Any]) -> Callable[[Any], Any]:
        """Return a function that does all of this to an item of a subscription's sink: `read`, `check`, `decode`.

        Args:
            check: Function of the attachment, which raises an error for one that is wrong.
            decode: Function of the payload, whose result is returned.
        """
        read = self.read

        def opened(arrived: Any) -> Any:
            payload, attachment = read(arrived)
            check(attachment)
            return decode(payload)

        return opened

    def size(self, arrived: Any) -> int:
        """Return the payload size, in bytes, of an item of a subscription's sink, without copying it."""
        return len(self.read(arrived).payload)

    def attachment(self, arrived: Any) -> bytes:
        """Return the attachment of an item of a subscription's sink, without copying the payload."""
        return self.read(arrived).attachment

    @abstractmethod
    def accept(self, arrived: Any) -> Query:
        """Convert an item of a server's sink to a Query. Raises OverwrittenError, and ends the call, as `read` does."""

    @abstractmethod
    def close(self) -> None:
        """Undeclare everything and leave the network, in well under 0.2 s. Safe to call twice."""
