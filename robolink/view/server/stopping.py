"""STOP for clients: the lock on /e_stop as the server keeps it, who obeys it, and zeros for those who do not listen."""

from __future__ import annotations

import asyncio
import contextlib
import re
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from robolink.control.stop_lock import AGAIN, PLAIN, QOS, TOPIC, TYPE, Lock
from robolink.exceptions import RobolinkError, SecurityError
from robolink.graph.endpoint import keys_of, listen
from robolink.interfaces import find
from robolink.interfaces.std_msgs.msg import Bool
from robolink.logging import get_logger
from robolink.message import decode, type_hash
from robolink.publisher import Publisher
from robolink.system import clocks
from robolink.transport.base import Handle
from robolink.view.protocol import answers
from robolink.view.sources.live import LiveSource
from robolink.wire import NO_HASH, EndpointKind, EndpointToken, unpack_attachment

DRIVEN = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
"""Types of messages that set robots in motion."""

COMMAND = re.compile(r"(^|/|_)cmd_vel($|/|_)")
"""Names of topics of commands."""

PERIOD = 0.05
"""Period of zeros, in seconds."""

FIRST = 1.0
"""Time in seconds in which robots get zeros whether they listen to the lock or not, if they are FEW; and in which a
release is said to who comes just then.
"""


FEW = 10
"""Most topics of commands with which those who listen get zeros as well: a fleet would be kept busy by them."""

AT_ONCE = 0.01
"""Time in seconds after which further topics get their first zeros with the next ones: 100 publishers take 0.1 s."""


class Drives(NamedTuple):
    """Nodes and topics that set robots in motion, as the graph has them."""

    obeyed: list[str]
    """Nodes that listen to the lock."""
    unheard: dict[str, list[str]]
    """Topics of commands on which somebody may drive while it holds, with the nodes that move and do not listen."""
    deaf: dict[str, str]
    """Topics of commands with a node that moves and does not listen, also behind a mux that does, with their types."""
    all_of_them: dict[str, str]
    """All topics of commands, with their types."""


def drives_of(ends: Iterable[EndpointToken]) -> Drives:
    """Return the nodes that obey the lock, and those that do not, of these ends; hidden nodes are not robots."""
    every = list(ends)
    subscriptions = [each for each in every if each.kind is EndpointKind.SUBSCRIPTION and not _is_hidden(each)]
    obeyed = {each.full_node_name for each in subscriptions if each.name == TOPIC and each.type_name == TYPE}
    movers: dict[str, set[str]] = {}
    types: dict[str, str] = {}
    for each in subscriptions:
        if each.type_name in DRIVEN and COMMAND.search(each.name):
            movers.setdefault(each.name, set()).add(each.full_node_name)
            types.setdefault(each.name, each.type_name)
    publishers = [each for each in every if each.kind is EndpointKind.PUBLISHER]
    views = {each.full_node_name for each in publishers if each.name == TOPIC and _is_hidden(each)}
    senders: dict[str, set[str]] = {}
    for each in publishers:  # also a command's, which drives; a view's sends zeros, and no more while it holds
        if each.name in movers and each.full_node_name not in views:
            senders.setdefault(each.name, set()).add(each.full_node_name)
    unheard: dict[str, list[str]] = {}
    for topic, nodes in sorted(movers.items()):
        behind_a_mux = topic in senders and senders[topic] <= obeyed
        if nodes - obeyed and not behind_a_mux:
            unheard[topic] = sorted(nodes - obeyed)
    deaf = {topic: types[topic] for topic, nodes in movers.items() if nodes - obeyed}
    return Drives(sorted(obeyed), unheard, deaf, types)


def _is_hidden(end: EndpointToken) -> bool:
    return end.node_name.startswith("_")


