"""The lock of STOP as nodes keep it: what came last counts, what comes twice does not, and nobody answers himself."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.control.stop_lock import AGAIN, QOS, TOPIC, Lock, StopLock
from robolink.exceptions import SecurityError
from robolink.interfaces.std_msgs.msg import Bool
from robolink.node import Node
from robolink.testing import System
from tests.support.systems import said


class Base(Node):
    """A node that obeys the lock, and notes each change."""

    def __init__(self, **options: Any) -> None:
        super().__init__("base", **options)
        self.changes: list[bool] = []
        self.lock = StopLock(self, self.changes.append)


def pressed(system: System, held: bool, qos: Any = QOS) -> None:
    """Say it by a publisher that leaves at once."""
    publisher = system.node.create_publisher(Bool, TOPIC, qos)
    publisher.publish(Bool(data=held))
    system.node.destroy_publisher(publisher)


def test_a_base_keeps_it_for_the_next_one_and_lets_go_together(system: System) -> None:
    one = system.start(Base)
    system.run(0.1)
    pressed(system, True)
    system.run(1.0)
    other = system.start(Base, name="other")
    system.run(1.0)
    system.stop("base")
    third = system.start(Base, name="third")
    system.run(1.0)
    assert [each.changes for each in (one, other, third)] == [[True]] * 3
    pressed(system, False)
    system.run(1.0)
    assert [each.changes for each in (other, third)] == [[True, False]] * 2
    late = system.messages(TOPIC, Bool)
    system.run(1.0)
    assert late == []
    assert system.node.count_publishers(TOPIC) == 0


def test_it_is_said_a_second_time_and_then_no_more(system: System) -> None:
    base = system.start(Base)
    heard = system.messages(TOPIC, Bool)
    system.run(0.1)
    base.lock._lock.press()
    system.run(AGAIN / 2)
    at_first = len(heard)
    system.run(AGAIN)
    assert len(heard) == at_first + 1
    system.run(60.0)
    assert len(heard) == at_first + 1
    assert base.changes == [True]


def test_who_subscribes_later_without_asking_for_what_was_before_hears_it(system: System) -> None:
    system.start(Base)
    system.run(0.1)
    pressed(system, True)
    system.run(5.0)
    heard: list[bool] = []
    system.node.create_subscription(Bool, TOPIC, lambda each: heard.append(each.data), 10)
    system.run(1.0)
    assert heard == [True]


class Held:
    """A lock alone, with a node that nobody spins."""

    def __init__(self, node: Node, *, keeps: bool = True) -> None:
        self.changes: list[bool] = []
        self.lock = Lock(node, self.changes.append, keeps=keeps)


def test_own_messages_that_come_back_late_count_for_nothing(system: System) -> None:
    held = Held(system.node)
    held.lock.press()
    gid = held.lock._publisher.gid  # type: ignore[union-attr]
    held.lock.take(False, b"other", 1)
    held.lock.take(True, gid, 1)
    assert held.changes == [True, False]


def test_a_message_that_comes_by_both_subscriptions_counts_once(system: System) -> None:
    held = Held(system.node)
    held.lock.take(True, b"one", 1)
    held.lock.take(False, b"other", 1)
    held.lock.take(True, b"one", 1)
    assert held.changes == [True, False]
    held.lock.take(True, b"one", 2)
    assert held.changes == [True, False, True]


def test_a_node_that_may_not_publish_the_lock_obeys_it_all_the_same(
    system: System, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise SecurityError("this enclave may not publish /e_stop")

    base = system.start(Base)
    system.run(0.1)
    monkeypatch.setattr(base, "create_publisher", refuse)
    pressed(system, True)
    system.run(1.0)
    pressed(system, False)
    system.run(1.0)
    assert base.changes == [True, False]
    assert said(system, "STOP is obeyed here and not kept for others: this enclave") == 1
    with pytest.raises(SecurityError):
        base.lock._lock.press()
    assert base.changes == [True, False]  # nobody else would hold
    pressed(system, True)
    system.run(1.0)
    with pytest.raises(SecurityError):
        base.lock._lock.release()
    assert base.lock.held  # as all others do


def test_a_node_that_may_not_listen_runs_and_says_so(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise SecurityError("this enclave may not subscribe to /e_stop")

    base = system.start(Base)
    monkeypatch.setattr(base, "create_subscription", refuse)
    system.run(1.0)
    assert said(system, "STOP is not obeyed here: this enclave") == 1


def test_what_a_sender_said_before_counts_no_more_however_late_it_comes(system: System) -> None:
    held = Held(system.node)
    held.lock.take(True, b"one", 5)
    held.lock.take(False, b"one", 4)  # by the other subscription, which is a message behind
    assert held.changes == [True]


@pytest.mark.parametrize("last", [True, False])
def test_a_flood_of_presses_and_releases_is_echoed_a_few_times_a_second(system: System, last: bool) -> None:
    bases = [system.start(Base), system.start(Base, name="other")]
    senders: set[bytes] = set()
    system.node.create_subscription(Bool, TOPIC, lambda _, info: senders.add(info["publisher_gid"]["data"]), 1000)
    publisher = system.node.create_publisher(Bool, TOPIC, 10)
    system.run(0.1)
    for number in range(1000):
        publisher.publish(Bool(data=number % 2 == last))
        system.run(0.001)
    publisher.publish(Bool(data=last))
    system.run(1.0)
    assert [each.lock.held for each in bases] == [last, last]
    assert len(senders) <= 1 + 2 * (2.0 / AGAIN)


def test_who_only_looks_says_nothing(system: System) -> None:
    held = Held(system.node, keeps=False)
    held.lock.take(True, b"one", 1)
    held.lock.repeat()
    assert (held.changes, system.node.count_publishers(TOPIC)) == ([True], 0)
    held.lock.take(False, b"one", 2)
    held.lock.withdraw()
    assert held.changes == [True, False]


@given(st.lists(st.tuples(st.sampled_from(["press", "release", "withdraw", "repeat", "a", "b"]), st.booleans())))
def test_after_anything_the_last_word_counts(steps: list[tuple[str, bool]]) -> None:
    with System(seed=0) as system:
        held = Held(system.node)
        expected = False
        for number, (what, value) in enumerate(steps):
            if what in ("a", "b"):
                held.lock.take(value, what.encode(), number)
                expected = value
            else:
                getattr(held.lock, what)()
                expected = {"press": True, "release": False}.get(what, expected)
            assert held.lock.held is expected
        assert not expected or [each.data for each in system.messages(TOPIC, Bool)] in ([], [True])
        held.lock.repeat()  # as its node does a quarter of a second later
        kept = system.messages(TOPIC, Bool)
        held.lock.withdraw()
        system.run(0.1)
        if expected:
            assert [each.data for each in kept] == [True]
        assert system.node.count_publishers(TOPIC) == expected


@pytest.mark.parametrize("held", [True, False])
def test_what_a_node_says_of_it_is_for_whoever_spins_it_too(system: System, held: bool) -> None:
    base = system.start(Base)
    own = base.create_publisher(Bool, TOPIC, QOS)  # not the lock's
    system.run(0.1)
    own.publish(Bool(data=held))
    system.run(0.1)
    assert base.changes == [True] * held
