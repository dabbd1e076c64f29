"""What waits for something else is released when that is announced, and told of when it waits long."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import Context, Node
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.launch import processes, read_launch_file
from robolink.launch.readiness import Awaited, Readiness, names_in, waiting
from robolink.transport.memory import MemoryTransport
from robolink.wire import graph_pattern
from robolink.workspace import VARIABLE, NodeSource
from tests.support.seen_by_commands import a_node_that_commands_see, made

PATIENCE = 30.0
NEVER = 1000.0

FILES = {
    "plain": "from robolink import Node\nclass Plain(Node): pass\n",
    "named": "class Named(Node):\n    def __init__(self):\n        super().__init__('camera_driver')\n",
    "by_key": "node = rclpy.create_node(node_name='left')\nother = Node('right', namespace='x')\nprint('no name')\n",
    "broken": "class",
}


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    for name, text in FILES.items():
        (tmp_path / "nodes" / f"{name}.py").write_text(text)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path.resolve()


def held(home: Path, text: str) -> dict[str, tuple[Awaited, ...]]:
    entries = read_launch_file(home / "configs" / "lap.yaml", text=text)
    return {each.name: each.held_by for each in processes(entries)}


def test_names_are_those_that_the_waiting_node_means(home: Path) -> None:
    found = held(
        home,
        """
nodes:
- {node: plain, namespace: r1}
- {node: named, namespace: r1}
- {node: named, name: given}
- node: plain
  name: waits
  namespace: r1
  remappings: {scan: lidar/scan, reset: /world/reset, other: x}
  start_after: [plain, named, {node: /given}, {topic: scan}, {service: reset}, {topic: ~/mine}, {topic: /else}]
""",
    )
    assert found.pop("r1/waits") == (
        Awaited("node", ("/r1/plain",)),
        Awaited("node", ("/r1/named", "/r1/camera_driver")),
        Awaited("node", ("/given",)),
        Awaited("topic", ("/r1/lidar/scan",)),
        Awaited("service", ("/world/reset",)),
        Awaited("topic", ("/r1/waits/mine",)),
        Awaited("topic", ("/else",)),
    )
    assert set(found.values()) == {()}


def test_nodes_of_one_process_wait_for_all_that_one_of_them_waits_for(home: Path) -> None:
    found = held(
        home,
        """
