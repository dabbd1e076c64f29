"""Discovery times of two machines: how soon they see each other on `lan`, and how soon all of a named HOST is there.

    python -m tests.support.meetings [lan | host ...] [--rounds 5]

In network namespaces (Linux, root). `lan`: a cable joins the two; a node is on one of them already, and one starts on
the other, in either order. Prints the seconds from the later's `init()` until both have seen the other's node (asked:
0.5). `host`: the kernel routes between the two, so that no multicast passes; the laptop names the robot, which does not
know it. Prints the seconds from the laptop's `init()` until it has had an answer of a service and of a parameter, an
action's result, transforms and a latched map of 10 MB (asked: 1). With `--node NAME --other NAME` it is one of the
nodes.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from contextlib import ExitStack

import robolink
from tests.support import stalls
from tests.support.domains import free_domain
from tests.support.machines import THERE, Machines
from tests.support.obedient import line, start
from tests.support.pulse import say
from tests.support.robot_and_laptop import PLAY
from tests.support.stalls import PATIENCE


def seconds_on_lan(*, first: int) -> float:
    """Start a node on each of two machines, on number `first` (0 or 1) before; return when both had seen the other."""
    with ExitStack() as stack:
        hosts = stack.enter_context(stalls.two_hosts())
        domain = stack.enter_context(free_domain())
        clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}
        environ = clean | {"ROS_DOMAIN_ID": str(domain), "ROBOLINK_NETWORK": "lan"}
        children, began = [], 0.0
        for name, other, host in (("early", "late", hosts[first]), ("late", "early", hosts[1 - first])):
            words = ["-m", "tests.support.meetings", "--node", name, "--other", other]
            children.append(start(stack, ["ip", "netns", "exec", host, sys.executable, *words], environ))
            began = float(line(children[-1]))
            assert line(children[-1]) == "made"
        return max(float(line(each)) for each in children) - began


def seconds_with_host() -> float:
    """Run a laptop that names a robot and uses all that it has; return its seconds."""
    with ExitStack() as stack:
        machines = Machines(stack)
        machines.start(machines.there, PLAY, "robot", ROBOLINK_NETWORK="lan")
        done = machines.run_here([sys.executable, "-c", PLAY, "laptop"], ROBOLINK_NETWORK=THERE)
        return float(json.loads(done.stdout)["seconds"])


def be_node(name: str, other: str) -> None:
    """Print when `init()` began, that the node is made, and when the other one was seen, by the machine's clock."""
    say(time.monotonic())
    robolink.init(args=[])
    node = robolink.Node(name)
    say("made")
    graph = node.context.graph
    assert graph.wait_for(lambda: other in {each.node_name for each in graph.nodes()}, PATIENCE), "nobody came"
    say(time.monotonic())
    sys.stdin.read()
    robolink.shutdown()


def main() -> None:
    """Play the meetings, or be one of the nodes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="lan | host")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--node")
    parser.add_argument("--other")
    asked = parser.parse_args()
    if asked.node:
        be_node(asked.node, asked.other)
        return
    for scene in asked.scenes or ("lan", "host"):
        for number in range(2 * asked.rounds if scene == "lan" else asked.rounds):
            first = number % 2
            took = seconds_on_lan(first=first) if scene == "lan" else seconds_with_host()
            print(f"{scene}{f', machine {first + 1} first' * (scene == 'lan')}: {took:.2f} s", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
