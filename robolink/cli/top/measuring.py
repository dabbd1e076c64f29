"""Measurements of `top`: traffic of topics, processes of nodes, and both in an interval.

Of traffic nothing is decoded and no payload is copied. The callback of the network is C from end to end
(`graph.endpoint.timed_arrival`), and a thread of its own empties the queue.

Processes are found by their connections: one between two sessions of one machine has two ends here. Ours is known from
the transport, and the process that holds the other is known to the system, if it is the user's own. Nodes behind a
router have no connection with us: those that a launcher has started are known by name.
"""

from __future__ import annotations

import contextlib
import functools
import queue
import threading
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import psutil

from robolink.cli.shared.session import ReportedLosses
from robolink.cli.top.table import NodeRow, Shown, TopicRow
from robolink.exceptions import RobolinkError, TransportClosedError
from robolink.graph.endpoint import ALL_BEST_EFFORT, keys_of, listen, timed_arrival
from robolink.graph.graph import EVERY
from robolink.system import clocks, waits
from robolink.wire import EndpointKind, EndpointToken, is_attachment, unpack_attachment

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.transport.base import Handle
    from robolink.transport.reach import Link


class Count(NamedTuple):
    """Traffic since the beginning: `last` is the time of the last arrival, in ns of the steady clock, 0 for none."""

    messages: int = 0
    bytes: int = 0
    lost: int = 0
    last: int = 0


class _Counter:
    """Counter of one publisher's messages, or of those of unknown senders, on a topic."""

    __slots__ = ("bytes", "last", "lost", "messages", "sequence")

    def __init__(self) -> None:
        self.messages = self.bytes = self.lost = self.last = self.sequence = 0

    def add(self, size: int, at: int, sequence: int) -> None:
        """Count a message; numbers that are missing between it and the one before are lost messages."""
        if self.sequence and sequence > self.sequence:
            self.lost += sequence - self.sequence - 1
        self.sequence = sequence
        self.messages += 1
        self.bytes += size
        self.last = at

    def count(self) -> Count:
        return Count(self.messages, self.bytes, self.lost, self.last)


class Traffic:
    """Listener to every topic of a node's domain, those that come later included.

    Args:
        node: Node whose subscriptions they are. It must be hidden: commands' nodes are.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._transport = node.context.transport
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = timed_arrival(self._queue.put, clocks.steady)
        self._counters: defaultdict[str, defaultdict[bytes, _Counter]] = defaultdict(lambda: defaultdict(_Counter))
        self._lock = threading.Lock()
        self._heard: set[str] = set()
        self._handles: list[Handle] = []
        self._thread = threading.Thread(target=self._drain, name="robolink traffic", daemon=True)
        self._thread.start()
        self._following = node.context.graph.follow(EVERY, EndpointKind.PUBLISHER, self._on_publisher)

    def counts(self) -> dict[tuple[str, bytes], Count]:
        """Return the counts of each topic and publisher, by the topic's name and the publisher's gid."""
        with self._lock:
            return {
                (name, gid): counter.count()
                for name, senders in self._counters.items()
                for gid, counter in senders.items()
            }

    def close(self) -> None:
        """Stop listening."""
        self._following.close()
        for each in self._handles:
            each.close()
        self._queue.put(None)
        waits.join(self._thread, 1.0)

    def _on_publisher(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        keys = keys_of(token) - self._heard
        if not alive or not keys:
            return
        self._heard |= keys
        try:
            sink = functools.partial(self._arrival, token.name)
            self._handles += listen(self._node._owner_, token, keys, ALL_BEST_EFFORT, sink)
        except TransportClosedError:  # the command ends just now
            return

    def _drain(self) -> None:
        transport = self._transport
        for arrived in iter(self._queue.get, None):
            try:
                size, attachment = transport.size(arrived.content), transport.attachment(arrived.content)
            except RobolinkError:  # overwritten by its sender while it waited
                continue
            sequence, gid = 0, b""
            if is_attachment(attachment):
                sequence, _, gid = unpack_attachment(attachment)
            with self._lock:
                self._counters[arrived.target][gid].add(size, arrived.at, sequence)


LOOK_AGAIN = 2.0
"""Least interval between two looks at the system's connections, in seconds: one takes some ten milliseconds."""

ANSWER_WITHIN = 0.2
"""Longest wait for a launcher's answer, in seconds."""

