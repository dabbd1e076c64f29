"""What a test is told when something did not come true, or a program of its system failed."""

from __future__ import annotations

import re
import threading
import time

import pytest

from robolink import Node, logging
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import Int32
from robolink.testing import ExpectationError, NodeFailure, System
from tests.support.counting import Counter, Doubler, told


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


def test_no_story_is_buried_in_transforms(tested: System) -> None:
    tested.launch("follow")
    tested.run(3.0)
    lines = tested.story.whole().splitlines()
    shown = [line.split()[2] for line in lines if " s  /" in line]
    assert {each: shown.count(each) for each in ("/cmd_vel", "/odom", "/tf", "/tf_static", "/diagnostics")} == {
        "/cmd_vel": 3,
        "/odom": 3,
        "/tf": 1,
        "/tf_static": 1,
        "/diagnostics": 1,
    }
    assert max(map(len, lines)) <= 160


def test_whoever_asks_for_transforms_is_shown_them(tested: System) -> None:
    tested.launch("follow")
    with pytest.raises(ExpectationError) as error:
        tested.expect("/tf", lambda message: not message.transforms, within=1.0)
    assert sum(" s  /tf " in line for line in told(error)) == 8


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


def test_twist_has_a_short_form(tested: System) -> None:
    twist = Twist()
    twist.linear.x = 0.25
    tested.publish("cmd_vel", twist)
    with pytest.raises(ExpectationError, match=r"/cmd_vel  /test  linear\.x=0\.25"):
        tested.expect("cmd_vel", within=0.1)


# Programs that fail


def test_a_node_that_fails_fails_the_test_where_it_waits(tested: System) -> None:
    tested.start(Doubler)
    tested.start(Counter)
    with pytest.raises(NodeFailure) as error:
        tested.run(60.0)
    assert told(error)[0].startswith("doubler failed at 1.4 s: ValueError: unlucky (counting.py:")
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


def test_what_a_callback_of_the_tests_own_raises_is_what_the_test_sees(tested: System) -> None:
    def check(count: Int32) -> None:
        assert count.data < 3

    tested.start(Counter)
    tested.node.create_subscription(Int32, "count", check, 10)
    with pytest.raises(AssertionError, match=r"data=3|3 < 3"):
        tested.run(1.0)


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
    assert re.search(r"sleeper .*sleep.* \(.*test_failures.py:\d+\)", line)
    assert re.search(r"sleeper .*thread.* \(.*test_failures.py:\d+\)", line)


def test_what_came_last_is_told_of_a_condition_that_looks_at_no_message() -> None:
    logging.set_console_handler(None)
    with System(seed=7, replay="pytest x.py") as tested:
        counter = tested.start(Counter)
        with pytest.raises(ExpectationError) as error:
            tested.wait_until(lambda: counter is None, within=0.25)
    assert told(error) == [
        "what was waited for did not come true within 0.25 s (from 0 s to 0.25 s)",
        "what came last:",
        "  0.100 s  /count  /counter  (zero)",
        "  0.200 s  /count  /counter  data=1",
        "replay: pytest x.py",
    ]


def test_faults_are_a_file_s_path_and_not_the_faults_themselves(tested: System) -> None:
    reason = "faults are the path of a file, got a list: write them into one, or call `system.faults`"
    with pytest.raises(TypeError, match=re.escape(reason)):
        tested.launch("follow", faults=[{"topic": "odom", "loss": 0.5}])  # type: ignore[arg-type]
