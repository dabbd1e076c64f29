"""What a test does wrong with its system: each mistake is told where it is made, in words that help."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robolink import Message, Node
from robolink.exceptions import InvalidParameterValueException, NotFoundError, RobolinkError, ServiceError
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from robolink.message import int32
from robolink.testing import ExpectationError, NodeFailure, System


class Counter(Node):
    """Counts on a topic, ten times a second, and answers at a service."""

    def __init__(self) -> None:
        super().__init__("counter")
        self.number = 0
        self.speed = self.declare_parameter("speed", 1.0)
        self.publisher = self.create_publisher(Int32, "count", 10)
        self.create_timer(0.1, self.on_timer)
        self.create_service(Trigger, "trigger", lambda _, response: response)

    def on_timer(self) -> None:
        self.number += 1
        self.publisher.publish(Int32(data=self.number))


SCRIPT = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


def main():
    rclpy.init()
    node = Node("script")
    publisher = node.create_publisher(String, "words", 10)
    node.create_timer(0.5, lambda: publisher.publish(String(data="hello")))
    rclpy.spin(node)
"""


# Faults that cannot be


@pytest.mark.parametrize(
    ("add", "told"),
    [
        (lambda faults: faults.lose("count", 20), "loss: expected float <= 1.0, got 20"),
        (lambda faults: faults.lose("count", -0.2), "loss: expected float >= 0.0, got -0.2"),
        (lambda faults: faults.lose("count", "much"), "loss: expected float, got 'much'"),
        (lambda faults: faults.lose("count", 0.9, burst=2), "burst: a loss of 0.9 leaves no room"),
        (lambda faults: faults.lose("a b", 0.5), "'a b' is not a name"),
        (lambda faults: faults.lose(String, 0.5), "expected a name or several, got .*String"),
        (lambda faults: faults.lose("count", 0.5, during=0), "during: expected seconds, more than 0, got 0"),
        (lambda faults: faults.delay("count", -1), "latency: expected float >= 0.0, got -1"),
        (lambda faults: faults.duplicate("count", 2), "duplication: expected float <= 1.0, got 2"),
        (lambda faults: faults.partition(), "partition: expected a group of nodes or several, got none"),
        (lambda faults: faults.partition("counter", "/counter"), "partition: 'counter' is named twice, so that nobody"),
        (lambda faults: faults.partition("counter", during=-1), "during: expected seconds, more than 0, got -1"),
        (lambda faults: faults.crash("counter", after=-1), "after: expected seconds, 0 or more, got -1"),
        (lambda faults: faults.crash("counter", restart_after=-1), "restart_after: expected float >= 0.0, got -1"),
        (lambda faults: faults.skew("counter", drift=5), "drift: expected float <= 0.1, got 5"),
    ],
)
def test_a_fault_that_cannot_be_is_refused(tested: System, add: Callable[[Any], object], told: str) -> None:
    tested.start(Counter)
    with pytest.raises((ValueError, TypeError), match=told):
        add(tested.faults)


def test_a_fault_that_does_nothing_is_none(tested: System) -> None:
    tested.start(Counter)
    tested.faults.lose("count", 0)
    tested.faults.delay("count", 0.0)
    assert tested.expect("count").data == 1


def test_faults_take_nodes_as_well_as_names(tested: System) -> None:
    node = tested.start(Counter)
    heard: list[Int32] = []
    tested.node.create_subscription(Int32, "count", heard.append, 10)
    tested.faults.lose("count", 1.0, sender=node, receiver=[tested.node], during=1.05)
    tested.run(1.1)
    assert [each.data for each in heard] == [11]
    tested.faults.crash(node, restart_after=0.5)
    tested.run(1.05)
    assert [each.data for each in heard] == [11, 1, 2, 3, 4, 5]


def test_a_clock_that_runs_already_is_not_set_in_silence(tested: System) -> None:
    tested.start(Counter)
    tested.faults.skew("counter", 10.0)
    assert "counter runs already: its clock is wrong once it is started anew" in tested.logs[-1].message
    assert tested.restart("counter").get_clock().now().nanoseconds == 11_000_000_000


NAME = "clerk"


class Clerk(Node):
    """Has a name that does not stand in its constructor."""

    def __init__(self) -> None:
        super().__init__(NAME)


def test_a_clock_that_should_have_been_wrong_is_not_right_in_silence(tested: System) -> None:
    tested.faults.skew("clerk", 10.0)
    tested.start(Clerk)
    assert "clerk has a right clock: its name was not known before; start it with name='clerk'" in (
        tested.logs[-1].message
    )
    assert tested.start(Clerk, name="clerk").get_clock().now().nanoseconds == 11_000_000_000


# What is asked of the system


