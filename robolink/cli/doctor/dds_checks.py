"""Checks of ROS 2 over DDS for `robolink doctor`: pure functions of the facts."""

from __future__ import annotations

from robolink.cli.doctor.facts import Check, Facts, Verdict, listed
from robolink.networks.request import RANGE

SMALLEST_BUFFER = 2 << 20
"""Receive buffer in bytes from which images of some megabytes arrive without being repaired."""

_BUFFER_TO_SET = 8 << 20
_BUILTIN = "FASTDDS_BUILTIN_TRANSPORTS"
_SERVER = "ROS_DISCOVERY_SERVER"
_UNMET = {"SHM": "shared memory only", "LARGE_DATA": "TCP, not UDP"}
"""Values of FASTDDS_BUILTIN_TRANSPORTS with which nobody is met from here, and what they use."""


def dds(facts: Facts) -> Verdict:
    """Check that nodes that speak DDS can be met, and are, where there are any."""
    warnings = [*_without_bridge(facts), *_on_other_ways(facts), *_of_environment(facts)]
    summary = "nobody speaks DDS on this machine and domain"
    if facts.dds.nodes:
        summary = f"{_processes(facts.dds.nodes)} with DDS: {_how(facts)}"
    elif facts.dds.bridges:
        summary = "a bridge runs, and nobody else speaks DDS"
    return Verdict(summary, warnings=tuple(warnings))


def _processes(number: int) -> str:
    return f"{number} process{'' if number == 1 else 'es'} of ROS 2"


def _is_on_dds(facts: Facts) -> bool:
    return facts.settings.network == "dds" or facts.settings.transport == "dds"


def _how(facts: Facts) -> str:
    return "this network is theirs" if _is_on_dds(facts) else "a bridge joins them to this network"


def _without_bridge(facts: Facts) -> list[str]:
    """Return the warning that DDS nodes are here and nothing joins them to this network."""
    if not facts.dds.nodes or facts.dds.bridges or facts.seen.bridges or _is_on_dds(facts):
        return []
    speaks = "speaks" if facts.dds.nodes == 1 else "speak"
    there = f"{_processes(facts.dds.nodes)} {speaks} DDS on domain {facts.settings.domain} and this network is Zenoh"
    return [f"{there}: join them with 'robolink bridge dds', or start nodes with --network dds"]


def _on_other_ways(facts: Facts) -> list[str]:
    """Return warnings of processes that speak DDS where only their like meets them."""
    ways = facts.dds.ways
    found = [
        f"{listed(names)} {'is' if len(names) == 1 else 'are'} on {_UNMET[value]} ({_BUILTIN}={value}) and cannot be"
        f" met: start without that variable, or with {_BUILTIN}=DEFAULT"
        for value, names in (("SHM", ways.shared_memory), ("LARGE_DATA", ways.tcp))
        if names
    ]
    if ways.server:
        has = "has" if len(ways.server) == 1 else "have"
        found.append(
            f"{listed(ways.server)} {has} a discovery server ({_SERVER}) and cannot be met: start without that variable"
        )
    return found


def _of_environment(facts: Facts) -> list[str]:
    """Return warnings of settings by which ROS 2 nodes that are started from here could not be met, or hardly."""
    value, found = facts.environ.get(_BUILTIN, "").partition("?")[0].upper(), []
    # With LOCALHOST rmw_fastrtps chooses shared memory and UDP, whatever the variable says.
    if value in _UNMET and facts.environ.get(RANGE, "").upper() != "LOCALHOST":
        found.append(
            f"{_BUILTIN}={value}: ROS 2 nodes started from here are on {_UNMET[value]} and cannot be met: unset it"
        )
    size = facts.dds.receive_buffer
    if size is not None and size < SMALLEST_BUFFER and (facts.dds.nodes or facts.dds.bridges or _is_on_dds(facts)):
        found.append(
            f"net.core.rmem_max is {size:,} bytes: images over DDS are late, since packets are lost and sent again:"
            f" sudo sysctl -w net.core.rmem_max={_BUFFER_TO_SET} (in a file of /etc/sysctl.d to stay)"
        )
    return found


DDS_CHECKS = (Check("dds", "network", dds),)