class Stopping:
    """The lock as the server keeps it. All is called on the server's loop.

    When the server ends, nothing is released: robots that obey the lock keep it themselves.

    Args:
        system: System that it holds.
        tell: Function that sends a text to all pages.
        keeps: False only looks: for a server on which nobody may change anything.
    """

    def __init__(self, system: LiveSource, tell: Callable[[str], None], *, keeps: bool = True) -> None:
        self._system, self._tell, self._keeps = system, tell, keeps
        self._lock = Lock(system.node, self._on_change, keeps=keeps)
        self._drives = drives_of(())
        self._known: set[bytes] = set()
        self._sent = ""
        self._zeros: dict[str, tuple[Publisher[Any], type[Any]]] = {}
        self._now = self._changed_at = self._zeros_due = self._again_due = 0.0
        self._listening: list[Handle] = []
        self._arrived: deque[Any] = deque()
        self._soon = False
        system.followers.append(self._look)

    @property
    def held(self) -> bool:
        """True while STOP holds."""
        return self._lock.held

    def begin(self) -> None:
        """Begin to listen, in a running loop."""
        self._loop = asyncio.get_running_loop()
        context = self._system.context
        hash_ = NO_HASH if context.speaks_humble else type_hash(Bool)
        somebody = EndpointToken(
            context.get_domain_id(), "", "", "", EndpointKind.PUBLISHER, "", "", "", TOPIC, TYPE, hash_, QOS
        )
        try:
            for qos in (QOS, PLAIN):
                self._listening += listen(self._system.node._owner_, somebody, keys_of(somebody), qos, self._on_arrival)
        except SecurityError as error:
            get_logger("robolink.view").error(f"STOP of others is not heard here: {error}")

    def set(self, held: bool) -> None:
        """Press or release it, for a client.

        Raises:
            RobolinkError: if this node may not say so; of a press robots get zeros at least.
        """
        try:
            if held:
                self._lock.press()
            else:
                self._lock.release()
        except RobolinkError:
            if held:
                with contextlib.suppress(RobolinkError):
                    self._send_zeros(all_of_them=True)  # those that obey hear nothing of it either
                self._changed_at = clocks.monotonic()
            raise
        self._sent = ""  # also what has not changed: who pressed waits for it
        self._publish_state()

    def state(self) -> str:
        """Return the operation `stop`, as pages get it."""
        return answers.text("stop", held=self.held, obeyed=self._drives.obeyed, unheard=self._drives.unheard)

    def tick(self, now: float) -> None:
        """Send zeros that are due, and what else the time asks for; `now` in seconds."""
        self._now = now
        if self.held:
            if now >= self._zeros_due:
                self._zeros_due = now + PERIOD
                self._send_zeros()
            if now >= self._again_due:
                self._again_due = float("inf")
                self._lock.repeat()
        elif now >= self._changed_at + FIRST:
            self._lock.withdraw()
            self._end_zeros(())

    def close(self) -> None:
        """Listen no longer."""
        for each in self._listening:
            each.close()
        self._listening.clear()

    def _on_arrival(self, arrived: Any) -> None:
        """Note what came, on any thread."""
        self._arrived.append(arrived)
        if not self._soon:
            self._soon = True
            with contextlib.suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self._take)

    def _take(self) -> None:
        """Follow the last of what has come: with each in turn, a flood would be followed for long after its end."""
        self._soon = False
        last: bool | None = None
        while self._arrived:
            with contextlib.suppress(RobolinkError):  # nonsense moves nothing
                sample = self._system.context.transport.read(self._arrived.popleft())
                sender = unpack_attachment(sample.attachment)
                message = decode(Bool, sample.payload)
                if self._lock.is_news(sender.gid, sender.sequence):
                    last = message.data
        if last is not None:
            self._lock.follow(last)

    def _on_change(self, held: bool) -> None:
        self._now = self._changed_at = clocks.monotonic()
        self._zeros_due, self._again_due = 0.0, self._now + AGAIN
        self._publish_state()
        if held:
            self._send_zeros()
        else:
            self._end_zeros(())

    def _look(self) -> None:
        """Look at the graph, which has changed: a new listener is told that it holds, if it does."""
        graph = self._system.context.graph
        listeners = {gid for gid, _ in graph.gids(EndpointKind.SUBSCRIPTION, TOPIC)}
        new, self._known = listeners - self._known, listeners
        if new:
            self._lock.repeat()
        self._drives = drives_of(graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION))
        self._publish_state()

    def _publish_state(self) -> None:
        state = self.state()
        if state != self._sent:
            self._sent = state
            self._tell(state)

    def _send_zeros(self, *, all_of_them: bool = False) -> None:
        if not self._keeps:
            return
        drives = self._drives
        topics = drives.deaf
        if all_of_them or (self._now < self._changed_at + FIRST and len(drives.all_of_them) <= FEW):
            topics = {**drives.deaf, **drives.all_of_them}  # those that need it first
        self._end_zeros(topics)
        self._begin_zeros({topic: each for topic, each in topics.items() if topic not in self._zeros})
        for publisher, cls in self._zeros.values():
            publisher.publish(zeros(cls, self._system.time()))

    def _begin_zeros(self, topics: Mapping[str, str]) -> None:
        """Create publishers for topics by their types: as many as there is time for, but one at least."""
        end = clocks.monotonic() + AT_ONCE
        for topic, type_name in topics.items():
            cls = find(type_name)
            with contextlib.suppress(SecurityError):  # the others get theirs
                self._zeros[topic] = self._system.node.create_publisher(cls, topic, 10), cls
            if clocks.monotonic() > end:
                break

    def _end_zeros(self, but: Iterable[str]) -> None:
        """Send no more zeros, but on these topics."""
        for topic in self._zeros.keys() - set(but):
            self._system.node.destroy_publisher(self._zeros.pop(topic)[0])


def zeros(cls: type[Any], now: int) -> Any:
    """Return the Twist or TwistStamped that moves nothing, of the time `now` in ns."""
    made = cls()
    if hasattr(made, "header"):
        made.header.stamp.sec, made.header.stamp.nanosec = divmod(now, 10**9)
    return made