nodes:
- {node: plain, name: a, process: p, start_after: {topic: x}}
- {node: plain, name: b, process: p, start_after: [{topic: x}, {service: y}]}
""",
    )
    assert found == {"p": (Awaited("topic", ("/x",)), Awaited("service", ("/y",)))}


def test_names_are_read_from_the_code(home: Path) -> None:
    found = {name: names_in(NodeSource(name, home / "nodes" / f"{name}.py")) for name in FILES}
    assert found == {"plain": [], "named": ["camera_driver"], "by_key": ["left", "right"], "broken": []}
    two = home / "nodes" / "two.py"
    two.write_text("class A(Node):\n def f(self): super().__init__('a')\nclass B(Node):\n def f(self): Node('b')\n")
    assert [names_in(NodeSource("two", two, each)) for each in ("A", "B", "main", "")] == [
        ["a"],
        ["b"],
        *2 * [["a", "b"]],
    ]
    assert names_in(NodeSource("gone", home / "gone.py")) == []


def test_a_process_is_ready_once_when_all_is_there_at_the_same_time(robot: Node) -> None:
    robot.create_publisher(String, "/a", 10)
    robot.create_service(Trigger, "/b", lambda request, response: response)
    tokens = robot.context.transport.tokens(graph_pattern())
    [a] = [each for each in tokens if "%a" in each and "/MP/" in each]
    [b] = [each for each in tokens if "%b" in each and "/SS/" in each]
    ab = [Awaited("topic", ("/a",)), Awaited("service", ("/c", "/b"))]
    readiness = Readiness({"ab": ab, "a": ab[:1], "free": []})
    assert readiness.held == ["ab", "a"]
    assert [readiness.note_token(*each) for each in ((a, True), (a, False), (b, True))] == [["a"], [], []]
    assert readiness.missing() == {"ab": ab[:1]}
    assert [readiness.note_token(*each) for each in ((a, True), (a, True), ("nonsense", True))] == [["ab"], [], []]
    assert [readiness.knows(each) for each in (a, b, tokens[0], "nonsense")] == [True, True, False, False]
    assert readiness.held == []


# --- on the network -------------------------------------------------------------------------------------------


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as node:
        yield node


def test_each_is_released_when_all_is_there_and_then_nobody_looks(robot: Node) -> None:
    released: queue.SimpleQueue[str] = queue.SimpleQueue()
    said: list[str] = []
    transport = robot.context.transport
    assert isinstance(transport, MemoryTransport)
    before = len(transport.bus.watches)
    waits = {
        "one": [Awaited("topic", ("/a",)), Awaited("service", ("/b",))],
        "two": [Awaited("node", ("/x", "/y"))],
        "now": [Awaited("node", ("/lab/robot",))],
    }
    with waiting(waits, released.put, said.append, patience=NEVER):
        assert released.get(timeout=PATIENCE) == "now"
        robot.create_subscription(String, "/a", print, 10)
        robot.create_client(Trigger, "/b")
        robot.create_service(Trigger, "/b", lambda request, response: response)
        with made(robot.context, "y") as other:
            assert released.get(timeout=PATIENCE) == "two"
            other.create_publisher(String, "/a", 10)
            assert released.get(timeout=PATIENCE) == "one"
        wait_for(lambda: len(transport.bus.watches) == before)
    assert released.empty()
    assert said == []


def wait_for(condition: object) -> None:
    assert callable(condition)
    pause = threading.Event()
    for _ in range(3000):
        if condition():
            return
        pause.wait(0.01)
    raise AssertionError("it did not come true")


def test_what_has_gone_again_is_not_there(robot: Node) -> None:
    released: queue.SimpleQueue[str] = queue.SimpleQueue()
    waits = {
        "both": [Awaited("topic", ("/a",)), Awaited("topic", ("/b",))],
        "a": [Awaited("topic", ("/a",))],
        "b": [Awaited("topic", ("/b",))],
    }
    with waiting(waits, released.put, print, patience=NEVER):
        publisher = robot.create_publisher(String, "/a", 10)
        assert released.get(timeout=PATIENCE) == "a"
        robot.destroy_publisher(publisher)
        robot.create_publisher(String, "/b", 10)
        assert released.get(timeout=PATIENCE) == "b"
        assert released.empty()
        robot.create_publisher(String, "/a", 10)
        assert released.get(timeout=PATIENCE) == "both"


def test_what_waits_long_is_told_of_once_with_what_it_misses(robot: Node) -> None:
    said: queue.SimpleQueue[str] = queue.SimpleQueue()
    released: queue.SimpleQueue[str] = queue.SimpleQueue()
    robot.create_publisher(String, "/there", 10)
    waits = {
        "follower": [
            Awaited("topic", ("/there",)),
            Awaited("service", ("/world/reset",)),
            Awaited("node", ("/x", "/y")),
        ],
        "other": [Awaited("topic", ("/scan",))],
    }
    with waiting(waits, released.put, said.put, patience=0.0):
        told = [said.get(timeout=PATIENCE), said.get(timeout=PATIENCE)]
        robot.create_publisher(String, "/scan", 10)
        assert released.get(timeout=PATIENCE) == "other"
    lines = [
        "follower waits for service /world/reset: nobody serves it yet and node /x: it is not there yet",
        "other waits for topic /scan: nobody publishes it yet",
    ]
    assert told[1:] == lines[1:]
    assert told[0].endswith(lines[0].removeprefix("follower waits for "))  # /there may not be known yet
    assert said.empty()


def test_without_a_network_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    said: queue.SimpleQueue[str] = queue.SimpleQueue()
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "pigeon")
    with waiting({"a": [Awaited("topic", ("/x",))]}, print, said.put):
        assert said.get(timeout=PATIENCE).startswith("cannot look for what a waits for: ")


def test_nobody_looks_when_nothing_is_held(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "pigeon")
    before = set(threading.enumerate())
    with waiting({}, print, pytest.fail):
        assert set(threading.enumerate()) <= before


def test_nonsense_that_is_announced_is_passed_over(robot: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    released: queue.SimpleQueue[str] = queue.SimpleQueue()
    with waiting({"a": [Awaited("topic", ("/a",))]}, released.put, print, patience=NEVER):
        robot.context.transport.announce("@ros2_lv/7/nonsense")
        robot.create_publisher(String, "/a", 10)
        assert released.get(timeout=PATIENCE) == "a"


def test_over_zenoh(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    released: queue.SimpleQueue[str] = queue.SimpleQueue()
    with waiting({"a": [Awaited("node", ("/ns/late",))]}, released.put, print, patience=NEVER):
        context = Context()
        context.init([])
        with context, made(context, "late", "/ns"):
            assert released.get(timeout=PATIENCE) == "a"
