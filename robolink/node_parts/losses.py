"""Loss reports of a node on /diagnostics: what its subscriptions dropped or did not get, told while they lose.

A node that loses nothing has no part in it: no publisher, no timer. The first loss makes a publisher of /diagnostics,
latched, so that `robolink topic info -v` and `robolink top` read at any later time what each subscription has lost.
The executor of the node publishes, between its callbacks, soon after the first loss and then once a second.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from robolink.exceptions import RobolinkError
from robolink.running.entity import NOTHING, Entity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robolink.clock import Clock
    from robolink.graph.endpoint import Owner
    from robolink.impl.rcutils_logger import RcutilsLogger
    from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
    from robolink.publisher import Publisher
    from robolink.running.ready_queue import ReadyQueue
    from robolink.subscription import Subscription

TOPIC = "/diagnostics"

FIRST_AFTER_NS = 250_000_000
"""Time from the first loss to the first report, in nanoseconds: a burst is told in one."""

PERIOD_NS = 1_000_000_000
"""Period of further reports while messages are lost, in nanoseconds."""

GID, DROPPED, LOST = "subscription", "dropped", "lost"
"""Keys of a status: the subscription's gid, in hex; messages that came faster than they were taken; lost on the way."""


class Losses(NamedTuple):
    """Messages that a subscription did not take: `dropped` for newer ones, beyond its depth, and `lost` on the way."""

    dropped: int = 0
    lost: int = 0

    @property
    def total(self) -> int:
        """Both together."""
        return self.dropped + self.lost


class LosingNode(Protocol):
    """Node as seen by its loss reports."""

    _owner_: Owner

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Its subscriptions."""

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name."""

    def get_clock(self) -> Clock:
        """Return its clock."""

    def get_logger(self) -> RcutilsLogger:
        """Return its logger."""


class LossReports(Entity):
    """Reporter of the losses of a `node`; executors run it like a timer."""

    quick = True

    def __init__(self, node: Any) -> None:
        super().__init__()
        self.node = node
        self.version = 0
        """Number that changes whenever an older deadline no longer holds."""
        self._reported: dict[bytes, Losses] = {}
        self._is_quiet = True
        self._publisher: Publisher[DiagnosticArray] | None = None

    def note(self, queue: ReadyQueue[Any] | None) -> None:
        """Note a loss, under the inbox's lock: report it soon in this ready queue, unless that is due already."""
        if queue is not self._queue_ and queue is not None and not self._destroyed:
            self._schedule(queue, FIRST_AFTER_NS)

    def _schedule(self, queue: ReadyQueue[Any], left: int) -> None:
        self.version += 1
        self._queue_ = queue
        queue.schedule(self, left)

    def take(self) -> Any:
        """Return the losses so far, by subscription; NOTHING once the node is destroyed."""
        node: Any = self.node
        if node is None or self._destroyed or self._queue_ is None:
            return NOTHING
        counts = [(each.topic_name, each.gid, Losses(each.dropped, each.lost)) for each in node.subscriptions]
        found = [(topic, gid, losses) for topic, gid, losses in counts if losses.total]
        queue, self._queue_ = self._queue_, None
        was_quiet, self._is_quiet = self._is_quiet, all(losses == self._reported.get(gid) for _, gid, losses in found)
        if not self._is_quiet:
            self._schedule(queue, PERIOD_NS)
        elif was_quiet:  # the node has only moved to another executor
            return NOTHING
        return found

    def execute(self, taken: list[tuple[str, bytes, Losses]]) -> None:
        """Publish it."""
        node: Any = self.node
        if node is None:
            return
        name = node.get_fully_qualified_name().strip("/")
        before, self._reported = self._reported, {gid: losses for _, gid, losses in taken}
        statuses = [_status(name, topic, gid, (before.get(gid, Losses()), losses)) for topic, gid, losses in taken]
        try:
            self._publish(node, statuses)
        except RobolinkError as error:
            if not self._destroyed:
                node.get_logger().warning(f"cannot tell on {TOPIC} what was lost: {error}")
            self.destroy()

    def _publish(self, node: LosingNode, statuses: list[DiagnosticStatus]) -> None:
        from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray  # late: few nodes lose anything
        from robolink.interfaces.std_msgs.msg import Header

        if self._publisher is None:
            self._publisher = _publisher(node)
        self._publisher.publish(DiagnosticArray(header=Header(stamp=node.get_clock().now().to_msg()), status=statuses))

    def destroy(self) -> None:
        """Report nothing more. Safe to call twice."""
        self._destroyed = True
        publisher, self._publisher = self._publisher, None
        if publisher is not None:
            publisher.destroy()


def _publisher(node: LosingNode) -> Publisher[DiagnosticArray]:
    from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray
    from robolink.publisher import Publisher
    from robolink.qos import DurabilityPolicy, QoSProfile

    return Publisher(
        node._owner_, DiagnosticArray, TOPIC, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    )


def _status(name: str, topic: str, gid: bytes, counts: tuple[Losses, Losses]) -> DiagnosticStatus:
    from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus, KeyValue

    before, now = counts
    new = now.total - before.total
    values = {"topic": topic, DROPPED: str(now.dropped), LOST: str(now.lost), GID: gid.hex()}
    return DiagnosticStatus(
        level=DiagnosticStatus.WARN if new else DiagnosticStatus.OK,
        name=f"{name}: messages of {topic}",
        message=f"{new} lost since the last report, {now.total} in all"
        if new
        else f"{now.total} lost before, none now",
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )


def losses_in(array: DiagnosticArray) -> dict[bytes, Losses]:
    """Return the losses of the subscriptions in a report, by their gids; none from the diagnostics of others."""
    found = {}
    for status in array.status:
        values = {each.key: each.value for each in status.values}
        try:
            found[bytes.fromhex(values[GID])] = Losses(int(values[DROPPED]), int(values[LOST]))
        except (KeyError, ValueError):
            continue
    return found
