"""All that a simulated system publishes, byte for byte: for tests in which it must be the same twice.

    python -m tests.traces [SECONDS]

prints the hash of a laboratory's life with noise on everything, its robots under controllers, for comparing processes
and Pythons.
"""

from __future__ import annotations

import sys
from typing import Any

from robolink import Context, Parameter, VirtualTime, logging
from robolink.executors import SingleThreadedExecutor
from robolink.oneprocess.trace import Trace
from robolink.qos import QoSProfile
from robolink.transport import Outlet
from robolink.transport.memory import Bus, MemoryTransport
from tests.nodefiles import load_node_file
from tests.spins import spin_for


class TappedTransport(MemoryTransport):
    """A session on a bus of its own that notes what it publishes."""

    def __init__(self, trace: Trace) -> None:
        super().__init__(bus=Bus())
        self.trace = trace

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        return self.trace.tapped(key, super().advertise(key, qos))


def follow(seconds: float, speed: float) -> Trace:
    """Let a robot follow the walls of the cornered room; give all that was published."""
    parameters = [Parameter("speed", value=speed)]
    return _live(seconds, "corners", ("wall_follower", "WallFollower", "", parameters))


def laboratory(seconds: float) -> Trace:
    """Let both robots of the laboratory drive by what their noisy lidars tell; give all that was published."""
    follower = ("wall_follower", "WallFollower", "/ada", [Parameter("side", value="left")])
    return _live(seconds, "lab", follower, ("reactive_controller", "ReactiveController", "/bob", []))


def _live(seconds: float, world: str, *controllers: tuple[str, str, str, list[Parameter[Any]]]) -> Trace:
    trace = Trace()
    context = Context(transport=TappedTransport(trace), time=VirtualTime())
    context.init([])
    with context, SingleThreadedExecutor(context=context) as executor:
        simulated = load_node_file("world").SimulatedWorld
        executor.add_node(simulated(context=context, parameter_overrides=[Parameter("world", value=world)]))
        for file, name, namespace, parameters in controllers:
            make = getattr(load_node_file(file), name)
            executor.add_node(make(context=context, namespace=namespace, parameter_overrides=parameters))
        spin_for(executor, seconds)
    return trace


if __name__ == "__main__":
    logging.set_console_handler(None)
    sys.stdout.write(laboratory(float(sys.argv[1]) if len(sys.argv) > 1 else 10.0).hexdigest() + "\n")
