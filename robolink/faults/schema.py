"""JSON schema of faults files, by which editors complete and check them."""

from __future__ import annotations

from typing import Any

from robolink.documents.json_schema import schema_of
from robolink.faults.description import FaultsDescription

MEANINGS = {
    "FaultsDescription.description": "What the faults are like, in one line.",
    "FaultsDescription.seed": "Seed of their random numbers, unless the run itself is given one.",
    "FaultsDescription.messages": "Losses, delays and duplications of messages.",
    "FaultsDescription.partitions": "Partitions of the network.",
    "FaultsDescription.crashes": "Crashes of nodes.",
    "FaultsDescription.clocks": "Wrong clocks of nodes.",
    "MessageFault.topic": "Topics, as name or pattern; all by default.",
    "MessageFault.service": "Services, as name or pattern.",
    "MessageFault.from": "Nodes that send; all by default.",
    "MessageFault.to": "Nodes that receive; all by default.",
    "MessageFault.loss": "Probability of a loss, 0 to 1.",
    "MessageFault.burst": "Messages that are lost in a row, on average.",
    "MessageFault.duplication": "Probability that a message comes twice, 0 to 1.",
    "MessageFault.latency": "Delay in seconds.",
    "MessageFault.jitter": "Seconds by which the delay varies, up and down.",
    "MessageFault.reorder": "True: messages may overtake each other.",
    "Partition.between": "Groups of nodes that do not reach each other.",
    "Crash.node": "Node whose process is killed.",
    "Crash.at": "When, in seconds of the run.",
    "Crash.restart_after": "Seconds until it is started again; without it the launch file's rules apply.",
    "ClockFault.node": "Nodes whose clock is wrong.",
    "ClockFault.offset": "Seconds that the clock is ahead; negative: behind.",
    "ClockFault.drift": "Seconds that the clock gains in each second.",
    "after": "When it begins, in seconds of the run.",
    "until": "When it ends, in seconds of the run; its end by default.",
}
"""Descriptions of keys, which editors show: by Struct and key, or by a key that means the same in several."""


def faults_schema() -> dict[str, Any]:
    """Return the schema as plain data."""
    return schema_of(FaultsDescription, "Faults of robolink simulate", MEANINGS)