Ends = tuple[str, str]
"""Address and port, as `HOST:PORT`, of both ends of a connection, the holder's first."""


class Usage(NamedTuple):
    """Resource use of a process: CPU in percent of one core since the last look, None at the first; memory in bytes."""

    pid: int
    cpu: float | None
    memory: int


def sessions_here(links: Iterable[Link], holders: Mapping[Ends, int]) -> dict[str, int]:
    """Return the process id of each session that has a connection with us on this machine.

    Args:
        links: Our connections.
        holders: Process ids of the connections of this machine, by their ends.
    """
    found = {}
    for link in links:
        pid = holders.get((_place(link.there), _place(link.here)))
        if pid is not None:
            found[link.session] = pid
    return found


def _place(locator: str) -> str:
    """Return `HOST:PORT` of a locator of Zenoh's, such as `tcp/127.0.0.1:7447?rel=1`."""
    return locator.partition("/")[2].partition("?")[0].replace("[", "").replace("]", "").replace("::ffff:", "")


def holders_of_connections() -> dict[Ends, int]:
    """Return the holders of this machine's TCP connections, as far as the user may know them."""
    found: dict[Ends, int] = {}
    for each, pid in _connections():
        if pid and each.raddr:
            here, there = (f"{host}:{port}".replace("::ffff:", "") for host, port in (each.laddr, each.raddr))
            found[here, there] = pid
    return found


def _connections() -> Iterable[tuple[Any, int | None]]:
    try:
        return [(each, each.pid) for each in psutil.net_connections("tcp")]
    except psutil.Error:  # macOS lists all to root only: each process is asked, and others' refuse
        found: list[tuple[Any, int | None]] = []
        for process in psutil.process_iter():
            with contextlib.suppress(psutil.Error, OSError):
                found += [(each, process.pid) for each in process.net_connections("tcp")]
        return found


def launched_here() -> dict[str, int]:
    """Return the process ids of the nodes that launchers of this user have started, by name."""
    from robolink.supervisor.control.client import LauncherError, running

    found = {}
    for launcher in running():
        with contextlib.suppress(LauncherError):
            found.update({each.name: each.pid for each in launcher.status(ANSWER_WITHIN).nodes if each.pid})
    return found


class Processes:
    """Look-up of sessions' processes, and of what these use, from one look to the next.

    Args:
        links: Function that returns our connections.
    """

    def __init__(self, links: Callable[[], Iterable[Link]]) -> None:
        self._links = links
        self._pids: dict[str, int] = {}
        self._seen: frozenset[str] = frozenset()
        self._looked = -LOOK_AGAIN
        self._processes: dict[int, psutil.Process] = {}

    def look(self, sessions: Mapping[str, Sequence[str]]) -> dict[str, Usage]:
        """Return the use of processor and memory of the sessions of this machine, by session.

        Args:
            sessions: Full names of the nodes of each session.
        """
        here = frozenset(sessions)
        missing, now = here - self._pids.keys(), clocks.monotonic()
        if missing and (here != self._seen or now - self._looked > LOOK_AGAIN):
            self._seen, self._looked = here, now
            self._pids = self._found(sessions)
        pids = {session: self._pids[session] for session in sessions if session in self._pids}
        used = {pid: usage for pid in set(pids.values()) if (usage := self._used(pid)) is not None}
        return {session: used[pid] for session, pid in pids.items() if pid in used}

    def _found(self, sessions: Mapping[str, Sequence[str]]) -> dict[str, int]:
        found = sessions_here(self._links(), holders_of_connections())
        launched = launched_here() if sessions.keys() - found.keys() else {}
        for session in sessions.keys() - found.keys():
            names = (name for full in sessions[session] for name in (full, full.rpartition("/")[2]))
            pid = next((launched[name] for name in names if name in launched), None)
            if pid is not None:
                found[session] = pid
        return found

    def _used(self, pid: int) -> Usage | None:
        """Return the use of processor and memory of a process; None if it has ended."""
        try:
            process = self._processes.get(pid)
            if process is None:
                process = self._processes[pid] = psutil.Process(pid)
                process.cpu_percent()  # counts from here on
                return Usage(pid, None, process.memory_info().rss)
            return Usage(pid, process.cpu_percent(), process.memory_info().rss)
        except (psutil.Error, OSError):
            self._processes.pop(pid, None)
            return None


NS = 1e-9


