"""The contract of every transport, second part: calls, and the tokens of the graph."""

from __future__ import annotations

import functools
import queue
import random
import threading
import time

import pytest

from robolink.transport import Query, Transport
from tests.support.transports import GRAPH, PATIENCE, Caller, Desk, Network, Watcher, find, until

TOKENS = "only tokens of ROS 2's nodes and endpoints cross DDS"
SILENT = "DDS has no sign that a server will not answer"


@pytest.mark.unlike_dds("attachments of replies are made of what DDS says: tests/dds")
@pytest.mark.parametrize("place", ["the same session", "another session"])
def test_a_call_gets_its_reply_and_then_the_end(net: Network, place: str) -> None:
    session = net.session()
    desk = Desk(session)
    caller_session = session if place == "the same session" else net.session()
    find(caller_session, desk)
    caller = Caller(caller_session, b"2+3", attachment=b"me")
    query = desk.next()
    assert (query.payload, query.attachment) == (b"2+3", b"me")
    query.reply(b"5", b"you")
    query.close()
    assert caller.replies() == [(b"5", b"you")]
    assert caller.arrived.empty()


def test_a_call_that_nobody_serves_ends_at_once(net: Network) -> None:
    assert Caller(net.session()).replies() == []


def test_calls_in_flight_do_not_mix(net: Network) -> None:
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    callers = [Caller(session, b"%d" % number) for number in range(20)]
    queries = [desk.next() for _ in callers]
    for query in reversed(queries):
        query.reply(b"re " + query.payload, b"")
        query.close()
    assert [caller.answers() for caller in callers] == [[b"re %d" % number] for number in range(20)]


def test_every_server_answers_and_the_end_comes_once(net: Network) -> None:
    session, servers = net.session(), [net.session(), net.session()]
    desks = []
    for server in servers:
        desks.append(Desk(server))
    for desk in desks:
        until(functools.partial(reaches, session, desks, desk))
    caller = Caller(session, b"all")
    for number, desk in enumerate(desks):
        query = desk.next()
        query.reply(b"%d" % number, b"")
        query.close()
    assert sorted(caller.answers()) == [b"0", b"1"]
    assert caller.arrived.empty()


def reaches(session: Transport, desks: list[Desk], wanted: Desk) -> bool:
    caller = Caller(session, b"find")
    try:
        found = bool(wanted.session.accept(wanted.arrived.get(timeout=0.02)))
    except queue.Empty:
        found = False
    caller.handle.close()
    for desk in desks:
        while not desk.arrived.empty():
            desk.arrived.get()
    return found


def test_a_query_is_answered_from_any_thread(net: Network) -> None:
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    caller = Caller(session)
    query = desk.next()

    def answer() -> None:
        query.reply(b"done", b"")
        query.close()

    thread = threading.Thread(target=answer)
    thread.start()
    assert caller.answers() == [b"done"]
    thread.join(PATIENCE)


@pytest.mark.parametrize(
    "how",
    [
        pytest.param("closes", marks=pytest.mark.unlike_dds(SILENT)),
        pytest.param("forgets", marks=pytest.mark.unlike_dds(SILENT)),
        "leaves",
    ],
)
def test_a_server_that_does_not_answer_ends_the_call(net: Network, how: str) -> None:
    """This is what becomes of a service whose handler raises."""
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    caller = Caller(session)
    query: Query | None = desk.next()
    if how == "closes" and query:
        query.close()
        query.close()
    if how == "leaves":
        desk.session.close()
    query = None
    assert caller.replies() == []


def test_after_giving_up_nothing_comes_any_more(net: Network) -> None:
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    given_up = Caller(session, b"too slow")
    late = desk.next()
    given_up.handle.close()
    given_up.handle.close()
    late.reply(b"late", b"")
    late.close()
    in_time = Caller(session, b"quick")
    query = desk.next()
    query.reply(b"now", b"")
    query.close()
    assert in_time.answers() == [b"now"]
    assert given_up.arrived.empty()


def test_a_closed_server_serves_no_more(net: Network) -> None:
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    desk.handle.close()
    desk.handle.close()
    assert Caller(session, b"too late").replies() == []
    # Calls of `find` may have come late.
    assert all(desk.session.accept(desk.arrived.get()).payload == b"find" for _ in range(desk.arrived.qsize()))


