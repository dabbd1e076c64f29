"""Report of `robolink doctor --report`: all facts, in the sections of ros2 doctor's."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from typing import NamedTuple

from robolink.cli.doctor.facts import Facts
from robolink.cli.doctor.graph_checks import SILENT_TOPICS
from robolink.networks.request import FIRST_PORT
from robolink.wire import EndpointKind, EndpointToken, NodeToken

_ROS = ("ROS_", "RMW_", "ZENOH_", "ROBOLINK_", "AMENT_")
_NARROWEST = 8


class Section(NamedTuple):
    """Section of the report: a heading, and rows of two columns."""

    name: str
    module: str
    """Module of the checks that it belongs to, in ros2 doctor's words."""
    items: list[tuple[str, str]]

    def lines(self) -> Iterator[str]:
        """Yield its lines as ros2 doctor prints them: in two columns."""
        width = max([len(name) for name, _ in self.items], default=0)
        width = width + 4 if width >= _NARROWEST else _NARROWEST
        yield f"\n   {self.name}"
        for name, value in self.items:
            yield f"{name:{width}}: {value}"


def sections(facts: Facts) -> list[Section]:
    """Return all sections of the report."""
    return [
        Section("NETWORK CONFIGURATION", "network", _network(facts)),
        Section("DOMAINS", "network", _domains(facts)),
        Section("PLATFORM INFORMATION", "platform", _platform(facts)),
        Section("PACKAGE VERSIONS", "platform", [(name, found or "none") for name, found in facts.versions.items()]),
        Section("ROS 2 INFORMATION", "platform", _variables(facts)),
        Section("RMW MIDDLEWARE", "middleware", _middleware(facts)),
        Section("NODE LIST", "node", _nodes(facts)),
        Section("TOPIC LIST", "topic", _topics(facts)),
        Section("SERVICE LIST", "service", _services(facts)),
        Section("QOS COMPATIBILITY LIST", "middleware", _pairs(facts)),
    ]


def _network(facts: Facts) -> list[tuple[str, str]]:
    settings = facts.settings
    return [
        ("network", settings.network),
        ("asked for by", settings.origin or "nobody (the default)"),
        ("transport", settings.transport),
        ("nodes meet", str(facts.reach)),
        *(("link", f"{each.role} at {each.there}") for each in facts.seen.links),
        ("domain id", str(settings.domain)),
        ("rendezvous port", f"{settings.port} ({_on(facts, settings.port)})" if settings.meets else "not used"),
        ("ROS 2 router's port", f"{facts.router_port} ({_on(facts, facts.router_port)})"),
        ("loopback", "works" if facts.loopback else "does not work"),
        ("shared memory", f"{'on' if facts.memory.on else 'off'}: {facts.memory.reason}"),
        ("firewall", "not looked at"),
        *(("error", each) for each in settings.errors),
    ]


def _on(facts: Facts, number: int) -> str:
    port, holder = facts.ports.get(number), facts.holders.get(number)
    if port is None:
        return "nobody listens"
    who = f"Zenoh {port.role}, session {port.session}" if port.speaks_zenoh else f"a stranger: {port.role}"
    return f"{who}, pid {holder.pid}: {holder.command}" if holder else who


def _domains(facts: Facts) -> list[tuple[str, str]]:
    own = sum(isinstance(each, NodeToken) for each in facts.seen.tokens)
    rows: dict[int, int | None] = {**facts.other_domains, facts.settings.domain: None if facts.seen.error else own}
    return [
        (f"domain {each}", f"port {FIRST_PORT + each}, {'not counted' if nodes is None else f'nodes: {nodes}'}")
        for each, nodes in sorted(rows.items())
    ]


def _platform(facts: Facts) -> list[tuple[str, str]]:
    machine = facts.machine
    lockable = "any" if machine.lockable is None else f"{machine.lockable // 2**20} MB"
    space = f"{machine.free // 2**20} of {machine.total // 2**20} MB free" if machine.total else "none"
    mac = [("mac OS version", platform.mac_ver()[0])] if facts.platform == "darwin" else []
    return [
        ("system", platform.system()),
        ("platform info", platform.platform()),
        *mac,
        ("release", platform.release()),
        ("processor", platform.processor() or platform.machine()),
        ("python", f"{platform.python_version()} ({platform.python_implementation()})"),
        ("/dev/shm", space),
        ("lockable memory", lockable),
        *((f"clock of {each.node}", f"{each.seconds:+.6f} s, +-{each.uncertainty:.6f}") for each in facts.seen.clocks),
    ]


def _variables(facts: Facts) -> list[tuple[str, str]]:
    found = [(name, value) for name, value in sorted(facts.environ.items()) if name.startswith(_ROS)]
    return found or [("variables", "none set")]


def _middleware(facts: Facts) -> list[tuple[str, str]]:
    seen = facts.seen
    return [
        ("middleware name", "rmw_zenoh_cpp (spoken by robolink)"),
        ("session", seen.session or "none"),
        ("processes", str(len({each.session for each in seen.tokens}))),
        *(("malformed", ascii(each[:200])) for each in seen.malformed),
        *([("error", seen.error)] if seen.error else []),
    ]


def _nodes(facts: Facts) -> list[tuple[str, str]]:
    nodes = sorted(each for each in facts.seen.tokens if isinstance(each, NodeToken))
    return [("node", f"{each.full_node_name} (session {each.session[:8]})") for each in nodes] or [("node", "none")]


def _topics(facts: Facts) -> list[tuple[str, str]]:
    return _ends(facts, "topic", {"publisher": EndpointKind.PUBLISHER, "subscriber": EndpointKind.SUBSCRIPTION})


def _services(facts: Facts) -> list[tuple[str, str]]:
    return _ends(facts, "service", {"service": EndpointKind.SERVICE, "client": EndpointKind.CLIENT})


def _ends(facts: Facts, noun: str, kinds: dict[str, EndpointKind]) -> list[tuple[str, str]]:
    items = []
    ends = [each for each in _endpoints(facts) if each.kind in kinds.values() and each.name not in SILENT_TOPICS[:2]]
    for name in sorted({each.name for each in ends}):
        items.append((noun, name))
        for word, kind in kinds.items():
            found = sum(each.name == name and each.kind is kind for each in ends)
            items.append((f"{word} count", str(found)))
    return items or [(noun, "none"), *((f"{word} count", "0") for word in kinds)]


def _pairs(facts: Facts) -> list[tuple[str, str]]:
    items = []
    ends = [each for each in _endpoints(facts) if each.name not in SILENT_TOPICS[:2]]
    hearing = [each for each in ends if each.kind is EndpointKind.SUBSCRIPTION]
    for giving in (each for each in ends if each.kind is EndpointKind.PUBLISHER):
        for taking in (each for each in hearing if each.name == giving.name):
            items += [
                ("topic [type]", f"{giving.name} [{giving.type_name}]"),
                ("publisher node", giving.full_node_name),
                ("subscriber node", taking.full_node_name),
                ("compatibility status", _status(giving, taking)),
            ]
    return items or [("compatibility status", "No publisher/subscriber pairs found")]


def _status(giving: EndpointToken, taking: EndpointToken) -> str:
    """Return "OK", or a warning: Zenoh refuses no QoS, but a volatile publisher has kept nothing for late joiners."""
    if taking.qos.durability < giving.qos.durability:
        return "WARNING: transient local subscription of a volatile publisher: nothing that was published before comes"
    return "OK"


def _endpoints(facts: Facts) -> list[EndpointToken]:
    return [each for each in facts.seen.tokens if isinstance(each, EndpointToken)]
