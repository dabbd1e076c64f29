"""A mirror with much to do: floods, many endpoints, two threads that publish at once."""

from __future__ import annotations

import sys
import threading
from typing import Any

import pytest

from robolink.dds.mirror import lanes, mirror
from robolink.dds.mirror.mirror import LINGER, Mirror
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.wire import (
    DataKey,
    EndpointKind,
    format_key,
    format_token,
    gid_of,
    graph_pattern,
    pack_attachment,
)
from tests.support.mirrored import Mirrored, heard, raw_tokens, send
from tests.support.waits import wait_until


def test_a_flood_is_carried_or_counted(joined: Mirrored, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lanes, "MOST_WAITING", 100)
    got = heard(joined.b.node("listener"), qos=1000)
    publisher = joined.a.node("talker").create_publisher(Int32, "chatter", 1000)
    joined.until(lambda: publisher.get_subscription_count() == 1)
    joined.run(0.1)
    send(publisher, *range(1000))
    joined.until(lambda: got and got[-1] == 999)
    assert joined.mirror is not None
    assert len(got) + joined.mirror.count().dropped == 1000
    assert got == list(range(1000))[-len(got) :]


def test_large_messages_in_a_flood_are_dropped_by_their_size(joined: Mirrored, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lanes, "MOST_BYTES_WAITING", 1 << 20)
    got = heard(joined.b.node("listener"), kind=String, qos=1000)
    publisher = joined.a.node("talker").create_publisher(String, "chatter", 1000)
    joined.until(lambda: publisher.get_subscription_count() == 1)
    joined.run(0.1)
    for _ in range(200):
        publisher.publish(String(data="x" * 10_000))
    joined.run(0.3)
    assert 100 <= len(got) <= 110


def test_the_graph_of_many_takes_time_in_proportion(joined: Mirrored) -> None:
    """Twice as many endpoints of one topic are no more than about twice the work: counted, not timed."""

    def work(count: int) -> int:
        session = joined.a.session()
        listener = joined.b.session()
        token = raw_tokens(session.session_id)[0]
        calls = 0

        def profile(_: Any, event: str, __: Any) -> None:
            nonlocal calls
            calls += event == "call"

        texts = []
        for number in range(count):
            texts.append((session, token._replace(node_id=str(number), endpoint_id=f"p{number}")))
            other = token._replace(session=listener.session_id, kind=EndpointKind.SUBSCRIPTION)
            texts.append((listener, other._replace(node_id=str(number), endpoint_id=f"s{number}")))
        handles = [each.announce(format_token(token)) for each, token in texts]
        assert joined.mirror is not None
        sys.setprofile(profile)
        joined.mirror.step()
        sys.setprofile(None)
        for handle in handles:
            handle.close()
        joined.run(LINGER + 0.1)
        return calls

    small, large = work(50), work(200)
    assert large < 5.5 * small


def test_more_than_a_session_may_have_is_not_mirrored(joined: Mirrored, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mirror, "MOST_OF_SESSION", 5)
    session = joined.a.session()
    token = raw_tokens(session.session_id)[0]
    for number in range(9):
        session.announce(format_token(token._replace(endpoint_id=f"e{number}")))
    joined.run(0.1)
    assert len([each for each in joined.b.session().tokens(graph_pattern(0)) if "/raw/" in each]) == 5


def test_threads_of_its_own(scene: Mirrored) -> None:
    """As the bridge runs it: two networks whose sinks are called under a lock, and publishers on both at once."""
    sessions = [half.session() for half in scene.halves]
    mirror = Mirror(sessions[0], sessions[1])
    mirror.start()
    got: list[list[bytes]] = [[], []]
    ends = []
    for number, half in enumerate(scene.halves):
        session = half.session()
        token = raw_tokens(session.session_id)[0]
        key = format_key(DataKey(0, token.name, token.type_name, token.type_hash))
        session.subscribe(key, token.qos, lambda pair, number=number: got[number].append(pair[0]))  # type: ignore[misc]
        session.announce(format_token(token._replace(kind=EndpointKind.SUBSCRIPTION, endpoint_id="9")))
        outlet = session.advertise(key, token.qos)
        session.announce(format_token(token))
        ends.append((outlet, gid_of(format_token(token)), session))

    def talk(end: Any, mark: bytes) -> None:
        for number in range(500):
            end[0].put(mark + b"%d" % number, pack_attachment(number + 1, 0, end[1]))

    wait_until(lambda: all(len(session.tokens(graph_pattern(0))) == 4 for _, _, session in ends))
    threads = [threading.Thread(target=talk, args=(end, mark)) for end, mark in zip(ends, (b"a", b"b"), strict=True)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    wait_until(lambda: all(len(each) == 1000 for each in got))
    for own, other, texts in ((b"a", b"b", got[0]), (b"b", b"a", got[1])):
        assert [text for text in texts if text.startswith(own)] == [own + b"%d" % n for n in range(500)]
        assert [text for text in texts if text.startswith(other)] == [other + b"%d" % n for n in range(500)]
    mirror.close()
    mirror.close()
    assert all(len(session.tokens(graph_pattern(0))) == 2 for _, _, session in ends)


def test_an_end_does_not_wait_for_all_that_is_to_be_carried(scene: Mirrored) -> None:
    source = scene.a.session()
    lane = lanes.Lane(source)
    began, go_on = threading.Event(), threading.Event()
    carried: list[bytes] = []

    class Slow:
        droppable = True

        def deliver(self, content: tuple[bytes, bytes]) -> None:
            began.set()
            go_on.wait(10.0)
            carried.append(content[0])

    lane.start("slow")
    sink = lane.sink(Slow())
    for number in range(1000):
        sink((b"%d" % number, b""))
    began.wait(10.0)
    threading.Timer(0.05, go_on.set).start()
    lane.stop()
    assert carried[0] == b"0"
    assert len(carried) < 50
    lane.stop()