def test_a_system_that_is_closed_says_so(tested: System) -> None:
    tested.close()
    for act in (
        lambda: tested.start(Counter),
        lambda: tested.launch("follow"),
        lambda: tested.run(1.0),
        lambda: tested.expect("count"),
        lambda: tested.publish("count", Int32()),
        lambda: tested.messages("count"),
        lambda: tested.call(Trigger, "trigger"),
    ):
        with pytest.raises(RobolinkError, match="this system is closed"):
            act()


@pytest.mark.parametrize("within", [-1.0, float("nan"), float("inf")])
def test_seconds_that_are_none_are_refused(tested: System, within: float) -> None:
    for act in (tested.run, lambda each: tested.expect("count", within=each), tested.clock.run):
        with pytest.raises(ValueError, match="expected seconds, 0 or more, got"):
            act(within)


@pytest.mark.parametrize("seed", [-1, 2**32, "7", 1.5, None])
def test_a_seed_that_is_none_is_refused(seed: Any) -> None:
    with pytest.raises(ValueError, match="expected a seed from 0 to 4294967295, got"):
        System(seed=seed)


def test_what_cannot_be_started_is_told(tested: System) -> None:
    node = tested.start(Counter)
    with pytest.raises(TypeError, match=r"start takes a Node class, .*, and makes the node: give Counter, not a node"):
        tested.start(node)
    with pytest.raises(TypeError, match=r"start takes a Node class, .*, not 3"):
        tested.start(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"start takes a Node class, .*, not <class 'int'>"):
        tested.start(int)


def test_a_main_that_was_imported_is_started_like_its_file(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "script_of_mine.py"
    file.write_text(SCRIPT)
    names: dict[str, Any] = {"__name__": "script_of_mine"}
    exec(compile("import robolink.compat\n" + SCRIPT, str(file), "exec"), names)
    tested.start(names["main"])
    assert tested.expect("words", within=1.0).data == "hello"
    with pytest.raises(TypeError, match="start takes a Node class"):
        tested.start(lambda: None)


def test_a_class_in_place_of_a_condition(tested: System) -> None:
    tested.start(Counter)
    with pytest.raises(TypeError, match="Int32 is not a condition: give it as type=Int32"):
        tested.expect("count", Int32)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="Int32 is not a condition: give it as type=Int32"):
        tested.expect_none("count", Int32)  # type: ignore[arg-type]


def test_what_is_published_is_a_message(tested: System) -> None:
    for told in ("hello", {"data": 1}, Int32):
        with pytest.raises(TypeError, match="publish takes a topic and a message, got"):
            tested.publish("count", told)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="publish takes a topic and a message, got"):
        tested.publish(Int32, "count")  # type: ignore[arg-type]


def test_parameters_of_a_node_object(tested: System) -> None:
    node = tested.start(Counter)
    tested.set_parameter(node, "speed", 2.0)
    assert tested.parameter(node, "speed") == 2.0
    with pytest.raises(InvalidParameterValueException, match="speed of /counter"):
        tested.set_parameter(node, "speed", "fast")


def test_a_service_of_another_type_is_told_as_such(tested: System) -> None:
    tested.start(Counter)
    with pytest.raises(ExpectationError, match=r"/trigger has the type std_srvs/srv/Trigger, not std_srvs/srv/SetBool"):
        tested.call(SetBool, "trigger")


def test_who_is_stopped_is_a_node_or_its_name(tested: System) -> None:
    for act in (tested.stop, tested.crash, tested.restart, lambda node: tested.parameter(node, "speed")):
        for told in (None, 3, Counter):
            with pytest.raises(TypeError, match="expected a node or its name, got"):
                act(told)  # type: ignore[arg-type]


def test_a_robot_without_a_world_and_one_of_several_without_a_name(tested: System, tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match=r"^this system has no robot: no simulated world has begun in it$"):
        tested.robot()
    world = tmp_path / "two.yaml"
    world.write_text("robots: [{name: ada, pose: [1, 1]}, {name: bob, pose: [2, 2]}]\n")
    tested.start("world", parameters={"world": str(world)})
    with pytest.raises(NotFoundError, match=r"^which robot\? The world has ada, bob: give a name$"):
        tested.robot()
    assert tested.robot("bob").name == "bob"


# Parameters that no node declares


def test_a_parameter_that_is_not_declared_is_told_when_time_has_passed(tested: System) -> None:
    tested.start(Counter, parameters={"sped": 2.0})
    tested.check()
    with pytest.raises(
        ExpectationError,
        match=r"parameter 'sped' was given to /counter, which has not declared it \(did you mean 'speed'\?\)",
    ):
        tested.run(1.0)
    tested.run(1.0)