class Flow(NamedTuple):
    """Messages and bytes since the last look."""

    messages: int = 0
    bytes: int = 0


class Meter:
    """Meter of a system, from one `look` to the next.

    Args:
        node: Hidden node that listens; it and its subscriptions are left out of the rows.
        with_traffic: False to subscribe to nothing: rates, bandwidths, ages and losses are unknown then.
    """

    def __init__(self, node: Node, *, with_traffic: bool = True) -> None:
        self._graph = node.context.graph
        self._own = (node.context.transport.session_id, node._owner_.node_id)
        self._graph.endpoints()  # waits until what was there before is known
        self._traffic = Traffic(node) if with_traffic else None
        self._processes = Processes(node.context.transport.links)
        self._reported = ReportedLosses(node.context, node)
        self._before: Mapping[tuple[str, bytes], Count] = {}
        self._looked = clocks.steady()
        self._is_first = True

    def look(self) -> Shown:
        """Return rows of what was used and carried since the last look; at the first, only what is there."""
        now, counts = clocks.steady(), self._traffic.counts() if self._traffic is not None else {}
        passed, self._looked = max(1, now - self._looked) * NS, now
        flows = {place: _since(self._before.get(place, Count()), count) for place, count in counts.items()}
        self._before = counts
        known = self._traffic is not None and not self._is_first
        self._is_first = False
        return Shown(self._nodes(flows, passed, known), self._topics(counts, flows, (now, passed), known))

    def close(self) -> None:
        """Stop listening."""
        self._reported.close()
        if self._traffic is not None:
            self._traffic.close()

    def _nodes(self, flows: Mapping[tuple[str, bytes], Flow], passed: float, known: bool) -> list[NodeRow]:
        sessions: defaultdict[str, list[str]] = defaultdict(list)
        for each in self._graph.nodes():
            if (each.session, each.node_id) != self._own:
                sessions[each.session].append(each.full_node_name)
        sent: defaultdict[str, list[Flow]] = defaultdict(list)
        for (_, gid), flow in flows.items():
            token = self._graph.endpoint_of(gid)
            sent[token.session if token is not None else ""].append(flow)
        usage = self._processes.look(sessions)
        rows = []
        for session, names in sessions.items():
            used, flow = usage.get(session), _sum(sent[session])
            rows.append(
                NodeRow(
                    tuple(sorted(names)),
                    used and used.pid,
                    used and used.cpu,
                    used and used.memory,
                    flow.messages / passed if known else None,
                    flow.bytes / passed if known else None,
                )
            )
        return rows

    def _topics(
        self,
        counts: Mapping[tuple[str, bytes], Count],
        flows: Mapping[tuple[str, bytes], Flow],
        times: tuple[int, float],
        known: bool,
    ) -> list[TopicRow]:
        now, passed = times
        ends = self._graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
        others = [each for each in ends if (each.session, each.node_id) != self._own]
        number = Counter((each.name, each.kind) for each in others)
        reported = self._reported_by_topic()
        rows = []
        for name, types in _types(others).items():
            of_topic = [place for place in counts if place[0] == name]
            flow = _sum([flows[place] for place in of_topic])
            last = max((counts[place].last for place in of_topic), default=0)
            rows.append(
                TopicRow(
                    name,
                    types,
                    flow.messages / passed if known else None,
                    flow.bytes / passed if known else None,
                    (now - last) * NS if last else None,
                    sum(counts[place].lost for place in of_topic),
                    number[name, EndpointKind.PUBLISHER],
                    number[name, EndpointKind.SUBSCRIPTION],
                    reported[name],
                )
            )
        return rows

    def _reported_by_topic(self) -> Counter[str]:
        """Return the losses of the present subscriptions, by topic."""
        found: Counter[str] = Counter()
        for gid, losses in self._reported.look().items():
            token = self._graph.endpoint_of(gid)
            if token is not None:
                found[token.name] += losses.total
        return found


def _since(before: Count, now: Count) -> Flow:
    return Flow(now.messages - before.messages, now.bytes - before.bytes)


def _sum(flows: list[Flow]) -> Flow:
    return Flow(sum(each.messages for each in flows), sum(each.bytes for each in flows))


def _types(ends: list[EndpointToken]) -> dict[str, tuple[str, ...]]:
    """Return the types of each topic, sorted."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    for each in ends:
        found[each.name].add(each.type_name)
    return {name: tuple(sorted(types)) for name, types in found.items()}
