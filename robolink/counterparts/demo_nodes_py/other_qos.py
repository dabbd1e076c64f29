"""Talker and listener with another quality of service, for a number of callbacks."""

from __future__ import annotations

import argparse
from collections.abc import Callable

import robolink
from robolink.counterparts.program import own_words, spin_times
from robolink.node import Node
from robolink.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data


def run(what: str, kind: Callable[[str, QoSProfile], Node], args: list[str] | None) -> None:
    """Run a node `what` of a class as the command line says: `--reliable`, `-n NUMBER`."""
    parser = argparse.ArgumentParser(f"{what}_qos")
    parser.add_argument("--reliable", action="store_true", help="reliable, not best effort")
    parser.add_argument("-n", "--number_of_cycles", type=int, default=20, help="callbacks after which it ends")
    asked = parser.parse_args(own_words(args))
    reliable = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)

    def make() -> Node:
        node = kind(f"{what}_qos", reliable if asked.reliable else qos_profile_sensor_data)
        node.get_logger().info(f"{'Reliable' if asked.reliable else 'Best effort'} {what}")
        return node

    with robolink.init(args=args):
        spin_times(make, asked.number_of_cycles)
