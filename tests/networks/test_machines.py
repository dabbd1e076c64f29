"""Two machines, in network namespaces, that one side's `--network HOST` joins where no multicast passes."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from tests.support import stalls
from tests.support.machines import NODE, ROUTER, THERE, Machines, nodes

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]

MAP = 10_000_000

ROBOT = f"""
import os, sys, threading
import robolink as rclpy
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile

rclpy.init()
node = Node("robot")
node.declare_parameter("speed", 0.5)
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
publisher = node.create_publisher(OccupancyGrid, "map", latched)
publisher.publish(OccupancyGrid(data=bytes({MAP})))
node.create_service(Trigger, "go", lambda request, response: Trigger.Response(success=True, message="gone"))
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
"""

LAPTOP = """
import json
import robolink as rclpy
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.node import Node
from robolink.parameter_client import AsyncParameterClient
from robolink.qos import DurabilityPolicy, QoSProfile

rclpy.init()
node = Node("laptop")
sizes = []
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
node.create_subscription(OccupancyGrid, "map", lambda message: sizes.append(len(message.data)), latched)
service, parameters = node.create_client(Trigger, "go"), AsyncParameterClient(node, "robot")
assert service.wait_for_service(60)
called = service.call_async(Trigger.Request())
rclpy.spin_until_future_complete(node, called, timeout_sec=60)
assert parameters.wait_for_services(60)
asked = parameters.get_parameters(["speed"])
rclpy.spin_until_future_complete(node, asked, timeout_sec=60)
while not sizes:
    rclpy.spin_once(node, timeout_sec=60)
print(json.dumps([called.result().message, asked.result().values[0].double_value, sizes]))
"""


@pytest.fixture
def machines() -> Iterator[Machines]:
    with ExitStack() as stack:
        yield Machines(stack)


def nodes_once_seen(machines: Machines, expected: list[str], **environ: str) -> list[str]:
    """Return the nodes that `doctor` sees, at the latest in the moment when these are all: a link may take a while."""
    deadline = time.monotonic() + 60.0
    while (found := nodes(machines.doctor(**environ))) != expected and time.monotonic() < deadline:
        pass
    return found


def test_a_host_named_on_one_side_suffices(machines: Machines) -> None:
    """Services, parameters and a latched map, from a robot of two processes on `lan`."""
    machines.start(machines.there, NODE, "first", ROBOLINK_NETWORK="lan")  # which holds the port
    machines.start(machines.there, ROBOT, ROBOLINK_NETWORK="lan")
    done = machines.run_here([sys.executable, "-c", LAPTOP], ROBOLINK_NETWORK=THERE)
    assert done.stderr == ""
    assert json.loads(done.stdout) == ["gone", 0.5, [MAP]]
    assert nodes_once_seen(machines, ["/first", "/robot"], ROBOLINK_NETWORK=THERE) == ["/first", "/robot"]


def test_the_processes_here_meet_each_other_too(machines: Machines) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    for name in ("near", "nearer"):
        machines.start(machines.here, NODE, name, ROBOLINK_NETWORK=THERE)
    everybody = ["/far", "/near", "/nearer"]
    assert nodes_once_seen(machines, everybody, ROBOLINK_NETWORK=THERE) == everybody


def test_newcomers_find_the_others_when_the_first_process_has_ended(machines: Machines) -> None:
    """It has held the port, which is all that they know; another process has taken it then."""
    first = machines.start(machines.there, NODE, "first", ROBOLINK_NETWORK="lan")
    for name in ("second", "third"):
        machines.start(machines.there, NODE, name, ROBOLINK_NETWORK="lan")
    everybody = ["/first", "/second", "/third"]
    assert nodes_once_seen(machines, everybody, ROBOLINK_NETWORK=THERE) == everybody
    first.kill()
    assert nodes_once_seen(machines, everybody[1:], ROBOLINK_NETWORK=THERE) == everybody[1:]


def test_a_router_on_the_robot_opens_the_way_to_local_nodes(machines: Machines) -> None:
    machines.start(machines.there, ROUTER)
    machines.start(machines.there, NODE, "local")
    found = machines.doctor(ROBOLINK_NETWORK=THERE)
    assert (nodes(found), found["checks"]["reach"]["level"]) == (["/local"], "ok")


def test_a_name_of_the_file_of_networks(machines: Machines, tmp_path_factory: pytest.TempPathFactory) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    folder = tmp_path_factory.mktemp("workspace")
    (folder / "networks.yaml").write_text(f"robot: {THERE}\npeers: {{peers: [{THERE}]}}\n")
    for name in ("robot", "peers"):
        assert nodes_once_seen(machines, ["/far"], ROBOLINK_NETWORK=name, ROBOLINK_WORKSPACE=str(folder)) == ["/far"]


def test_nobody_answers(machines: Machines) -> None:
    machines.start(machines.there, NODE, "local")  # whom nobody reaches
    done = machines.run_here([sys.executable, "-m", "robolink", "--network", THERE, "topic", "list"])
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"robolink: ROBOLINK_NETWORK: nobody answers at {THERE}, no robolink process (port ")
    assert done.stderr.count("\n") == 1


def test_a_launch_joins_its_files_network_once(machines: Machines, tmp_path_factory: pytest.TempPathFactory) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    folder = tmp_path_factory.mktemp("workspace")
    (folder / "look.yaml").write_text(f"network: {THERE}\nnodes: [run: [robolink, node, list]]\n")
    done = machines.run_here([sys.executable, "-m", "robolink", "launch", os.fspath(folder / "look.yaml")])
    assert "/far" in done.stdout + done.stderr
    (folder / "look.yaml").write_text("network: 10.78.0.1:9\nnodes: [run: [robolink, node, list]]\n")
    done = machines.run_here([sys.executable, "-m", "robolink", "launch", os.fspath(folder / "look.yaml")])
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert "nobody answers at 10.78.0.1, port 9" in done.stderr


def test_our_router_opens_the_way_to_local_nodes(machines: Machines) -> None:
    machines.command(machines.there, "router", "--listen", "lan")
    machines.start(machines.there, NODE, "local")
    assert nodes_once_seen(machines, ["/local"], ROBOLINK_NETWORK=THERE) == ["/local"]


def test_two_routers_join_two_machines_whose_nodes_stay_local(machines: Machines) -> None:
    machines.command(machines.there, "router", "--listen", "lan")
    machines.start(machines.there, NODE, "far")
    machines.command(machines.here, "router", "--connect", THERE)
    machines.start(machines.here, NODE, "near")
    assert nodes_once_seen(machines, ["/far", "/near"]) == ["/far", "/near"]
