"""Checks of a running system for `robolink doctor`: endpoints that cannot meet. Pure functions of the facts."""

from __future__ import annotations

import collections
import itertools
from collections.abc import Iterable

from robolink.cli.doctor.facts import Check, Facts, Verdict, count, listed
from robolink.cli.shared.stop import HOLDS
from robolink.control.stop_lock import TOPIC as STOP
from robolink.exceptions import nearest
from robolink.qos import DurabilityPolicy
from robolink.wire import NO_HASH, EndpointKind, EndpointToken, NodeToken

PUBLISHER, SUBSCRIPTION = EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION
SERVICE, CLIENT = EndpointKind.SERVICE, EndpointKind.CLIENT

Variant = tuple[str, str]
"""Name and hash of a type."""

SILENT_TOPICS = ("/parameter_events", "/rosout", "/clock", "/tf_static", STOP)
"""Topics that nodes subscribe to even without a publisher. /clock and STOP have checks of their own."""

COMMANDS = ("_robolink_", "_ros2cli")
"""Prefixes of the names of commands' own nodes: they come and go, and nothing depends on them."""

SEND_GOAL = "/_action/send_goal"
"""Suffix of the service that stands for a whole action."""


def announcements(facts: Facts) -> Verdict:
    """Check that all announcements can be parsed."""
    if facts.seen.error:
        return Verdict("", (f"the system could not be looked at: {facts.seen.error}",))
    warnings = tuple(f"cannot be read, so it is not seen: {text[:120]!a}" for text in facts.seen.malformed)
    tokens = facts.seen.tokens
    processes = len({each.session for each in tokens})
    summary = f"{count(len(_nodes(tokens)), 'node')} and {count(len(_endpoints(tokens)), 'endpoint')}"
    return Verdict(f"{summary} in {processes} process{'' if processes == 1 else 'es'}", warnings=warnings)


def nodes(facts: Facts) -> Verdict:
    """Check that each node has a name of its own."""
    tokens = facts.seen.tokens
    busy = collections.Counter((each.session, each.node_id) for each in _endpoints(tokens))
    homes: dict[str, list[NodeToken]] = {}
    for node in _nodes(tokens):
        homes.setdefault(node.full_node_name, []).append(node)
    warnings = []
    for name, same in sorted(homes.items()):
        sessions = {each.session for each in same}
        # Some peers announce a node anew for each of its endpoints: that is still one.
        together = max(sum(each.session == own and busy[own, each.node_id] > 1 for each in same) for own in sessions)
        many = max(len(sessions), together)
        if many > 1:
            warnings.append(f"{many} nodes are named {name}: rename one with --ros-args -r __node:=NAME")
    return Verdict(f"{count(len(homes), 'name')}, no two alike", warnings=tuple(warnings))


def topic_types(facts: Facts) -> Verdict:
    """Check that publishers and subscriptions of a topic agree in its type: with two types they never meet."""
    return _types(facts, "topic", {PUBLISHER: "publishes", SUBSCRIPTION: "subscribes to"})


def service_types(facts: Facts) -> Verdict:
    """Check that clients and servers of a service agree in its type."""
    return _types(facts, "service", {SERVICE: "serves", CLIENT: "calls"})


def _types(facts: Facts, noun: str, verbs: dict[EndpointKind, str]) -> Verdict:
    errors = []
    named = _by_name(each for each in _endpoints(facts.seen.tokens) if each.kind in verbs)
    for name, ends in named.items():
        owners: dict[EndpointKind, dict[Variant, list[str]]] = {kind: {} for kind in verbs}
        for each in ends:
            owners[each.kind].setdefault((each.type_name, each.type_hash), []).append(each.full_node_name)
        giving, taking = owners.values()
        apart = {each for pair in itertools.product(giving, taking) if _differ(*pair) for each in pair}
        if apart:
            reported = _reported({verbs[kind]: _only(owners[kind], apart) for kind in verbs})
            errors.append(f"{name}: {reported}: they never meet")
    return Verdict(f"{count(len(named), noun)}, both ends agree", tuple(errors))


def _differ(one: Variant, other: Variant) -> bool:
    return one[0] != other[0] or (one[1] != other[1] and NO_HASH not in (one[1], other[1]))


def _only(owners: dict[Variant, list[str]], variants: set[Variant]) -> dict[Variant, list[str]]:
    return {variant: names for variant, names in owners.items() if variant in variants}


def _reported(sides: dict[str, dict[Variant, list[str]]]) -> str:
    """Return in words who uses which type; with its hash if the name alone does not tell them apart."""
    same_name = len({type_name for owners in sides.values() for type_name, _ in owners}) == 1
    return ", ".join(
        f"{listed(names)} {verb} {type_name}" + (f" of hash {type_hash[:15]}..." if same_name else "")
        for verb, owners in sides.items()
        for (type_name, type_hash), names in owners.items()
    )


def topics(facts: Facts) -> Verdict:
    """Check that subscriptions have a publisher."""
    ends = _by_name(each for each in _endpoints(facts.seen.tokens) if each.kind in (PUBLISHER, SUBSCRIPTION))
    published = [name for name, found in ends.items() if any(each.kind is PUBLISHER for each in found)]
    warnings = []
    for name, found in ends.items():
        waiting = [each.full_node_name for each in found if not _is_command(each)]
        if name not in published and waiting and not _hidden(name) and name not in SILENT_TOPICS:
            meant = nearest(name, _alike(ends, name, PUBLISHER))
            warnings.append(f"{name} has no publisher; {listed(waiting)} subscribed to it{meant}")
    return Verdict(f"{count(len(published), 'topic')} published, nobody waits in vain", warnings=tuple(warnings))


