"""Recorder of /tf and /tf_static for the commands: which transforms come, and from which nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.cli.shared.graph import Listening, why_silent
from robolink.exceptions import RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.subscription import MessageInfo, Subscription
from robolink.system import clocks
from robolink.task import Future
from robolink.tf2.core import CACHE_TIME, nanoseconds
from robolink.tf2.rigid import Rigid
from robolink.tf2.tree import Tree
from robolink.wire import EndpointKind, unpack_attachment

Link = tuple[str, str, str, bool]
"""Child, parent, sender, and True if it is static."""

TOPICS = ("/tf", "/tf_static")
DEPTH = 1000
QOS = {False: QoSProfile(depth=DEPTH), True: QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)}

LAST = 1000
"""Number of transforms of a link whose delays are kept."""


class NoTransformsError(RobolinkError, TimeoutError):
    """No transform was received while a command listened."""


class Seen:
    """One link, of a frame to its parent, as one node publishes it."""

    def __init__(self, child: str, parent: str, sender: str, static: bool) -> None:
        self.child, self.parent, self.sender, self.static = child, parent, sender, static
        self.stamps: list[int] = []
        """Stamps of the last LAST transforms, in ns, in the order of arrival."""
        self.arrivals: list[int] = []
        """Times of arrival, in ns of this computer's clock."""

    def add(self, stamp: int, now: int) -> None:
        """Record a transform."""
        for kept, new in ((self.stamps, stamp), (self.arrivals, now)):
            kept.append(new)
            del kept[:-LAST]

    def add_earlier(self, other: Seen) -> None:
        """Merge the records of another link, which turned out to be the same."""
        self.stamps[:0], self.arrivals[:0] = other.stamps, other.arrivals
        del self.stamps[:-LAST], self.arrivals[:-LAST]

    @property
    def rate(self) -> float | None:
        """Rate of arrival, in Hz; None for a single transform."""
        spent = self.arrivals[-1] - self.arrivals[0]
        return (len(self.arrivals) - 1) * 1e9 / spent if spent else None

    @property
    def delays(self) -> list[float]:
        """Delays from stamp to arrival, in seconds."""
        return [(came - stamp) / 1e9 for came, stamp in zip(self.arrivals, self.stamps, strict=True)]


class Watch:
    """Recorder of all links, by child, parent and sender, on a command's node."""

    def __init__(self, node: Node, topics: tuple[str, str] = TOPICS) -> None:
        self.node, self.topics = node, tuple(node.resolve_topic_name(each) for each in topics)
        self.links: dict[Link, Seen] = {}
        self.refused: dict[tuple[str, str, str, str], int] = {}
        """Number of refused transforms by parent, child, sender and reason."""
        self.tree = Tree(CACHE_TIME)
        self.on_news: Callable[[], object] | None = None
        """Function that is called after each message."""
        self._names: dict[bytes, str] = {}
        self._nameless: dict[str, bytes] = {}
        for topic, static in zip(self.topics, (False, True), strict=True):
            heard = _Heard(node._owner_, TFMessage, topic, self._taker(static), ReentrantCallbackGroup(), QOS[static])
            node._entity_store_.add_subscription(heard)
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)

    def listen(self, span: float, until: Future[Any] | None = None) -> None:
        """Record for `span` seconds, or until a future is done. Raises KeyboardInterrupt on Ctrl-C."""
        self._executor.spin_until_future_complete(until or Future(), timeout_sec=span)
        self._name_late()

    def await_names(self, patience: float) -> None:
        """Record on until all senders are known by name, for `patience` seconds at most."""
        deadline = clocks.monotonic() + patience
        while self._nameless and clocks.monotonic() < deadline:
            self.listen(0.05)

    def why_nothing(self) -> str:
        """Return the reason why nothing has come."""
        graph = self.node.context.graph
        published = [each for each in self.topics if graph.endpoints(EndpointKind.PUBLISHER, name=each)]
        topic = (published or self.topics)[0]
        return why_silent(
            self.node.context, topic, Listening("tf2_msgs/msg/TFMessage", "", QOS[topic == self.topics[1]])
        )

    def _taker(self, static: bool) -> Callable[[TFMessage, MessageInfo], None]:
        def take(message: TFMessage, info: MessageInfo) -> None:
            sender, now = self._name(info["sender"]), clocks.now()  # type: ignore[typeddict-item]
            for each in message.transforms:
                self._note(each, sender, static, now)
            if self.on_news is not None:
                self.on_news()

        return take

    def _note(self, given: Any, sender: str, static: bool, now: int) -> None:
        parent, child = given.header.frame_id.removeprefix("/"), given.child_frame_id.removeprefix("/")
        place, turn, stamp = given.transform.translation, given.transform.rotation, nanoseconds(given.header.stamp)
        rigid: Rigid = (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
        wrong = self.tree.insert(parent, child, stamp, rigid, static=static)
        if wrong is not None:
            why = "TF_OLD_DATA" if wrong[0] == "TF_OLD_DATA" else ": ".join(wrong)
            self.refused[parent, child, sender, why] = self.refused.get((parent, child, sender, why), 0) + 1
        if child and parent and child != parent:
            link = (child, parent, sender, static)
            self.links.setdefault(link, Seen(*link)).add(stamp, now)

    def _name(self, gid: bytes) -> str:
        """Return the full name of the node with this gid; it is remembered, since nodes go."""
        if gid not in self._names:
            token = self.node.context.graph.endpoint_of(gid)
            if token is None:
                nameless = f"an unknown node ({gid.hex()[:8]})"
                self._nameless[nameless] = gid
                return nameless
            self._names[gid] = token.full_node_name
        return self._names[gid]

    def _name_late(self) -> None:
        """Name the senders whose transforms came before they were announced, as the only one on /tf_static may."""
        for nameless, gid in list(self._nameless.items()):
            del self._nameless[nameless]  # it comes back if it is still not known
            if (name := self._name(gid)) != nameless:
                self.links = _renamed(self.links, nameless, name)


def _renamed(links: dict[Link, Seen], sender: str, name: str) -> dict[Link, Seen]:
    found: dict[Link, Seen] = {}
    for (child, parent, own, static), seen in links.items():
        seen.sender = name if own == sender else own
        first = found.setdefault((child, parent, seen.sender, static), seen)
        if first is not seen:
            earlier, later = sorted((first, seen), key=lambda each: each.arrivals[0])
            later.add_earlier(earlier)
            found[child, parent, seen.sender, static] = later
    return found


class _Heard(Subscription[TFMessage]):
    """A subscription that also passes on the sender of each message."""

    def _info(self, attachment: bytes) -> MessageInfo:
        return {**super()._info(attachment), "sender": unpack_attachment(attachment).gid}  # type: ignore[typeddict-unknown-key]
