"""Systems under test that are processes: started, watched, killed, and none of them left."""

from __future__ import annotations

import sys
import threading
import time
import uuid
from pathlib import Path

import pytest

from robolink import Node
from robolink.exceptions import NotFoundError
from robolink.interfaces.std_msgs.msg import Int32
from robolink.testing import ExpectationError, NodeFailure, System
from robolink.testing.expectations import OnlyInMemoryError
from robolink.testing.recorder import Recorder, Topic
from tests.support.commands import MARK
from tests.support.counting import Doubler
from tests.support.domains import free_domain
from tests.support.nodefiles import load_node_file

pytest_plugins = ["pytester"]
pytestmark = pytest.mark.processes

PATIENCE = 60.0


@pytest.fixture
def mark(monkeypatch: pytest.MonkeyPatch) -> str:
    """What all processes have in their environment that are started meanwhile."""
    made = uuid.uuid4().hex
    monkeypatch.setenv(MARK, made)
    return made


def left(mark: str) -> list[str]:
    """The processes that still run, without this one; known only where /proc is."""
    wanted = f"{MARK}={mark}".encode()
    return [each.parent.name for each in Path("/proc").glob("[0-9]*/environ") if wanted in _read(each)]


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:
        return b""


LAUNCH = """
nodes:
  - {node: world, parameters: {world: corners, rtf: 5.0}}
  - {node: wall_follower, start_after: world}
"""


def test_a_launch_file_as_processes(tmp_path: Path, mark: str) -> None:
    file = tmp_path / "drive.yaml"
    file.write_text(LAUNCH)
    threads = set(threading.enumerate())
    with System(transport="zenoh") as system:
        system.launch(file, set={"wall_follower.speed": 0.4})
        system.wait_until(lambda: system.nodes == ["/wall_follower", "/world"], within=PATIENCE)
        assert system.parameter("wall_follower", "speed") == 0.4
        system.set_parameter("wall_follower", "speed", 1)
        assert system.parameter("wall_follower", "speed") == 1.0
        system.expect("odom", lambda odom: odom.pose.pose.position.x > 3.3, within=PATIENCE)
        robot = system.robot()
        assert robot.driven > 0.2
        assert 0.2 < robot.area.width <= robot.driven + 0.1
        assert robot.pose.x > 3.2
        assert robot.contacts == 0
        assert system.call("std_srvs/srv/Trigger", "world/pause").message.startswith("paused")
        assert system.expect_log("paused at").name == "world"
        assert {*left(mark)} if sys.platform == "linux" else True
        system.crash("wall_follower")
        assert (system.nodes, system.failures) == (["/world"], [])
        system.restart("wall_follower")
        assert system.nodes == ["/wall_follower", "/world"]
        system.stop("world")
        assert system.nodes == ["/wall_follower"]
        with pytest.raises(NotFoundError, match="did you mean 'world'"):
            system.stop("wrld")
    system.close()
    for each in set(threading.enumerate()) - threads:
        each.join(PATIENCE)  # one of Zenoh's may be about to end
    assert set(threading.enumerate()) <= threads
    assert left(mark) == []


def test_two_nodes_of_one_class_are_two_programs() -> None:
    first = load_node_file("first_node").FirstNode
    with System(transport="zenoh") as system:
        system.start(first, name="one", parameters={"greeting": "servus"})
        system.start(first, namespace="ada")
        assert sorted(system.programs) == ["ada/first_node", "one"]
        assert system.expect_log("servus", within=PATIENCE).name == "one"
        system.stop("first_node")
        assert system.nodes == ["/one"]
        system.start(first, name="one")
        assert system.programs == ["one", "ada/first_node", "one_2"]
        system.stop("one_2")
        assert system.nodes == ["/one"]


BROKEN = """
import time

from robolink import Node


class Broken(Node):
    def __init__(self):
        super().__init__("broken")
        time.sleep(0.3)
        raise ValueError("no camera")
"""

SLIPPED = """
from robolink import Node


class Slipped(Node):
    def __init__(self):
        super().__init__("slipped")
        self.declare_parameter("speed", 1.0)
"""


def test_what_a_constructor_raises_and_what_it_does_not_declare(tmp_path: Path) -> None:
    broken, slipped = tmp_path / "broken.py", tmp_path / "slipped.py"
    broken.write_text(BROKEN)
    slipped.write_text(SLIPPED)
    with System(transport="zenoh") as system:
        with pytest.raises(NodeFailure, match=r"broken failed at its start: .*no camera"):
            system.start(broken)
        system.start(slipped, parameters={"sped": 2.0})
        with pytest.raises(ExpectationError, match=r"'sped' was given to /slipped, .*mean 'speed'"):
            system.run(0.1)


def test_what_only_memory_can_is_refused_with_the_reason() -> None:
    class Inner(Node):
        pass

    with System(transport="zenoh") as system:
        for refused in (
            lambda: system.faults.lose("scan", 0.5),
            lambda: system.faults.read("faults.yaml"),
            lambda: system.start(Inner),
        ):
            with pytest.raises(OnlyInMemoryError, match=r"memory|put it outside"):
                refused()
        with pytest.raises(NotFoundError, match="no simulated world"):
            system.robot()


INTERRUPTED = """
def test_it(system):
    system.start("first_node")
    system.start("velocity_publisher")
    raise KeyboardInterrupt
"""


def test_ctrl_c_leaves_no_process(pytester: pytest.Pytester, mark: str) -> None:
    pytester.makepyfile(test_it=INTERRUPTED)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", "--robolink-transport=zenoh")
    assert result.ret == pytest.ExitCode.INTERRUPTED
    deadline = time.monotonic() + PATIENCE
    while left(mark) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert left(mark) == []


def test_two_systems_at_once_have_domains_of_their_own() -> None:
    with free_domain() as one, free_domain() as other:
        assert one != other


def test_what_a_new_node_publishes_first_is_heard_by_a_late_recorder(monkeypatch: pytest.MonkeyPatch) -> None:
    record = Recorder._record

    def late(self: Recorder, topic: Topic) -> None:
        if topic.name == "/double":
            time.sleep(1.0)  # a busy machine, on the thread that brings the news of publishers
        record(self, topic)

    monkeypatch.setattr(Recorder, "_record", late)
    with System(transport="zenoh") as system:
        system.start(Doubler)
        system.publish("count", Int32(data=4))
        assert system.expect("double").data == 8
