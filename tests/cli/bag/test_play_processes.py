"""`robolink bag play` as a process, over Zenoh: heard, steered by its services, and ended by a service or a signal."""

from __future__ import annotations

import queue
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.interfaces.rosbag2_interfaces.srv import IsPaused, Resume, Stop
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.std_msgs.msg import String
from robolink.transport.zenoh import ZenohTransport
from tests.support.players import START, counting
from tests.support.programs import Program
from tests.support.seen_by_commands import spinning

pytestmark = pytest.mark.processes

PATIENCE = 60.0
PLAYER = """
import sys
from robolink.cli.main import main
sys.exit(main())
"""
WORDS = ["--disable-keyboard-controls", "-p", "-l", "-r", "20", "--clock", "50", "-m", "/count:=/again"]


@pytest.fixture
def node(domain: int) -> Iterator[Node]:
    context = Context(transport=ZenohTransport(domain, environ={}))
    context.init([], domain_id=domain)
    with context:
        node = Node("listener", context=context)
        with spinning(node):
            yield node


def call(node: Node, kind: Any, name: str) -> Any:
    client = node.create_client(kind, f"/rosbag2_player/{name}")
    assert client.wait_for_service(PATIENCE)
    return client.call(kind.Request(), timeout_sec=PATIENCE)


@pytest.mark.parametrize("end", ["stop", "interrupt", "terminate"])
def test_a_bag_is_played_to_other_processes_until_somebody_ends_it(
    end: str, node: Node, tmp_path: Path, domain: int
) -> None:
    if sys.platform == "win32" and end == "terminate":
        pytest.skip("Windows has no SIGTERM that a program could catch")
    said, times = queue.SimpleQueue[str](), queue.SimpleQueue[int]()
    node.create_subscription(String, "/again", lambda message: said.put(message.data), 100)
    node.create_subscription(Clock, "/clock", lambda message: times.put(message.clock.sec - START // 10**9), 100)
    with Program(tmp_path, PLAYER, domain, "bag", "play", str(counting(tmp_path / "bag")), *WORDS) as player:
        assert call(node, IsPaused, "is_paused").paused
        call(node, Resume, "resume")  # it knows the subscriptions, since it has answered
        assert heard(said, 5) == {"0", "1", "2", "3", "4"}
        assert heard(times, 2) <= {0, 1, 2, 3, 4}
        if end == "stop":
            client = node.create_client(Stop, "/rosbag2_player/stop")
            assert client.wait_for_service(PATIENCE)
            client.call_async(Stop.Request())  # it may end before it answers
        else:
            getattr(player, end)()
        assert player.end() == 0, player.errors
    assert not any("Traceback" in each for each in player.errors)


def heard(came: queue.SimpleQueue[Any], count: int) -> set[Any]:
    """Return so many different values, as soon as they have come."""
    found: set[Any] = set()
    while len(found) < count:
        found.add(came.get(timeout=PATIENCE))
    return found