def test_a_closed_session_ends_its_calls(net: Network) -> None:
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    caller = Caller(session)
    query = desk.next()
    session.close()
    assert caller.arrived.get_nowait() is None
    query.reply(b"late", b"")
    query.close()
    assert caller.arrived.empty()


def test_a_large_request_and_reply(net: Network) -> None:
    desk, session = Desk(net.session()), net.session()
    find(session, desk)
    payload = random.Random(1).randbytes(2_000_000)
    caller = Caller(session, payload)
    query = desk.next()
    assert query.payload == payload
    query.reply(payload[::-1], b"")
    query.close()
    assert caller.replies()[0].payload == payload[::-1]


@pytest.mark.unlike_dds(TOKENS)
def test_tokens_come_and_go(net: Network) -> None:
    session, other = net.session(), net.session()
    first = session.announce("@ros2_lv/0/a/first")
    own, watcher = Watcher(session), Watcher(other)
    assert own.next() == watcher.next() == ("@ros2_lv/0/a/first", True)
    second = other.announce("@ros2_lv/0/b/second")
    assert own.next() == watcher.next() == ("@ros2_lv/0/b/second", True)
    first.close()
    first.close()
    assert own.next() == watcher.next() == ("@ros2_lv/0/a/first", False)
    second.close()
    assert own.next() == watcher.next() == ("@ros2_lv/0/b/second", False)


def test_a_watch_sees_what_its_pattern_matches(net: Network) -> None:
    session = net.session()
    one, deep = Watcher(session, "@ros2_lv/0/*/x"), Watcher(session, "@ros2_lv/1/**")
    for token in ("@ros2_lv/0/a/b/x", "@ros2_lv/0/a/x", "@ros2_lv/1/a/b", "@ros2_lv/1", "@ros2_lv/11/a"):
        session.announce(token)
    assert one.next() == ("@ros2_lv/0/a/x", True)
    assert sorted((deep.next(), deep.next())) == [("@ros2_lv/1", True), ("@ros2_lv/1/a/b", True)]
    session.announce("@ros2_lv/0/end/x")
    session.announce("@ros2_lv/1/end")
    assert one.next()[0] == "@ros2_lv/0/end/x"
    assert deep.next()[0] == "@ros2_lv/1/end"


@pytest.mark.unlike_dds(TOKENS)
def test_the_tokens_of_a_session_go_with_it(net: Network) -> None:
    session, watcher = net.session(), Watcher(net.session())
    session.announce("@ros2_lv/0/a/x")
    assert watcher.next() == ("@ros2_lv/0/a/x", True)
    session.close()
    assert watcher.next() == ("@ros2_lv/0/a/x", False)


@pytest.mark.unlike_dds(TOKENS)
def test_a_closed_watch_tells_nothing(net: Network) -> None:
    session, other = net.session(), net.session()
    closed, open_still = Watcher(session), Watcher(session)
    closed.handle.close()
    closed.handle.close()
    other.announce("@ros2_lv/0/a/x")
    assert open_still.next() == ("@ros2_lv/0/a/x", True)
    assert closed.changes.empty()


@pytest.mark.unlike_dds(TOKENS)
def test_a_watch_may_act_on_what_it_sees(net: Network) -> None:
    session, other = net.session(), net.session()
    seen: queue.SimpleQueue[str] = queue.SimpleQueue()

    def on_change(token: str, alive: bool) -> None:
        seen.put(token)
        if token == "@ros2_lv/0/a/ping" and alive:
            session.announce("@ros2_lv/0/a/pong")

    session.watch(GRAPH, on_change)
    other.announce("@ros2_lv/0/a/ping")
    assert [seen.get(timeout=PATIENCE) for _ in range(2)] == ["@ros2_lv/0/a/ping", "@ros2_lv/0/a/pong"]


@pytest.mark.unlike_dds(TOKENS)
@pytest.mark.usefixtures("patient_looks")
def test_a_newcomer_lists_all_tokens(net: Network) -> None:
    tokens = []
    for number in range(4):
        session = net.session()
        tokens += [f"@ros2_lv/0/{number}/{name}" for name in ("a", "b", "c")]
        for token in tokens[-3:]:
            session.announce(token)
    session.announce("@ros2_lv/7/else")
    begin = time.monotonic()
    assert net.session().tokens(GRAPH) == tokens
    assert time.monotonic() - begin < 5
    assert net.session().tokens("@ros2_lv/8/**") == []
