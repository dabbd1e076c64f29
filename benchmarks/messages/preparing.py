"""A run's domain, settings and sizes, of a process that imports robolink, so that the one that measures need not."""

from __future__ import annotations

import os

import robolink.compat  # noqa: F401 - the samples are made of ROS 2's names
from benchmarks.messages.games import Task, say
from benchmarks.messages.running import SHM_OFF
from benchmarks.messages.samples import KINDS, sample
from robolink.message import encode
from robolink.networks.request import FIRST_PORT
from robolink.transport.network import load
from robolink.transport.port_sharing import free_domain


def prepare(_: Task) -> None:
    """Say them, and the port that marks the domain as taken."""
    with free_domain() as domain:
        sizes = {kind: len(encode(sample(kind))) for kind in KINDS}
        say({"domain": domain, "mark": FIRST_PORT + domain, "sizes": sizes} | settings(domain))


def settings(domain: int) -> dict[str, str]:
    """Return Zenoh's settings of a robolink session, as JSON: a bare program of Zenoh plays by the same."""
    without = {**os.environ, "ZENOH_CONFIG_OVERRIDE": SHM_OFF}
    return {
        name + end: str(load(None, domain, environ, holds_port=name == "first"))
        for name in ("first", "second")
        for end, environ in (("", dict(os.environ)), ("-", without))
    }
