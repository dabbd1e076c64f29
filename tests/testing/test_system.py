"""Systems under test: what goes through them, as time passes, is waited for, asked and read."""

from __future__ import annotations

import random
import threading

import pytest

from robolink import Message, Node, logging
from robolink.exceptions import (
    EncodeError,
    InvalidParameterValueException,
    NotFoundError,
    ParameterNotDeclaredException,
)
from robolink.impl.log_output import output
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.message import int32
from robolink.testing import ExpectationError, System
from robolink.testing.recorder import TopicQueue
from tests.support.counting import LATCHED, Counter, Doubler, told

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


def meanwhile(system: System, seconds: float) -> None:
    """Have time pass that the test has not asked for, as it does over Zenoh between two lines of the test."""
    system._stage.run_until(lambda: False, seconds)


def test_the_only_message_counts_though_it_comes_while_expect_begins_to_listen(
    tested: System, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over Zenoh: too early for the new subscription, and the recorder's is called only afterwards."""
    monkeypatch.setattr(TopicQueue, "hear", lambda *_: None)
    tested.start(Doubler)
    for number in (4, 5):
        tested.publish("count", Int32(data=number))
        assert tested.expect("double").data == 2 * number


def test_an_answer_that_comes_before_it_is_expected_counts(tested: System) -> None:
    tested.start(Doubler)
    for number in (4, 5):
        tested.publish("count", Int32(data=number))
        meanwhile(tested, 0.1)
        assert tested.expect("double", within=0.0).data == 2 * number
    with pytest.raises(ExpectationError, match=r"^nothing came on /double within 0 s"):
        tested.expect("double", within=0.0)
    tested.publish("count", Int32(data=6))
    meanwhile(tested, 0.1)
    with pytest.raises(ExpectationError, match=r"^a message came on /double"):
        tested.expect_none("double", during=0.0)


def test_what_came_before_the_last_thing_that_the_test_did_does_not_count(tested: System) -> None:
    tested.start(Doubler)
    for act in (
        lambda: tested.run(0.0),
        lambda: tested.wait_until(lambda: True),
        lambda: tested.publish("elsewhere", Int32()),
        lambda: tested.start(Counter, parameters={"rate": 0.1}),
        lambda: tested.crash("counter"),
    ):
        tested.publish("count", Int32(data=4))
        meanwhile(tested, 0.1)
        act()
        with pytest.raises(ExpectationError, match=r"^nothing came on /double"):
            tested.expect("double", within=0.0)


class Answering(Node):
    """Publishes where it is asked something and where a parameter is set."""

    def __init__(self) -> None:
        super().__init__("answering")
        self.said = self.create_publisher(Int32, "said", 10)
        self.create_service(Trigger, "ask", self.answer)
        self.declare_parameter("number", 0)
        self.add_post_set_parameters_callback(lambda parameters: self.said.publish(Int32(data=parameters[0].value)))

    def answer(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.said.publish(Int32(data=7))
        return response


def test_what_a_call_or_a_parameter_leads_to_counts(tested: System) -> None:
    tested.start(Answering)
    tested.call(Trigger, "ask")
    assert tested.expect("said", within=0.0).data == 7
    tested.set_parameter("answering", "number", 8)
    assert tested.expect("said", within=0.0).data == 8


def test_what_the_test_says_itself_is_no_answer(tested: System) -> None:
    tested.publish("said", Int32())
    with pytest.raises(ExpectationError):
        tested.expect("said", within=0.0)


def test_what_is_kept_for_late_ones_counts_too(tested: System) -> None:
    tested.start(Doubler)
    tested.run(5.0)
    assert tested.expect("state", within=0.0).data == "ready"
    assert [each.data for each in tested.messages("state")] == ["ready"]


class Announcer(Node):
    """Publishes each change as its state, which is kept for late subscriptions."""

    def __init__(self) -> None:
        super().__init__("announcer")
        self.publisher = self.create_publisher(Int32, "state", LATCHED)
        self.create_subscription(Int32, "change", self.on_change, 10)

    def on_change(self, change: Int32) -> None:
        self.publisher.publish(change)
        self.get_logger().info(f"changed to {change.data}")


def test_a_message_that_is_kept_for_late_ones_is_looked_at_once(tested: System) -> None:
    tested.start(Announcer)
    for number in (1, 1, 2):
        tested.publish("change", Int32(data=number))
    tested.expect_log("changed to 2")
    looked_at = list[int]()
    with pytest.raises(ExpectationError, match="none of the 3 messages"):
        tested.expect("state", lambda state: looked_at.append(state.data), within=0.0)
    assert looked_at == [1, 1, 2]


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
        tested.publish("count", Int32(data="four"))  # type: ignore[arg-type]


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


# Beginning and end


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
    assert set(threading.enumerate()) <= threads
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
