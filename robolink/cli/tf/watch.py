"""Transforms that come: the listener of all verbs, `tf echo` and `tf monitor`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.cli.shared.graph import PATIENCE, Listening, why_silent
from robolink.cli.shared.layout import Figures, figures_of
from robolink.cli.shared.output import say, say_json, tell
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.subscription import MessageInfo, Subscription
from robolink.system import clocks
from robolink.task import Future
from robolink.tf2 import listing
from robolink.tf2.cache import LATEST
from robolink.tf2.core import CACHE_TIME, nanoseconds
from robolink.tf2.exceptions import TransformException
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
        for stored, new in ((self.stamps, stamp), (self.arrivals, now)):
            stored.append(new)
            del stored[:-LAST]

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


ASKER = "robolink tf"


class RateError(RobolinkError, ValueError):
    """The rate is not a positive number."""


class Request(NamedTuple):
    """Options of `tf echo`: how often, and until when."""

    rate: float = 1.0
    once: bool = False
    timeout: float | None = None
    json: bool = False


class Found(NamedTuple):
    """Transform from one frame to another."""

    source: str
    target: str
    rigid: Rigid
    stamp: int

    def text(self) -> str:
        """Return it as text, like tf2_echo."""
        place, turn = self.rigid[:3], self.rigid[3:]
        angles = roll_pitch_yaw(*turn)
        return "\n".join(
            [
                f"At time {self.stamp // 10**9}.{self.stamp % 10**9:09d}",
                f"- Translation: {_row(place)}",
                f"- Rotation: in Quaternion {_row(turn)}",
                f"- Rotation: in RPY (radian) {_row(angles)}",
                f"- Rotation: in RPY (degree) {_row([math.degrees(each) for each in angles])}",
                "- Matrix:",
                *("".join(f" {_short(each):>6}" for each in row) for row in matrix(self.rigid)),
            ]
        )

    def data(self) -> dict[str, Any]:
        """Return it as data for JSON."""
        return {
            "stamp": self.stamp / 1e9,
            "frame_id": self.source,
            "child_frame_id": self.target,
            "translation": dict(zip("xyz", self.rigid[:3], strict=True)),
            "rotation": dict(zip("xyzw", self.rigid[3:], strict=True)),
            "rpy": roll_pitch_yaw(*self.rigid[3:]),
        }


def echo(source: str, target: str, request: Request) -> None:
    """Show where a frame is in another, until Ctrl-C; raises NoTransformsError when --timeout passes before."""
    if not (math.isfinite(request.rate) and request.rate > 0):
        raise RateError(f"RATE: expected a number of Hz above 0, got {request.rate:g}")
    with opened() as context:
        watch = Watch(node_of(context))
        _wait(watch, source, target, request.timeout)
        while True:
            _show(watch, source, target, json=request.json)
            if request.once:
                return
            watch.listen(1.0 / request.rate)


def _wait(watch: Watch, source: str, target: str, timeout: float | None) -> None:
    """Wait for the first transform; print after a second why there is none, again if the reason changes."""
    begin, reported = clocks.monotonic(), ""
    came: Future[None] = Future()

    def look() -> None:
        if not came.done() and why_not(watch, source, target) == "":
            came.set_result(None)

    watch.on_news = look
    while not came.done():
        left = math.inf if timeout is None else timeout - (clocks.monotonic() - begin)
        if left <= 0:
            raise NoTransformsError(f"gave up after {timeout:g} s: {why_not(watch, source, target)}")
        watch.listen(min(PATIENCE, left), came)
        why = why_not(watch, source, target)
        if why not in ("", reported) and left > PATIENCE:
            tell(why if why.startswith("waiting") else f"waiting: {why}")
            reported = why
    watch.on_news = None


def why_not(watch: Watch, source: str, target: str) -> str:
    """Return the reason why there is no transform between two frames; empty if there is one."""
    if not watch.links:
        return watch.why_nothing()
    try:
        for frame in (source, target):
            watch.tree.check(frame, ASKER)
        watch.tree.path(source, target, LATEST, ASKER)
    except TransformException as error:
        return str(error)
    return ""


def _show(watch: Watch, source: str, target: str, *, json: bool) -> None:
    try:
        found = Found(source, target, *watch.tree.transform(source, target, LATEST, ASKER))
    except TransformException as error:  # there was one: the tree has changed
        text = f"Failure at {clocks.time_of_day():.6f}\nException thrown:{error}\nThe current list of frames is:"
        say_json({"error": str(error)}) if json else say(f"{text}\n{listing.as_text(watch.tree.caches)}")
        return
    say_json(found.data()) if json else say(found.text())


def roll_pitch_yaw(x: float, y: float, z: float, w: float) -> tuple[float, float, float]:
    """Return the angles of a unit quaternion about the static axes x, y and z, in radians."""
    sine = 2.0 * (w * y - x * z)
    if abs(sine) > 1.0 - 1e-12:  # straight up or down: roll and yaw are one, which roll has
        return 2.0 * math.atan2(x, w), math.copysign(math.pi / 2, sine), 0.0
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    return roll, math.asin(sine), math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def matrix(rigid: Rigid) -> list[list[float]]:
    """Return the 4x4 matrix of a transform, row by row."""
    px, py, pz, x, y, z, w = rigid
    return [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w), px],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w), py],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y), pz],
        [0.0, 0.0, 0.0, 1.0],
    ]


def _row(numbers: Sequence[float]) -> str:
    return f"[{', '.join(map(_short, numbers))}]"


def _short(number: float) -> str:
    return f"{round(number, 3) + 0.0:.3f}"  # no -0.000


def monitor(source: str, target: str, period: float, *, json: bool) -> None:
    """Report every `period` seconds, on all frames or on the chain between two, until Ctrl-C."""
    with opened() as context:
        watch = Watch(node_of(context))
        if not json:
            what = f"{source} -> {target}" if target else "all frames"
            say(f"Gathering data on {what} for {period:g} seconds...")
        explained = False
        while True:
            watch.listen(period)
            chain = _chain(watch, source, target) if target else None
            if not watch.links or (chain is None and target):
                if not explained:
                    why = why_not(watch, source, target)
                    tell(why if why.startswith("waiting") else f"waiting: {why}")
                explained = True
            elif json:
                say_json(_data(watch, chain))
            else:
                say(_text(watch, chain))


def _chain(watch: Watch, source: str, target: str) -> list[str] | None:
    """Return the frames from one to the other; None while nothing connects them."""
    try:
        return watch.tree.chain(target, source, LATEST, ASKER)
    except TransformException:
        return None


def _shown(watch: Watch, chain: list[str] | None) -> list[Seen]:
    return [each for each in watch.links.values() if chain is None or each.child in chain]


def _text(watch: Watch, chain: list[str] | None) -> str:
    lines = ["", "", "", f"RESULTS: for {f'{chain[0]} to {chain[-1]}' if chain else 'all Frames'}"]
    if chain is not None:
        lines += [f"Chain is: {' -> '.join(chain)}", _net_delay(watch, chain)]
    lines += ["", "Frames:"]
    lines += [_frame(each) for each in sorted(_shown(watch, chain), key=lambda each: each.child)]
    lines += ["", "All Broadcasters:"]
    for sender in sorted({each.sender for each in watch.links.values()}):
        lines.append(_broadcaster(sender, [each for each in watch.links.values() if each.sender == sender]))
    return "\n".join(lines)


def _net_delay(watch: Watch, chain: list[str]) -> str:
    stamp = watch.tree.path(chain[-1], chain[0], LATEST, ASKER)[1]
    delay = f"{(clocks.now() - stamp) / 1e9:.6g}" if stamp else "0 (all of it is static)"
    return f"Net delay     now = {delay}"


def _frame(seen: Seen) -> str:
    begin = f"Frame: {seen.child}, published by {seen.sender}"
    found = figures_of(seen.delays)
    if seen.static or found is None:
        return f"{begin}, static"
    return f"{begin}, Average Delay: {found.mean:.6g}, Max Delay: {found.high:.6g}"


def _broadcaster(sender: str, links: list[Seen]) -> str:
    found = _moving(links)
    if found is None:
        return f"Node: {sender} static"
    rate = max((each.rate or 0.0 for each in links if not each.static), default=0.0)
    return f"Node: {sender} {rate:.6g} Hz, Average Delay: {found.mean:.6g} Max Delay: {found.high:.6g}"


def _moving(links: Iterable[Seen]) -> Figures | None:
    return figures_of([delay for each in links if not each.static for delay in each.delays])


def _data(watch: Watch, chain: list[str] | None) -> dict[str, Any]:
    frames = []
    for each in _shown(watch, chain):
        found = None if each.static else figures_of(each.delays)
        frames.append(
            {
                "frame": each.child,
                "parent": each.parent,
                "publisher": each.sender,
                "static": each.static,
                "rate": None if each.static else each.rate,
                "average_delay": found.mean if found else None,
                "max_delay": found.high if found else None,
            }
        )
    return {"chain": chain, "frames": frames}
