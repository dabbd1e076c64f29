"""Benchmark of virtual time: one minute of a simulated world and a controller, in memory.

    python benchmarks/virtual_time.py [--runs 5] [--seconds 60]

Everything is published, encoded and decoded as over a network; nothing is logged.
"""

from __future__ import annotations

import argparse
import statistics
import time
from typing import Any

from robolink import Context, VirtualTime, logging
from robolink.executors import SingleThreadedExecutor
from robolink.parameter import Parameter
from robolink.task import Future
from robolink.workspace import find_node, load_node

SYSTEMS = (("wall_follower", "corners"), ("reactive_controller", "obstacles"))


def life(controller: str, world: str, seconds: float) -> float:
    """Run the system for so long in its own time; give the seconds that this took."""
    context = Context(transport="memory://benchmark", time=VirtualTime())
    context.init(args=[])
    with context, SingleThreadedExecutor(context=context) as executor:
        begin = time.perf_counter()
        for name, parameters in (("world", [Parameter("world", value=world)]), (controller, [])):
            make: Any = load_node(find_node(name))
            executor.add_node(make(context=context, parameter_overrides=parameters))
        executor.spin_until_future_complete(Future(), timeout_sec=seconds)
        return time.perf_counter() - begin


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=60.0)
    options = parser.parse_args()
    logging.set_console_handler(None)
    for controller, world in SYSTEMS:
        median = statistics.median(life(controller, world, options.seconds) for _ in range(options.runs))
        times = options.seconds / median
        print(f"{controller} in {world}: {options.seconds:g} s in {median:.2f} s, {times:.0f} times as fast as life")


if __name__ == "__main__":
    main()