def services(facts: Facts) -> Verdict:
    """Check that clients have a server, and one only."""
    tokens = facts.seen.tokens
    ends = _by_name(each for each in _endpoints(tokens) if each.kind in (SERVICE, CLIENT))
    served = [name for name, found in ends.items() if any(each.kind is SERVICE for each in found)]
    warnings = []
    for name, found in ends.items():
        shown = f"action {name.removesuffix(SEND_GOAL)}" if name.endswith(SEND_GOAL) else f"service {name}"
        clients = [each.full_node_name for each in found if each.kind is CLIENT and not _is_command(each)]
        if name not in served and clients and (not _hidden(name) or name.endswith(SEND_GOAL)):
            meant = nearest(name, _alike(ends, name, SERVICE))
            warnings.append(f"{shown} has no server; {listed(clients)} waits for it{meant}")
        servers = [each.full_node_name for each in found if each.kind is SERVICE]
        if len(set(servers)) > 1:
            warnings.append(f"{shown} has {len(servers)} servers, and each does every call: {listed(servers)}")
    return Verdict(f"{count(len(served), 'service')} served, nobody waits in vain", warnings=tuple(warnings))


def clock(facts: Facts) -> Verdict:
    """Check that simulated time, if it is used, comes from one source."""
    ends = [each for each in _endpoints(facts.seen.tokens) if each.name == "/clock"]
    sources = [each.full_node_name for each in ends if each.kind is PUBLISHER]
    users = [each.full_node_name for each in ends if each.kind is SUBSCRIPTION and not _is_command(each)]
    if len(sources) > 1:
        return Verdict("", (f"{len(sources)} publishers on /clock ({listed(sources)}): time jumps between them",))
    if users and not sources:
        return Verdict("", (), (f"nobody publishes /clock: the time of {listed(users)} stands still",))
    return Verdict(f"/clock is published by {sources[0]}" if sources else "nobody uses simulated time")


def stop(facts: Facts) -> Verdict:
    """Check that STOP does not hold, which keeps robots from moving."""
    return Verdict("STOP does not hold", warnings=(HOLDS,) if facts.seen.stopped else ())


def qos(facts: Facts) -> Verdict:
    """Check that no transient-local subscription has a volatile publisher, which keeps nothing for it."""
    ends = _by_name(each for each in _endpoints(facts.seen.tokens) if each.kind in (PUBLISHER, SUBSCRIPTION))
    warnings = []
    for name, found in ends.items():
        forgetful = [each.full_node_name for each in found if each.kind is PUBLISHER and not _latched(each)]
        waiting = [each for each in found if each.kind is SUBSCRIPTION and not _is_command(each)]
        asking = [each.full_node_name for each in waiting if _latched(each)]
        if forgetful and asking and name != STOP:  # who obeys it has a second subscription, to volatile ones
            warnings.append(
                f"{name}: {listed(asking)} asks for what was published before (TRANSIENT_LOCAL), "
                f"but {listed(forgetful)} keeps nothing (VOLATILE)"
            )
    return Verdict(f"{count(len(ends), 'topic')}, no subscription asks for more than it gets", warnings=tuple(warnings))


def distributions(facts: Facts) -> Verdict:
    """Check that all nodes announce type hashes, or none: Humble's have no hashes."""
    ends = [each for each in _endpoints(facts.seen.tokens) if not _is_command(each)]
    humble = {each.full_node_name for each in ends if each.type_hash == NO_HASH}
    others = {each.full_node_name for each in ends} - humble
    if humble and others:
        newer = f"{listed(others)} of a newer ROS 2"
        warning = f"{listed(humble)} of ROS 2 Humble (no type hashes) and {newer}: they meet only where robolink is one"
        return Verdict("", warnings=(warning,))
    return Verdict("all of ROS 2 Humble" if humble else "all with type hashes, as since Iron")


def _nodes(tokens: Iterable[NodeToken | EndpointToken]) -> list[NodeToken]:
    return [each for each in tokens if isinstance(each, NodeToken)]


def _endpoints(tokens: Iterable[NodeToken | EndpointToken]) -> list[EndpointToken]:
    return [each for each in tokens if isinstance(each, EndpointToken)]


def _by_name(ends: Iterable[EndpointToken]) -> dict[str, list[EndpointToken]]:
    found: dict[str, list[EndpointToken]] = {}
    for each in ends:
        found.setdefault(each.name, []).append(each)
    return dict(sorted(found.items()))


def _alike(ends: dict[str, list[EndpointToken]], name: str, kind: EndpointKind) -> list[str]:
    """Return the names with endpoints of this kind that have one of the types of `name`: what was perhaps meant."""
    types = {each.type_name for each in ends[name]}
    return [other for other, found in ends.items() for each in found if each.kind is kind and each.type_name in types]


def _latched(end: EndpointToken) -> bool:
    return end.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def _is_command(end: EndpointToken) -> bool:
    return end.node_name.startswith(COMMANDS)


def _hidden(name: str) -> bool:
    return "/_" in name


GRAPH_CHECKS = (
    Check("announcements", "middleware", announcements),
    Check("nodes", "node", nodes),
    Check("topic types", "middleware", topic_types),
    Check("service types", "middleware", service_types),
    Check("topics", "topic", topics),
    Check("services", "service", services),
    Check("clock", "topic", clock),
    Check("stop", "topic", stop),
    Check("qos", "middleware", qos),
    Check("distributions", "middleware", distributions),
)