def test_a_parameter_set_in_a_launch_file_too(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "drive.yaml"
    file.write_text("nodes: [{node: world, parameters: {world: corners}}, {node: wall_follower, start_after: world}]\n")
    tested.launch(file, set={"wall_follower.sped": 0.2, "world.seed": 3})
    with pytest.raises(ExpectationError, match=r"'sped' was given to /wall_follower, .* mean 'speed'"):
        tested.run(1.0)


class Camera(LifecycleNode):
    """Declares its rate once it is configured."""

    def __init__(self) -> None:
        super().__init__("camera")

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.declare_parameter("rate", 1.0)
        return TransitionCallbackReturn.SUCCESS


TWO_NODES = """
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node


def main():
    rclpy.init()
    first, second = Node("first"), Node("second")
    second.declare_parameter("gains.p", 1.0)
    executor = SingleThreadedExecutor()
    executor.add_node(first)
    executor.add_node(second)
    executor.spin()
"""


def test_a_parameter_of_a_later_node_or_state_may_be_declared_yet(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "two_nodes.py"
    file.write_text(TWO_NODES)
    tested.start(Camera, parameters={"rate": 5.0})
    tested.start(file, parameters={"gains": {"p": 2.0}})
    tested.run(1.0)
    assert tested.parameter("second", "gains.p") == 2.0


# What the story tells


class Speaker(Node):
    """Publishes once, when it is made."""

    def __init__(self) -> None:
        super().__init__("speaker")
        self.create_publisher(String, "words", 10).publish(String(data="hello"))


def test_messages_that_came_too_early_are_told(tested: System) -> None:
    tested.start(Speaker)
    with pytest.raises(
        ExpectationError, match=r"may publish; 1 came before and does not count: begin messages\('/words'\) before"
    ):
        tested.expect("words", within=1.0)


def test_what_is_published_where_nobody_hears_it_is_told(tested: System) -> None:
    class Listener(Node):
        def __init__(self) -> None:
            super().__init__("listener")
            self.create_subscription(String, "words", lambda _: None, 10)
            self.create_publisher(String, "answers", 10)

    tested.start(Listener)
    for topic in ("wrds", "words", "/ada/words", "own"):
        tested.publish(topic, String(data="hello"))
    tested.node.create_subscription(String, "own", lambda _: None, 10)
    with pytest.raises(ExpectationError) as error:
        tested.expect("answers", within=1.0)
    told = [each for each in str(error.value).splitlines() if "nobody" in each]
    assert told == [
        "nobody listens to /wrds (did you mean '/words'?)",
        "nobody listens to /ada/words (did you mean '/words'?)",
    ]
    assert told[0] in tested.story.whole()


class Basket(Message):
    """A type of this file alone."""

    apples: int32


class Grocer(Node):
    """Breaks after its third basket."""

    def __init__(self) -> None:
        super().__init__("grocer")
        self.count = 0
        self.publisher = self.create_publisher(Basket, "basket", 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self) -> None:
        self.count += 1
        self.publisher.publish(Basket(apples=self.count))
        if self.count == 3:
            raise ValueError("no more apples")


def test_types_are_known_after_the_end_of_who_published_them(tested: System) -> None:
    tested.allow_failures = True
    baskets = tested.messages("basket")
    tested.start(Grocer)
    tested.run(1.0)
    assert baskets == [Basket(apples=1), Basket(apples=2), Basket(apples=3)]


def test_what_a_node_says_when_it_is_stopped_is_heard_at_once(tested: System) -> None:
    node, counts = tested.start(Counter), tested.messages("count")
    node.publisher.publish(Int32(data=100))
    tested.stop(node)
    assert [each.data for each in counts] == [100]


class Caller(Node):
    """Calls a service that nobody serves."""

    def __init__(self) -> None:
        super().__init__("caller")
        self.client = self.create_client(SetBool, "nobody")
        self.create_timer(0.1, lambda: self.client.call(SetBool.Request()))


def test_a_failure_names_the_line_of_the_node_not_of_robolink(tested: System) -> None:
    tested.start(Caller)
    with pytest.raises(NodeFailure, match=r"ServiceError: .* \(test_mistakes\.py:\d+\)") as error:
        tested.run(1.0)
    assert isinstance(error.value.__cause__, ServiceError)


def test_of_two_nodes_of_one_name_the_one_that_is_given_ends(tested: System) -> None:
    first, second = tested.start(Counter), tested.start(Counter)
    tested.stop(second)
    tested.run(0.15)
    assert (first.number, second.number) == (1, 0)
    assert tested.programs == ["counter", "counter_2"]
    assert tested.restart(first) is not first


class Worded(Node):
    """Keeps the words of its command line."""

    def __init__(self) -> None:
        super().__init__("worded")
        self.words = sys.argv[1:]


def test_a_class_gets_the_words_of_its_command_line(tested: System) -> None:
    assert tested.start(Worded, args=["--fast", "x"], name="mine").words[:2] == ["--fast", "x"]
    assert tested.nodes == ["/mine"]
