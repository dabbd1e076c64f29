"""Order of messages that come again after a cut: what is behind a gap waits for the answer, and nothing comes twice."""

from __future__ import annotations

import threading
from typing import NamedTuple

import pytest
import zenoh

from robolink.transport import zenoh_mending
from robolink.transport.base import Sample
from robolink.transport.zenoh_mending import MOST_SENDERS, Mending
from tests.support.transports import stamped

GID = b"%16d" % 0


def sample(number: int, publisher: int = 0) -> Sample:
    return Sample(b"%d" % number, stamped(number, publisher))


def numbers(passed: list[Sample]) -> list[int]:
    return [int(each.payload) for each in passed]


@pytest.fixture
def passed() -> list[Sample]:
    return []


@pytest.fixture
def mending(passed: list[Sample]) -> Mending:
    return Mending(passed.append)


def test_gaps_are_nobodys_business_where_nothing_was_cut(mending: Mending, passed: list[Sample]) -> None:
    for number in (1, 5, 4, 9, 9):
        mending(sample(number))
    assert numbers(passed) == [1, 5, 4, 9, 9]


def test_what_is_behind_a_gap_waits_for_the_answer(mending: Mending, passed: list[Sample]) -> None:
    mending(sample(1))
    mending.begin(1, 60.0)
    for each in (sample(2), sample(6), sample(5), sample(7), sample(3, publisher=1)):
        mending(each)
    assert numbers(passed) == [1, 2]
    mending.take([sample(2), sample(3), sample(4)])
    assert numbers(passed) == [1, 2, 3, 4, 5, 6, 7]
    mending.end()
    assert numbers(passed) == [1, 2, 3, 4, 5, 6, 7, 3]


def test_who_publishes_for_the_first_time_does_not_wait(mending: Mending, passed: list[Sample]) -> None:
    mending.begin(1, 60.0)
    for number in (1, 2, 3):
        mending(sample(number))
    assert numbers(passed) == [1, 2, 3]


def test_a_publisher_that_is_thinned_does_not_wait_for_anothers_answer(mending: Mending, passed: list[Sample]) -> None:
    for number in (1, 6):
        mending(sample(number))
    mending.begin(1, 60.0)
    for number in (11, 16):
        mending(sample(number))
    assert numbers(passed) == [1, 6, 11, 16]


def test_what_is_late_lets_go_what_waits_for_it_and_nothing_is_asked_for_twice(
    mending: Mending, passed: list[Sample]
) -> None:
    mending(sample(1))
    mending.begin(1, 60.0)
    for number in (3, 2, 4):
        mending(sample(number))
    assert numbers(passed) == [1, 2, 3, 4]
    mending.end()
    for number in (6, 5):
        mending(sample(number))
    assert mending.positions() == {GID: 6}


def test_so_many_bytes_wait_and_no_more(
    mending: Mending, passed: list[Sample], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_mending, "MOST_HELD", 3)
    mending.begin(1, 60.0)
    for number in (3, 4, 2):
        mending(sample(number))
    assert numbers(passed) == []
    mending(sample(8))
    assert numbers(passed) == [2, 3, 4, 8]
    mending(sample(20))
    assert numbers(passed) == [2, 3, 4, 8, 20]


def test_what_the_lost_link_brings_late_does_not_come_again(mending: Mending, passed: list[Sample]) -> None:
    mending(sample(1))
    mending.begin(1, 60.0)
    mending.take([sample(2), sample(3)])
    mending.end()
    for number in (2, 3, 4):
        mending(sample(number))
    assert numbers(passed) == [1, 2, 3, 4]


def test_what_waits_is_delivered_though_the_answer_is_not_complete(mending: Mending, passed: list[Sample]) -> None:
    mending(sample(1))
    mending.begin(2, 60.0)
    mending(sample(5))
    mending.take([sample(3)])
    mending.end()
    assert numbers(passed) == [1, 3]
    mending.end()
    assert numbers(passed) == [1, 3, 5]


def test_nothing_waits_when_nobody_tells_of_the_end(mending: Mending, passed: list[Sample]) -> None:
    mending(sample(1))
    mending.begin(1, 0.0)
    mending(sample(5))
    mending(sample(7))
    assert numbers(passed) == [1, 5, 7]


def test_messages_without_a_number_and_of_many_publishers_pass(mending: Mending, passed: list[Sample]) -> None:
    mending.begin(1, 60.0)
    mending(Sample(b"1", b""))
    mending.take([(b"", b"")])
    mending.end()
    for publisher in range(MOST_SENDERS + 1):
        mending(sample(2, publisher))
    assert len(passed) == MOST_SENDERS + 2
    assert len(mending.positions()) == MOST_SENDERS


def test_who_is_silent_the_longest_is_forgotten_first(mending: Mending) -> None:
    for publisher in range(1, MOST_SENDERS - 50):
        mending(sample(publisher, publisher=0))
        mending(sample(1, publisher))
    for publisher in range(MOST_SENDERS, MOST_SENDERS + 100):
        mending(sample(1, publisher))
    assert len(mending.positions()) == MOST_SENDERS
    assert mending.positions()[GID] == MOST_SENDERS - 51


def test_a_thread_of_zenohs_keeps_its_python_state(
    mending: Mending, passed: list[Sample], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_mending, "_staying", staying := set[int]())
    mending(sample(1))
    assert not staying  # a thread of Python's
    for number in (2, 3):
        mending(Foreign(zenoh.ZBytes(stamped(number))))
    assert staying == {threading.get_ident()}
    assert len(passed) == 3


class Foreign(NamedTuple):
    """A message as Zenoh brings it."""

    attachment: zenoh.ZBytes
    payload: bytes = b""


def test_nothing_comes_after_the_end(mending: Mending, passed: list[Sample]) -> None:
    mending.close()
    mending.take([sample(1)])
    assert passed == []
