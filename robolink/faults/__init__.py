"""Fault injection into a network, nodes and clocks, drawn from a seed: read from YAML, or added while a system runs."""

from robolink.faults.description import (
    ClockFault,
    Crash,
    FaultReport,
    FaultsDescription,
    MessageFault,
    Partition,
    Unmet,
    Why,
)
from robolink.faults.file import check_nodes, read_faults
from robolink.faults.injector import Injector
from robolink.faults.network import FaultyNetwork
from robolink.faults.transport import FaultyTransport

__all__ = [
    "ClockFault",
    "Crash",
    "FaultReport",
    "FaultsDescription",
    "FaultyNetwork",
    "FaultyTransport",
    "Injector",
    "MessageFault",
    "Partition",
    "Unmet",
    "Why",
    "check_nodes",
    "read_faults",
]
