"""STOP: one lock for a whole system of robots, held by a message on /e_stop until another one releases it.

/e_stop carries a std_msgs/Bool, reliable and transient local: true holds, false releases. That is the kind of topic
that twist_mux's `locks` read. Whoever moves a robot obeys it by a `StopLock`.

Everybody who knows the lock keeps it: on a true of somebody else they say true themselves, so that it holds on when
the first one has gone, and reaches who starts later. On a false they take their own true back without a word, for a
false of each of them could undo the next true. So what was said last counts, whoever said it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.event_handler import PublisherEventCallbacks
from robolink.exceptions import RobolinkError, SecurityError
from robolink.interfaces.std_msgs.msg import Bool
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.publisher import Publisher
    from robolink.subscription import MessageInfo
    from robolink.timer import Timer

TOPIC = "/e_stop"
"""Topic of the lock: one for all robots, whatever their namespaces."""

TYPE = "std_msgs/msg/Bool"

QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Quality of service of who says that it holds, and of who obeys."""

PLAIN = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
"""Quality of service of a second subscription: over DDS a transient local one hears nothing of a volatile publisher."""

AGAIN = 0.25
"""Time in seconds after which a true is said once more: two messages that crossed are heard in any order, and everybody
should end with the same. It is also the shortest time between two echoes of others: each takes a publisher, and some
participants that echo a flood would flood each other for ever.
"""

_REMEMBERED = 1000
"""Own publishers whose last messages may still come back, and senders whose messages may come twice."""


class Lock:
    """The lock as one participant knows it, without a subscription: for nodes that nobody spins.

    Args:
        node: Node whose publisher keeps it while it is held.
        on_change: Function that is called with True once it is held, with False once it is released.
        events: Callbacks for the events of that publisher.
        keeps: False only looks, and says nothing of what others have said.
    """

    def __init__(
        self,
        node: Node,
        on_change: Callable[[bool], object],
        events: PublisherEventCallbacks | None = None,
        *,
        keeps: bool = True,
    ) -> None:
        self.held = False
        """True while it holds."""
        self._node, self._on_change, self._events, self._keeps = node, on_change, events, keeps
        self._publisher: Publisher[Bool] | None = None
        self._own: deque[bytes] = deque(maxlen=_REMEMBERED)
        self._heard: dict[bytes, int] = {}
        """Number of the last message of each sender, the one that was heard last at the end."""
        self._steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=node.context.time)
        self._echo_due = 0

    def press(self) -> None:
        """Hold, and say so."""
        self._say(True)
        self._set(True)

    def release(self) -> None:
        """Release, and say so: the publisher stays until `withdraw`, so that the message gets out."""
        self._say(False)
        self._set(False)

    def take(self, held: bool, sender: bytes, number: int) -> None:
        """Take what came on the topic.

        Args:
            held: What it says.
            sender: Global id of its publisher.
            number: Number that the publisher gave it.
        """
        if self.is_news(sender, number):
            self.follow(held)

    def is_news(self, sender: bytes, number: int) -> bool:
        """Note a message, and return whether it counts: not an own one, nor one that comes twice, or after a later one.

        It may come by two subscriptions, of which one is behind.

        Args:
            sender: Global id of its publisher.
            number: Number that the publisher gave it.
        """
        if sender in self._own:
            return False
        newest = self._heard.pop(sender, None)
        self._heard[sender] = number if newest is None else max(newest, number)
        if len(self._heard) > _REMEMBERED:
            del self._heard[next(iter(self._heard))]
        return newest is None or number > newest

    def follow(self, held: bool) -> None:
        """Hold or let go, as somebody else has said in a message with the value `held`."""
        if held and not self.held:
            now = self._steady.now_ns()
            # An own false that is still there must not reach who comes late; else the next `repeat` says it.
            if self._publisher is not None or now >= self._echo_due:
                self._echo_due = now + round(AGAIN * 1e9)
                self._keep()
            self._set(True)
        elif not held and self.held:
            self._set(False)
            self.withdraw()

    def repeat(self) -> None:
        """Publish the true again while it holds, for volatile listeners that came later."""
        if self.held:
            self._keep()

    def _keep(self) -> None:
        """Publish the true of others, if this is one that keeps it; a node that may not publish obeys all the same."""
        if self._keeps:
            try:
                self._say(True)
            except RobolinkError as error:
                self._node.get_logger().warning(f"STOP is obeyed here and not kept for others: {error}", once=True)

    def withdraw(self) -> None:
        """Destroy the publisher unless it holds, so that nobody who comes later gets what this node published."""
        if self._publisher is not None and not self.held:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None

    def _say(self, held: bool) -> None:
        if self._publisher is None:
            self._publisher = self._node.create_publisher(Bool, TOPIC, QOS, event_callbacks=self._events)
            self._own.append(self._publisher.gid)
        self._publisher.publish(Bool(data=held))

    def _set(self, held: bool) -> None:
        if held is not self.held:
            self.held = held
            self._on_change(held)


class StopLock:
    """The lock as a node obeys it that moves a robot, and keeps it until somebody releases it.

    Args:
        node: Node that obeys; somebody spins it.
        on_change: Function that is called with True once it is held, with False once it is released.
    """

    def __init__(self, node: Node, on_change: Callable[[bool], object]) -> None:
        self._node, self._on_change = node, on_change
        self._lock = Lock(node, self._changed, PublisherEventCallbacks(matched=self._on_matched))
        self._steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=node.context.time)
        self._again: Timer | None = None
        # In the first turn of whoever spins: endpoints are numbered in the order in which they are made, and their
        # numbers count in the hash of a deterministic run, which should stay as it was for who knows nothing of this.
        self._begin = node.create_guard_condition(self._listen)
        self._begin.trigger()

    @property
    def held(self) -> bool:
        """True while it holds."""
        return self._lock.held

    def _listen(self) -> None:
        self._node.destroy_guard_condition(self._begin)
        try:
            for qos in (QOS, PLAIN):
                self._node.create_subscription(Bool, TOPIC, self._on_message, qos)
        except SecurityError as error:  # by rights from before there was a lock
            self._node.get_logger().error(f"STOP is not obeyed here: {error}")

    def _on_message(self, message: Bool, info: MessageInfo) -> None:
        known: Any = info  # rclpy's class allows None, which this network never has
        self._lock.take(message.data, known["publisher_gid"]["data"], known["publication_sequence_number"])

    def _on_matched(self, event: Any) -> None:
        if event.current_count_change > 0:
            self._lock.repeat()

    def _changed(self, held: bool) -> None:
        self._end_timer()
        if held:
            self._again = self._node.create_timer(AGAIN, self._on_again, clock=self._steady)
        self._on_change(held)

    def _on_again(self) -> None:
        self._end_timer()
        self._lock.repeat()

    def _end_timer(self) -> None:
        if self._again is not None:
            self._node.destroy_timer(self._again)
            self._again = None
