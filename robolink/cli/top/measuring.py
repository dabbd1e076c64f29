"""Measurement for `robolink top`: the graph, the counts of messages and the processes become rows."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from robolink.cli.shared.session import ReportedLosses
from robolink.cli.top.processes import Processes
from robolink.cli.top.table import NodeRow, Shown, TopicRow
from robolink.cli.top.traffic import Count, Traffic
from robolink.system import clocks
from robolink.wire import EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.node import Node

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
        """Return what the subscriptions that are there now have lost, by topic."""
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
