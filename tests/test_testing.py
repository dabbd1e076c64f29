"""Systems under test: started, watched, asked and disturbed, and what is told when something did not come true."""

from __future__ import annotations

import random
import re
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Message, Node, Parameter, logging
from robolink.exceptions import (
    EncodeError,
    InvalidParameterValueException,
    NotFoundError,
    ParameterNotDeclaredException,
)
from robolink.impl.log_output import output
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.message import int32
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import ExpectationError, NodeFailure, System

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Counter(Node):
    """Counts on a topic, `rate` times a second, from `first` on."""

    def __init__(self) -> None:
        super().__init__("counter")
        self.value = self.declare_parameter("first", 0).value
        self.publisher = self.create_publisher(Int32, "count", 10)
        self.create_timer(1.0 / self.declare_parameter("rate", 10.0).value, self.on_timer)
        self.add_on_set_parameters_callback(self.on_parameters)

    def on_timer(self) -> None:
        self.publisher.publish(Int32(data=self.value))
        self.value += 1
        if self.value % 10 == 0:
            self.get_logger().info(f"counted to {self.value}")

    def on_parameters(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        return SetParametersResult(
            successful=all(each.name != "rate" for each in parameters), reason="not while it runs"
        )


class Doubler(Node):
    """Publishes the double of what it hears; it breaks at 13, and has a service."""

    def __init__(self) -> None:
        super().__init__("doubler")
        self.heard: list[int] = []
        self.stamps: list[int] = []
        self.publisher = self.create_publisher(Int32, "double", 10)
        self.state = self.create_publisher(String, "state", LATCHED)
        self.state.publish(String(data="ready"))
        self.create_subscription(Int32, "count", self.on_count, 100)
        self.create_service(SetBool, "~/enable", self.on_enable)
        self.get_logger().info("ready to double")

    def on_count(self, count: Int32) -> None:
        self.heard.append(count.data)
        self.stamps.append(self.get_clock().now().nanoseconds)
        if count.data == 13:
            raise ValueError("unlucky")
        self.publisher.publish(Int32(data=2 * count.data))

    def on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success, response.message = True, "on" if request.data else "off"
        return response


@pytest.fixture
def tested() -> Iterator[System]:
    logging.set_console_handler(None)
    with System(seed=7) as made:
        yield made


# Messages


def test_messages_go_through_a_node_as_time_passes(tested: System) -> None:
    node = tested.start(Doubler)
    doubles = tested.messages("double")
    tested.publish("count", Int32(data=4))
    assert doubles == []
    tested.run(0.0)
    assert [each.data for each in doubles] == [8]
    assert node.heard == [4]
    assert tested.time == 0.0


def test_only_what_comes_from_now_on_counts(tested: System) -> None:
    tested.start(Counter)
    tested.run(1.05)
    assert tested.expect("count").data == 10
    assert tested.expect("/count", lambda count: count.data >= 20).data == 20
    assert tested.time == pytest.approx(2.1)
    with pytest.raises(
        ExpectationError, match=r"none of the 2 messages on /count fulfilled the condition within 0.2 s"
    ):
        tested.expect("count", lambda count: count.data < 20, within=0.2)


def test_what_is_kept_for_late_ones_counts_too(tested: System) -> None:
    tested.start(Doubler)
    tested.run(5.0)
    assert tested.expect("state", within=0.0).data == "ready"
    assert [each.data for each in tested.messages("state")] == ["ready"]


def test_a_topic_may_come_later_than_the_wish_to_hear_it(tested: System) -> None:
    heard = tested.messages("count")
    tested.start(Counter, parameters={"rate": 2})
    tested.run(2.0)
    assert [each.data for each in heard] == [0, 1, 2, 3]


class Basket(Message):
    """A type that nobody knows by its name."""

    apples: int32


def test_a_type_of_the_tests_own_is_known_by_its_publisher(tested: System) -> None:
    publisher = tested.node.create_publisher(Basket, "basket", 1)
    heard = tested.messages("basket")
    publisher.publish(Basket(apples=3))
    tested.run(0.0)
    assert heard == [Basket(apples=3)]
    tested.messages("basket", Int32)
    publisher.publish(Basket(apples=3))
    with pytest.raises(ExpectationError, match=r"/basket has the type .*Basket, not std_msgs/msg/Int32"):
        tested.run(0.0)


def test_a_message_that_does_not_fit_is_refused_where_it_is_published(tested: System) -> None:
    with pytest.raises(EncodeError, match=r"Int32\.data"):
        tested.publish("count", Int32(data="four"))


def test_nothing_comes_where_nothing_shall(tested: System) -> None:
    tested.start(Doubler)
    tested.expect_none("double", during=3.0)
    assert tested.time == 3.0
    tested.publish("count", Int32(data=1))
    with pytest.raises(ExpectationError, match=r"a message came on /double at 3 s, where none at all was expected"):
        tested.expect_none("double")
    tested.publish("count", Int32(data=1))
    tested.expect_none("double", lambda double: double.data > 2, during=1.0)


def test_anything_can_be_waited_for(tested: System) -> None:
    node, counts = tested.start(Doubler), tested.messages("count")
    tested.start(Counter)
    tested.wait_until(lambda: len(node.heard) == 3)
    assert tested.time == pytest.approx(0.3)
    tested.wait_until(lambda: len(counts) == 5)

    def has_heard_all() -> bool:
        return len(node.heard) > 100

    with pytest.raises(ExpectationError, match=r"has_heard_all did not come true within 0.5 s \(from 0.5 s to 1 s\)"):
        tested.wait_until(has_heard_all, within=0.5)


def test_what_a_condition_raises_is_what_the_test_sees(tested: System) -> None:
    tested.start(Counter)
    with pytest.raises(ZeroDivisionError):
        tested.expect("count", lambda count: 1 / 0)
    with pytest.raises(AttributeError, match="nothing"):
        tested.expect("count", lambda count: count.nothing)
    assert tested.expect("count").data == 2


# What is told


def told(error: pytest.ExceptionInfo[ExpectationError]) -> list[str]:
    return str(error.value).splitlines()


def test_a_failure_shows_what_came_on_the_topics_concerned_and_how_to_replay_it() -> None:
    logging.set_console_handler(None)
    with System(seed=7, replay="pytest x.py") as tested:
        tested.start(Counter)
        tested.start(Doubler)
        with pytest.raises(ExpectationError) as error:
            tested.expect("double", lambda double: double.data < 0, within=0.35)
    assert told(error) == [
        "none of the 3 messages on /double fulfilled the condition within 0.35 s (from 0 s to 0.35 s)",
        "what came last:",
        "  0.100 s  /count   /counter  (zero)",
        "  0.100 s  /double  /doubler  (zero)",
        "  0.200 s  /count   /counter  data=1",
        "  0.200 s  /double  /doubler  data=2",
        "  0.300 s  /count   /counter  data=2",
        "  0.300 s  /double  /doubler  data=4",
        "replay: pytest x.py",
    ]


def test_a_topic_that_is_not_there_is_told_with_the_nearest(tested: System) -> None:
    tested.start(Counter, namespace="/ada")
    with pytest.raises(ExpectationError) as error:
        tested.expect("count", within=1.0)
    assert told(error)[0] == (
        "there is no topic /count (did you mean '/ada/count'?) within 1 s (from 0 s to 1 s); there are: "
        "/ada/count [std_msgs/msg/Int32]"
    )


def test_a_topic_that_somebody_only_hears_is_told_as_such(tested: System) -> None:
    tested.start(Doubler)
    with pytest.raises(ExpectationError, match=r"nobody publishes /count \[std_msgs/msg/Int32\], to which /doubler"):
        tested.expect("count", within=1.0)
    with pytest.raises(ExpectationError, match=r"nothing came on /double within 1 s .*, which /doubler may publish"):
        tested.expect("double", within=1.0)


def test_faults_are_told_with_what_they_have_done(tested: System) -> None:
    tested.start(Counter)
    tested.start(Doubler)
    tested.faults.lose("count", 1.0)
    with pytest.raises(ExpectationError, match=r"faults: \{topic: .*count.*, loss: 1.*: 10 lost of 10"):
        tested.expect("double", within=1.05)


def test_the_same_seed_says_the_same() -> None:
    def run(seed: int) -> list[int]:
        with System(seed=seed) as tested:
            node = tested.start(Doubler)
            tested.faults.lose("count", 0.5)
            for each in range(100, 150):
                tested.publish("count", Int32(data=each))
                tested.run(0.1)
            node_heard: list[int] = node.heard
            return node_heard

    logging.set_console_handler(None)
    assert run(1) == run(1) != run(2)


# Log lines, services, parameters


def test_log_lines_are_expected_in_their_order(tested: System) -> None:
    tested.start(Doubler, remappings={"count": "other"})
    tested.start(Counter)
    assert tested.expect_log("ready").name == "doubler"
    line = tested.expect_log("counted to")
    assert (line.message, line.stamp_ns - tested.logs[0].stamp_ns) == ("counted to 10", 10**9)
    assert tested.expect_log("counted to").message == "counted to 20"
    with pytest.raises(ExpectationError, match=r"nobody logged 'ready' within 0.5 s") as error:
        tested.expect_log("ready", within=0.5)
    assert "  2.000 s  INFO  counter  counted to 20" in told(error)
    assert tested.expect_log("counted to 30")


def test_a_service_is_called_by_class_or_by_name(tested: System) -> None:
    tested.start(Doubler)
    assert tested.call(SetBool, "doubler/enable", SetBool.Request(data=True)).message == "on"
    assert tested.call("std_srvs/srv/SetBool", "/doubler/enable").message == "off"
    with pytest.raises(ExpectationError, match=r"no service /doubler/enabl \(did you mean '/doubler/enable'\?\)"):
        tested.call(SetBool, "doubler/enabl", within=0.5)
    tested.node.create_service(Trigger, "never", lambda request, response: tested.clock.now / 0)
    with pytest.raises(ZeroDivisionError):
        tested.call(Trigger, "never")


def test_parameters_are_read_and_set(tested: System) -> None:
    node = tested.start(Counter, parameters={"first": 5, "rate": 4})
    assert tested.parameter("counter", "first") == 5
    assert tested.parameter("/counter", "rate") == 4.0
    tested.set_parameter("counter", "first", 6)
    assert node.get_parameter("first").value == 6
    with pytest.raises(InvalidParameterValueException, match="not while it runs"):
        tested.set_parameter("counter", "rate", 5)
    with pytest.raises(ParameterNotDeclaredException, match="did you mean 'first'"):
        tested.parameter("counter", "firs")
    with pytest.raises(NotFoundError, match="did you mean '/counter'"):
        tested.parameter("counte", "first")


def test_the_graph_is_that_of_the_nodes_without_the_test(tested: System) -> None:
    tested.start(Counter, name="one", namespace="ada", remappings={"count": "/count"})
    tested.start(Doubler)
    tested.publish("count", Int32())
    tested.node.create_subscription(Int32, "double", lambda _: None, 1)
    assert tested.nodes == ["/ada/one", "/doubler"]
    assert tested.programs == ["ada/one", "doubler"]
    assert tested.topics["/count"] == "std_msgs/msg/Int32"
    assert tested.services["/doubler/enable"] == "std_srvs/srv/SetBool"
    assert (tested.publishers("count"), tested.subscribers("count")) == (["/ada/one"], ["/doubler"])
    assert tested.subscribers("double") == []


def test_a_future_of_the_tests_own_node_is_waited_for(tested: System) -> None:
    tested.start(Doubler)
    client = tested.node.create_client(SetBool, "doubler/enable")
    answer = tested.result(client.call_async(SetBool.Request()))
    assert answer is not None
    assert answer.message == "off"
    with pytest.raises(ExpectationError, match="the future was not done within 2 s"):
        tested.result(tested.node.create_client(Trigger, "nobody").call_async(Trigger.Request()), within=2.0)


# Programs that fail


def test_a_node_that_fails_fails_the_test_where_it_waits(tested: System) -> None:
    tested.start(Doubler)
    tested.start(Counter)
    with pytest.raises(NodeFailure) as error:
        tested.run(60.0)
    assert told(error)[0].startswith("doubler failed at 1.4 s: ValueError: unlucky (test_testing.py:")
    assert isinstance(error.value.__cause__, ValueError)
    assert tested.time == pytest.approx(1.4)
    assert tested.nodes == ["/counter"]
    tested.run(1.0)  # once is enough
    assert [each.program for each in tested.failures] == ["doubler"]


def test_a_failure_can_be_what_the_test_is_about(tested: System) -> None:
    tested.allow_failures = True
    tested.start(Doubler)
    tested.start(Counter)
    tested.run(2.0)
    assert tested.nodes == ["/counter"]
    assert str(tested.failures[0].error) == "unlucky"


def test_a_failure_comes_before_what_was_waited_for_in_vain(tested: System) -> None:
    tested.start(Doubler)
    tested.publish("count", Int32(data=13))
    with pytest.raises(NodeFailure, match="unlucky"):
        tested.expect("double")


def test_what_a_constructor_raises_comes_from_start(tested: System) -> None:
    class Broken(Node):
        def __init__(self) -> None:
            super().__init__("broken")
            raise KeyError("no such thing")

    with pytest.raises(KeyError, match="no such thing"):
        tested.start(Broken)
    tested.run(1.0)
    assert tested.nodes == []


def test_what_a_callback_of_the_tests_own_raises_is_what_the_test_sees(tested: System) -> None:
    def check(count: Int32) -> None:
        assert count.data < 3

    tested.start(Counter)
    tested.node.create_subscription(Int32, "count", check, 10)
    with pytest.raises(AssertionError, match=r"data=3|3 < 3"):
        tested.run(1.0)


def test_stopped_crashed_and_restarted(tested: System) -> None:
    class Polite(Node):
        def __init__(self) -> None:
            super().__init__("polite")
            self.publisher = self.create_publisher(String, "words", 10)
            self.publisher.publish(String(data="hello"))

        def destroy_node(self) -> None:
            self.publisher.publish(String(data="goodbye"))
            super().destroy_node()

    words = tested.messages("words")
    node = tested.start(Polite)
    tested.crash(node)
    assert tested.nodes == []
    other = tested.restart("polite")
    assert tested.nodes == ["/polite"]
    tested.stop(other)
    tested.run(0.0)
    assert [each.data for each in words] == ["hello", "hello", "goodbye"]
    assert tested.nodes == []
    with pytest.raises(NotFoundError, match="did you mean 'polite'"):
        tested.stop("polit")
    tested.run(1.0)
    assert tested.failures == []


class Sleeper(Node):
    """Sleeps in a callback, and has a thread."""

    def __init__(self) -> None:
        super().__init__("sleeper")
        self.create_timer(1.0, lambda: time.sleep(0.25))
        self.thread = threading.Thread(target=lambda: None)
        self.thread.start()


def test_a_node_that_sleeps_or_starts_threads_is_named(tested: System) -> None:
    tested.start(Sleeper)
    with pytest.raises(ExpectationError) as error:
        tested.expect("nothing", within=5.0)
    (line,) = (each for each in told(error) if each.startswith("real time was used, which is virtual here: "))
    assert re.search(r"sleeper .*sleep.* \(.*test_testing.py:\d+\)", line)
    assert re.search(r"sleeper .*thread.* \(.*test_testing.py:\d+\)", line)


# Faults


def counted(tested: System, seconds: float) -> tuple[list[int], list[float]]:
    """What a doubler hears of a counter, and when."""
    node = tested.start(Doubler)
    tested.start(Counter, parameters={"first": 100})
    tested.run(seconds)
    return node.heard, [(each - 1_000_000_000) / 1e9 for each in node.stamps]


def test_messages_are_lost_for_a_while(tested: System) -> None:
    tested.faults.lose("count", 1.0, during=1.05)
    heard, _ = counted(tested, 2.0)
    assert heard == list(range(110, 120))


def test_messages_come_late_and_twice(tested: System) -> None:
    tested.faults.delay("count", 0.05, receiver="doubler")
    tested.faults.duplicate("count", 1.0, sender="counter")
    heard, times = counted(tested, 0.26)
    assert heard == [100, 100, 101, 101]
    assert times == pytest.approx([0.15, 0.15, 0.25, 0.25])


def test_nodes_are_parted_until_all_is_well_again(tested: System) -> None:
    tested.faults.partition("counter")
    heard, _ = counted(tested, 1.05)
    assert heard == []
    tested.faults.clear()
    tested.run(0.1)
    assert heard == [110]


def test_a_program_crashes_and_comes_back_and_a_clock_is_wrong(tested: System) -> None:
    tested.start(Counter, parameters={"first": 100})
    tested.faults.crash("counter", after=0.55, restart_after=1.0)
    tested.faults.skew("doubler", 100.0)
    node = tested.start(Doubler)
    tested.run(2.0)
    assert node.heard == [100, 101, 102, 103, 104, 100, 101, 102, 103]
    assert node.stamps[0] == 101_100_000_000
    tested.run(0.0)
    assert tested.failures == []


def test_a_service_call_can_be_lost(tested: System) -> None:
    tested.start(Doubler)
    tested.faults.lose("doubler/enable", 1.0, service=True)
    with pytest.raises(ExpectationError, match="/doubler/enable did not answer within 5 s"):
        tested.call(SetBool, "doubler/enable")


def test_a_file_of_faults(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "faults.yaml"
    file.write_text("messages: [{topic: count, loss: 1.0, until: 1.05}]\n")
    tested.faults.read(file)
    heard, _ = counted(tested, 1.5)
    assert heard == list(range(110, 115))


# Launch files and a world

LAUNCH = """
arguments: {pace: 0.2}
nodes:
  - {node: world, parameters: {world: corners}}
  - {node: wall_follower, parameters: {speed: "{pace}"}}
"""


def test_a_launch_file_with_arguments_parameters_and_faults(tested: System, tmp_path: Path) -> None:
    file, faults = tmp_path / "drive.yaml", tmp_path / "faults.yaml"
    file.write_text(LAUNCH)
    faults.write_text("messages: [{topic: scan, loss: 0.2}]\n")
    tested.launch(file, {"pace": 0.3}, set={"wall_follower.distance": 0.6}, faults=faults)
    assert tested.nodes == ["/wall_follower", "/world"]
    assert tested.parameter("wall_follower", "speed") == 0.3
    assert tested.parameter("wall_follower", "distance") == 0.6
    tested.run(20.0)
    robot = tested.robot()
    assert robot.contacts == 0
    assert robot.driven > 3.0
    assert tested.expect("odom", lambda odom: abs(odom.pose.pose.position.x - robot.pose.x) < 0.1)
    with pytest.raises(NotFoundError, match="no robot named 'robt' in the world, which has robot"):
        tested.robot("robt")


def test_robots_of_two_worlds_are_called_by_their_namespaces(tested: System) -> None:
    tested.start("world", namespace="one", parameters={"world": "empty_room"})
    one = tested.robot()
    assert tested.robot("robot") is tested.robot("one/robot") is one
    tested.start("world", namespace="two", parameters={"world": "empty_room"})
    assert tested.robot("one/robot") is one
    assert tested.robot("/two/robot") is not one
    with pytest.raises(NotFoundError, match=r"which robot 'robot'\? There are one/robot, two/robot: give a whole name"):
        tested.robot("robot")
    with pytest.raises(NotFoundError, match=r"which robot\? The world has one/robot, two/robot: give a name"):
        tested.robot()


def test_what_is_not_there_is_named(tested: System, tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="did you mean 'follow'"):
        tested.launch("folow")
    with pytest.raises(NotFoundError, match="did you mean 'wall_follower'"):
        tested.launch("follow", set={"wall_folower.speed": 1})
    with pytest.raises(NotFoundError, match="did you mean 'wall_follower'"):
        tested.start("wall_folower")
    with pytest.raises(NotFoundError, match="no simulated world"):
        tested.robot()
    assert tested.nodes == []


HELLO = """
from robolink import Node


class Hello(Node):
    def __init__(self):
        super().__init__("hello")
        self.declare_parameter("seed", 0)
"""


def test_nodes_are_started_by_name_or_file(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "hello.py"
    file.write_text(HELLO)
    assert tested.start(file, name="hallo").get_name() == "hallo"
    assert tested.parameter("hallo", "seed") == 7
    tested.start("wall_follower", namespace="ada", parameters={"side": "left"})
    assert tested.nodes == ["/ada/wall_follower", "/hallo"]
    assert tested.parameter("ada/wall_follower", "side") == "left"


SCRIPT = """
import sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


def main():
    rclpy.init()
    node = Node("script")
    publisher = node.create_publisher(Int32, "count", 10)
    while rclpy.ok():
        publisher.publish(Int32(data=int(sys.argv[1])))
        rclpy.spin_once(node, timeout_sec=0.25)


if __name__ == "__main__":
    main()
"""


def test_a_script_with_a_main_of_its_own(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "script.py"
    file.write_text(SCRIPT)
    heard = tested.messages("count")
    tested.start(file, args=["100"], namespace="ada", remappings={"count": "/count"})
    assert tested.nodes == ["/ada/script"]
    tested.run(1.1)
    assert [each.data for each in heard] == [100] * 5
    tested.stop("script")
    assert tested.nodes == []


# Nothing is left


def test_nothing_is_left() -> None:
    logging.set_console_handler(None)
    threads, state = set(threading.enumerate()), random.getstate()
    handlers = output._handlers
    for _ in range(3):
        with System() as tested:
            tested.start(Counter)
            tested.start(Doubler)
            tested.publish("count", Int32(data=1))
            tested.run(0.5)
        tested.close()
    assert set(threading.enumerate()) == threads
    assert random.getstate() == state
    assert output._handlers == handlers


def test_a_transport_that_is_none() -> None:
    with pytest.raises(ValueError, match="expected memory or zenoh"):
        System(transport="tcp")


def test_its_clock_is_virtual(tested: System) -> None:
    assert tested.virtual
    tested.clock.run(2.5)
    assert (tested.clock.now, tested.time) == (2.5, 2.5)
    tested.clock.run_until(2.0)
    tested.clock.run_until(4.0)
    assert tested.clock.now == 4.0


def test_twist_has_a_short_form(tested: System) -> None:
    twist = Twist()
    twist.linear.x = 0.25
    tested.publish("cmd_vel", twist)
    with pytest.raises(ExpectationError, match=r"/cmd_vel  /test  linear\.x=0\.25"):
        tested.expect("cmd_vel", within=0.1)
