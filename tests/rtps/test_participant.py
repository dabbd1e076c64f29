"""Participants with sockets and threads, over loopback: which thread does what, and under which lock."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

from robolink.rtps import Endpoint, Info, Participant, Peer, Qos
from robolink.rtps.parameters import Locator
from tests.support.domains import free_dds_domain
from tests.support.rtps_network import TYPE, numbers, sample
from tests.support.waits import wait_until

ALL = Qos(depth=0)


@pytest.fixture
def domain() -> Iterator[int]:
    with free_dds_domain() as found:
        yield found


@pytest.fixture
def pair(domain: int) -> Iterator[tuple[Participant, Participant]]:
    a, b = Participant(domain), Participant(domain)
    yield a, b
    a.close()
    b.close()


def test_samples_go_both_ways_and_each_says_where_it_came_from(pair: tuple[Participant, Participant]) -> None:
    a, b = pair
    questions: list[tuple[bytes, Info]] = []
    answers: list[Info] = []

    def answer(payload: bytes, info: Info) -> None:
        questions.append((payload, info))
        answerer.put(payload, related=(info.writer, info.number))  # a callback may call anything

    answerer = b.writer("rt/answer", TYPE, ALL)
    b.reader("rt/question", TYPE, ALL, answer)
    asker = a.writer("rt/question", TYPE, ALL)
    heard = a.reader("rt/answer", TYPE, ALL, lambda _, info: answers.append(info))
    wait_until(lambda: asker.matched() and heard.matched() and answerer.matched())
    before = time.time_ns()
    for number in range(200):
        assert asker.put(sample(number)) == number + 1
    wait_until(lambda: len(answers) == 200)
    assert numbers([payload for payload, _ in questions]) == list(range(200))
    assert [info.related for info in answers] == [(asker.guid, number) for number in range(1, 201)]
    assert {info.writer for info in answers} == {answerer.guid}
    assert all(abs(info.timestamp - before) < 60e9 for info in answers)


@pytest.mark.parametrize("qos", [ALL, Qos(reliable=False)])
def test_large_samples_arrive(pair: tuple[Participant, Participant], qos: Qos) -> None:
    a, b = pair
    got: list[bytes] = []
    reader = b.reader("rt/a", TYPE, qos, lambda payload, _: got.append(payload))
    writer = a.writer("rt/a", TYPE, qos)
    wait_until(lambda: writer.matched() and reader.matched())
    for number in range(4):
        writer.put(sample(number, 1_000_000))
        wait_until(lambda: len(got) > number)  # noqa: B023 - it is called at once
    assert got == [sample(number, 1_000_000) for number in range(4)]


def test_callbacks_hold_no_lock(pair: tuple[Participant, Participant]) -> None:
    """A sink waits for a lock whose holder wants something of the participant: pitfall of every bus with a lock."""
    a, b = pair
    lock, got, is_in = threading.Lock(), [], threading.Event()

    def sink(payload: bytes, info: Info) -> None:
        is_in.set()
        with lock:
            got.append(payload)

    reader = b.reader("rt/a", TYPE, ALL, sink)
    writer = a.writer("rt/a", TYPE, ALL)
    wait_until(lambda: writer.matched() and reader.matched())
    with lock:
        writer.put(sample(0))
        assert is_in.wait(5)
        b.endpoints()
        b.writer("rt/b", TYPE).put(sample(1))
    wait_until(lambda: got)


def test_nobody_waits_for_a_large_sample_to_leave_but_its_own_writer(
    pair: tuple[Participant, Participant], monkeypatch: pytest.MonkeyPatch
) -> None:
    a, b = pair
    got_large: list[bytes] = []
    got: list[bytes] = []
    b.reader("rt/large", TYPE, ALL, lambda payload, _: got_large.append(payload))
    b.reader("rt/small", TYPE, ALL, lambda payload, _: got.append(payload))
    large, small = a.writer("rt/large", TYPE, ALL), a.writer("rt/small", TYPE, ALL)
    wait_until(lambda: large.matched() and small.matched())
    send, is_paused, goes_on = a._sockets.send, threading.Event(), threading.Event()

    def pausing(address: Locator, buffers: Any, pause: float = 0.0) -> None:
        send(address, buffers, pause)
        if pause and threading.current_thread() is thread:
            is_paused.set()
            assert goes_on.wait(10)

    monkeypatch.setattr(a._sockets, "send", pausing)
    thread = threading.Thread(target=large.put, args=(sample(0, 300_000),))
    thread.start()
    assert is_paused.wait(5)
    small.put(sample(1))
    assert a.endpoints()
    wait_until(lambda: got)
    assert thread.is_alive()
    goes_on.set()
    thread.join()
    wait_until(lambda: got_large)


def test_samples_of_two_threads_leave_in_the_order_of_their_numbers(pair: tuple[Participant, Participant]) -> None:
    a, b = pair
    got: list[int] = []
    reader = b.reader("rt/a", TYPE, Qos(reliable=False), lambda _, info: got.append(info.number))
    writer = a.writer("rt/a", TYPE, ALL)
    wait_until(lambda: writer.matched() and reader.matched())

    def put() -> None:
        for number in range(100):
            writer.put(sample(number))
            time.sleep(0.0002)

    threads = [threading.Thread(target=put) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    wait_until(lambda: got and got[-1] == 400)
    assert len(got) == 400  # a best-effort reader drops what comes behind a later one


def test_a_participant_that_closes_is_gone_at_once_and_its_endpoints_before_it(domain: int) -> None:
    told: list[tuple[str, bool]] = []

    def on_peer(peer: Peer, came: bool) -> None:
        told.append(("peer", came))

    def on_endpoint(endpoint: Endpoint, came: bool) -> None:
        told.append((endpoint.topic, came))

    def on_match(endpoint: Endpoint, came: bool) -> None:
        told.append(("match", came))

    a = Participant(domain, on_peer=on_peer, on_endpoint=on_endpoint)
    b = Participant(domain, name="b", user_data=b"enclave=/;\0")
    a.reader("rt/a", TYPE, Qos(), lambda payload, info: None, on_match=on_match)
    writer = b.writer("rt/a", TYPE)
    wait_until(lambda: len(told) == 3)
    assert [(peer.name, peer.user_data) for peer in a.peers()] == [("b", b"enclave=/;\0")]
    assert [endpoint.guid for endpoint in a.endpoints()] == [writer.guid]
    assert a.settled()
    b.close()
    b.close()
    writer.close()
    assert writer.put(sample(0)) == 0
    wait_until(lambda: len(told) == 6)
    assert told == [
        ("peer", True),
        ("rt/a", True),
        ("match", True),
        ("match", False),
        ("rt/a", False),
        ("peer", False),
    ]
    a.close()
    assert not a._thread.is_alive()


def test_a_participant_may_be_closed_in_a_callback(domain: int) -> None:
    closed = threading.Event()
    a, b = Participant(domain), Participant(domain)

    def sink(payload: bytes, info: Info) -> None:
        b.close()
        closed.set()

    b.reader("rt/a", TYPE, Qos(transient_local=True), sink)
    a.writer("rt/a", TYPE, Qos(transient_local=True)).put(sample(0))
    assert closed.wait(5)
    b._thread.join(5)
    assert not b._thread.is_alive()
    a.close()


def test_a_callback_that_fails_is_logged_and_the_participant_goes_on(
    pair: tuple[Participant, Participant], caplog: pytest.LogCaptureFixture
) -> None:
    a, b = pair
    got: list[bytes] = []

    def sink(payload: bytes, info: Info) -> None:
        got.append(payload)
        raise RuntimeError("a fault of the program")

    reader = b.reader("rt/a", TYPE, ALL, sink)
    writer = a.writer("rt/a", TYPE, ALL)
    wait_until(lambda: writer.matched() and reader.matched())
    with caplog.at_level(logging.ERROR):
        for number in range(3):
            writer.put(sample(number))
        wait_until(lambda: len(got) == 3)
    assert "a fault of the program" in caplog.text


def test_a_closed_reader_gets_nothing_more_and_its_writer_knows(pair: tuple[Participant, Participant]) -> None:
    a, b = pair
    got: list[bytes] = []
    reader = b.reader("rt/a", TYPE, ALL, lambda payload, _: got.append(payload))
    writer = a.writer("rt/a", TYPE, ALL)
    wait_until(lambda: writer.matched() and reader.matched())
    reader.close()
    wait_until(lambda: not writer.matched())
    writer.put(sample(0))
    other = b.reader("rt/a", TYPE, ALL, lambda payload, _: got.append(payload))
    wait_until(lambda: writer.matched() and other.matched())
    writer.put(sample(1))
    wait_until(lambda: got)
    assert numbers(got) == [1]


def test_an_idle_participant_sleeps(pair: tuple[Participant, Participant], monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = pair
    reader = b.reader("rt/a", TYPE, ALL, lambda payload, _: None)
    writer = a.writer("rt/a", TYPE, ALL)
    wait_until(lambda: writer.matched() and reader.matched())
    writer.put(sample(0))
    timeouts: list[float] = []
    receive = a._sockets.receive

    def noting(timeout: float, take: Any) -> None:
        timeouts.append(timeout)
        receive(timeout, take)

    monkeypatch.setattr(a._sockets, "receive", noting)
    # Up to its next search, once the first ones, which come in a row, are over: 0.4 s.
    wait_until(lambda: timeouts and timeouts[-1] > 0.5)
    assert len(timeouts) < 30


def test_a_fault_at_a_datagram_is_logged_once_and_the_participant_goes_on(
    pair: tuple[Participant, Participant], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    a, b = pair
    got: list[bytes] = []
    reader = b.reader("rt/a", TYPE, ALL, lambda payload, _: got.append(payload))
    writer = a.writer("rt/a", TYPE, ALL)
    wait_until(lambda: writer.matched() and reader.matched())
    receive = b._core.receive
    faults: list[Locator] = []

    def failing(now: float, datagram: memoryview, source: Locator) -> None:
        if len(faults) < 5:
            faults.append(source)
            raise KeyError("a fault of ours")
        receive(now, datagram, source)

    monkeypatch.setattr(b._core, "receive", failing)
    with caplog.at_level(logging.ERROR):
        for number in range(10):
            writer.put(sample(number))
        wait_until(lambda: len(got) == 10)
    assert numbers(got) == list(range(10))
    assert len(caplog.records) == 1


def test_a_fault_in_what_is_due_is_logged_once_and_the_participant_goes_on(
    pair: tuple[Participant, Participant], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    a, b = pair
    got: list[bytes] = []
    tick = b._core.tick
    faults: list[float] = []

    def failing(now: float) -> float:
        if len(faults) < 3:
            faults.append(now)
            raise KeyError("a fault of ours")
        return tick(now)

    monkeypatch.setattr(b._core, "tick", failing)
    with caplog.at_level(logging.ERROR):
        reader = b.reader("rt/a", TYPE, ALL, lambda payload, _: got.append(payload))
        writer = a.writer("rt/a", TYPE, ALL)
        wait_until(lambda: writer.matched() and reader.matched() and len(faults) == 3)
        writer.put(sample(0))
        wait_until(lambda: got)
    assert len(caplog.records) == 1
