"""One contract for every transport: what memory does in a test, Zenoh does between processes."""

from __future__ import annotations

import contextlib
import queue
import random
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from robolink.exceptions import TransportClosedError, TransportError
from robolink.qos import QoSProfile
from robolink.running.inbox import Inbox
from robolink.transport import base
from robolink.transport.history import Mailbox
from tests.support.transports import (
    ADD,
    BEST_EFFORT,
    CHATTER,
    GRAPH,
    KEEP_ALL,
    OTHER,
    PATIENCE,
    PLAIN,
    Caller,
    Desk,
    Ear,
    Network,
    find,
    latched,
    reach,
    until,
)


def test_samples_arrive_whole_and_in_order(net: Network) -> None:
    outlet, ear = net.session().advertise(CHATTER, KEEP_ALL), Ear(net.session(), qos=KEEP_ALL)
    reach(outlet, ear)
    for number in range(1000):
        outlet.put(b"%d" % number, b"")
    assert ear.take(1000) == [b"%d" % number for number in range(1000)]


@pytest.mark.unlike_dds("attachments are made of what DDS says: tests/dds")
@pytest.mark.parametrize("qos", [PLAIN, BEST_EFFORT, latched(3)], ids=["reliable", "best effort", "latched"])
@pytest.mark.parametrize("size", [0, 1, 40_000, 6_200_000])
def test_payload_and_attachment_cross_unchanged(net: Network, qos: QoSProfile, size: int) -> None:
    outlet, ear = net.session().advertise(CHATTER, qos), Ear(net.session(), qos=qos)
    reach(outlet, ear)
    payload, attachment = random.Random(size).randbytes(size), bytes(range(33))
    for _ in range(20):  # on a busy machine a large one may be dropped: a publisher does not wait for its network
        outlet.put(payload, attachment)
        with contextlib.suppress(queue.Empty):
            arrived, checked = ear.arrived.get(timeout=3.0), list[bytes]()
            assert ear.session.read(arrived) == (payload, attachment)
            assert ear.session.opener(checked.append, len)(arrived) == size
            assert checked == [attachment]
            return
    raise AssertionError("it never came")


def test_every_subscription_gets_every_sample_once(net: Network) -> None:
    here, there, elsewhere = net.session(), net.session(), net.session()
    outlet = here.advertise(CHATTER, KEEP_ALL)
    ears = [Ear(session, qos=KEEP_ALL) for session in (here, here, there, there, elsewhere)]
    reach(outlet, *ears)
    for number in range(50):
        outlet.put(b"%d" % number, b"")
    outlet.put(b"end", b"")
    for ear in ears:
        assert ear.until(b"end") == [b"%d" % number for number in range(50)]
        assert ear.arrived.empty()


@pytest.mark.parametrize("published", [PLAIN, BEST_EFFORT, latched(2)], ids=["plain", "best effort", "latched"])
@pytest.mark.parametrize("subscribed", [PLAIN, BEST_EFFORT, latched(2)], ids=["plain", "best effort", "latched"])
def test_every_pair_of_profiles_talks_here_and_elsewhere(
    net: Network, published: QoSProfile, subscribed: QoSProfile
) -> None:
    here = net.session()
    own, other = Ear(here, qos=subscribed), Ear(net.session(), qos=subscribed)
    outlet = here.advertise(CHATTER, published)
    reach(outlet, own, other)
    outlet.put(b"one", b"a")
    outlet.put(b"end", b"")
    assert own.until(b"end") == other.until(b"end") == [b"one"]


def test_a_session_hears_itself_at_once(net: Network) -> None:
    session = net.session()
    ear, outlet = Ear(session), session.advertise(CHATTER, PLAIN)
    outlet.put(b"hello", b"att")
    assert session.read(ear.arrived.get_nowait()) == (b"hello", b"att")
    assert ear.arrived.empty()


def test_keys_match_exactly(net: Network) -> None:
    session, other = net.session(), net.session()
    outlet, wrong = session.advertise(CHATTER, PLAIN), session.advertise(OTHER, PLAIN)
    ears = [Ear(session), Ear(other)]
    reach(outlet, *ears)
    wrong.put(b"wrong", b"")
    outlet.put(b"right", b"")
    assert [ear.next() for ear in ears] == [b"right", b"right"]
    assert all(ear.arrived.empty() for ear in ears)


@pytest.mark.parametrize("qos", [PLAIN, latched(1)], ids=["plain", "latched"])
def test_matched_says_whether_anybody_listens(net: Network, qos: QoSProfile) -> None:
    session, other = net.session(), net.session()
    outlet = session.advertise(CHATTER, qos)

    def matched() -> bool:
        return outlet.matched

    assert not matched()
    ear = Ear(other, qos=qos)
    until(matched)
    ear.handle.close()
    until(lambda: not matched())
    own = Ear(session, qos=qos)
    assert matched()
    own.handle.close()
    outlet.close()
    assert not matched()


def test_many_threads_publish_at_once(net: Network) -> None:
    session = net.session()
    outlet, ear = session.advertise(CHATTER, KEEP_ALL), Ear(session, qos=KEEP_ALL)
    other = Ear(net.session(), qos=KEEP_ALL)
    reach(outlet, ear, other)

    def publish(who: int) -> None:
        for number in range(200):
            outlet.put(b"%d:%03d" % (who, number), b"")

    threads = [threading.Thread(target=publish, args=(who,)) for who in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    for got in (ear.take(800), other.take(800)):
        for who in range(4):
            own = [text for text in got if text.startswith(b"%d:" % who)]
            assert own == sorted(own)
            assert len(own) == 200


@pytest.mark.parametrize("place", ["the same session", "another session"])
def test_late_joiners_get_what_was_kept_then_what_comes(net: Network, place: str) -> None:
    session = net.session()
    outlet = session.advertise(CHATTER, latched(2))
    for text in (b"1", b"2", b"3"):
        outlet.put(text, b"att")
    late = Ear(session if place == "the same session" else net.session(), qos=latched(10))
    assert late.take(2) == [b"2", b"3"]
    outlet.put(b"4", b"")
    outlet.put(b"end", b"")
    assert late.until(b"end") == [b"4"]
    assert late.arrived.empty()


@pytest.mark.unlike_dds("attachments are made of what DDS says: tests/dds")
def test_what_was_kept_comes_with_its_attachment(net: Network) -> None:
    net.session().advertise(CHATTER, latched(1)).put(b"1", b"att")
    late = Ear(net.session(), qos=latched(1))
    assert late.session.read(late.arrived.get(timeout=PATIENCE)) == (b"1", b"att")


@pytest.mark.unlike_dds("a reader of DDS gets all that the writer keeps, and its mailbox keeps the last")
def test_a_late_joiner_takes_no_more_than_its_depth(net: Network) -> None:
    outlet = net.session().advertise(CHATTER, latched(5))
    for text in (b"1", b"2", b"3"):
        outlet.put(text, b"")
    assert Ear(net.session(), qos=latched(1)).next() == b"3"


def test_a_late_publisher_finds_latched_subscriptions(net: Network) -> None:
    ear, other = Ear(net.session(), qos=latched(1)), net.session()
    outlet = other.advertise(CHATTER, latched(1))
    outlet.put(b"at once", b"")
    assert ear.next() == b"at once"


def test_volatile_joiners_get_only_what_comes(net: Network) -> None:
    session = net.session()
    outlet = session.advertise(CHATTER, latched(2))
    outlet.put(b"before", b"")
    ears = [Ear(session), Ear(net.session())]
    reach(outlet, *ears)
    outlet.put(b"after", b"")
    assert [ear.next() for ear in ears] == [b"after", b"after"]


def test_what_a_publisher_kept_goes_with_it(net: Network) -> None:
    session = net.session()
    outlet = session.advertise(CHATTER, latched(2))
    outlet.put(b"gone", b"")
    outlet.close()
    stays = session.advertise(CHATTER, latched(2))
    stays.put(b"here", b"")
    for joiner in (session, net.session()):
        ear = Ear(joiner, qos=latched(5))
        assert ear.next() == b"here"
        assert ear.arrived.empty()


def test_two_publishers_keep_apart(net: Network) -> None:
    first, second = net.session(), net.session()
    for session, text in ((first, b"a"), (second, b"b")):
        outlet = session.advertise(CHATTER, latched(1))
        outlet.put(b"old", b"")
        outlet.put(text, b"")
    assert sorted(Ear(net.session(), qos=latched(5)).take(2)) == [b"a", b"b"]


def test_a_closed_subscription_hears_nothing(net: Network) -> None:
    session, other = net.session(), net.session()
    outlet = session.advertise(CHATTER, PLAIN)
    closed = [Ear(session), Ear(other), Ear(session, qos=latched(1)), Ear(other, qos=latched(1))]
    ears = [Ear(session), Ear(other)]
    reach(outlet, *closed, *ears)
    for ear in closed:
        ear.handle.close()
        ear.handle.close()
    counts = [ear.arrived.qsize() for ear in closed]
    outlet.put(b"after", b"")
    assert [ear.next() for ear in ears] == [b"after", b"after"]
    assert [ear.arrived.qsize() for ear in closed] == counts


def test_a_busy_session_closes_quickly_and_for_good(net: Network) -> None:
    session, other = net.session(), net.session()
    outlet = other.advertise(CHATTER, PLAIN)
    ears = [Ear(session), Ear(session, qos=latched(1))]
    desk = Desk(session)
    own = session.advertise(OTHER, PLAIN)
    reach(outlet, *ears)
    find(other, desk)
    stop, refused = threading.Event(), threading.Event()

    def publish() -> None:
        while not stop.is_set():
            outlet.put(b"x" * 1000, b"")
            other.call(ADD, b"", b"", lambda _: None)

    def publish_own() -> None:
        try:
            while not stop.is_set():
                own.put(b"x", b"")
        except TransportClosedError:
            refused.set()

    threads = [threading.Thread(target=publish), threading.Thread(target=publish_own)]
    for thread in threads:
        thread.start()
    ears[0].take(20)
    begin = time.monotonic()
    session.close()
    took = time.monotonic() - begin
    counts = [ear.arrived.qsize() for ear in ears] + [desk.arrived.qsize()]
    witness = Ear(other)
    witness.take(20)
    assert refused.wait(PATIENCE)
    stop.set()
    for thread in threads:
        thread.join(PATIENCE)
    assert took < 4.0
    assert [ear.arrived.qsize() for ear in ears] + [desk.arrived.qsize()] == counts


def test_what_is_closed_says_so(net: Network) -> None:
    session = net.session()
    outlet, closed = session.advertise(CHATTER, PLAIN), session.advertise(OTHER, latched(1))
    closed.close()
    closed.close()
    session.advertise(OTHER, PLAIN).put(b"the session goes on", b"")
    with pytest.raises(TransportClosedError):
        closed.put(b"", b"")
    session.close()
    session.close()
    uses: list[Callable[[], object]] = [
        lambda: outlet.put(b"", b""),
        lambda: outlet.put(bytes(100_000), b""),
        lambda: session.advertise(CHATTER, PLAIN),
        lambda: session.advertise(CHATTER, latched(1)),
        lambda: session.subscribe(CHATTER, PLAIN, print),
        lambda: session.subscribe(CHATTER, latched(1), print),
        lambda: session.serve(ADD, print),
        lambda: session.call(ADD, b"", b"", print),
        lambda: session.announce("@ros2_lv/0/a"),
        lambda: session.watch(GRAPH, print),
        lambda: session.tokens(GRAPH),
    ]
    for use in uses:
        with pytest.raises(TransportClosedError, match="closed"):
            use()
    outlet.close()


def test_session_ids_are_hex_and_differ(net: Network) -> None:
    first, second = net.session(), net.session()
    assert int(first.session_id, 16) != int(second.session_id, 16)
    assert first.session_id == first.session_id.lower()


class Subscriber:
    """What a subscription of a node is to an inbox: a mailbox."""

    straight = False

    def __init__(self, inbox: Inbox, depth: int) -> None:
        self.inbox, self.mailbox, self.sink = inbox, Mailbox(depth), inbox.sink(self)

    def deliver(self, arrived: Any) -> None:
        self.mailbox.put(arrived)

    def arrivals(self) -> int:
        self.inbox.sweep()
        return self.mailbox.dropped + len(self.mailbox)


def test_the_last_few_are_kept_and_the_rest_is_counted(net: Network) -> None:
    session, target = net.session(), Subscriber(Inbox(), depth=3)
    session.subscribe(CHATTER, KEEP_ALL, target.sink)
    outlet = net.session().advertise(CHATTER, KEEP_ALL)
    until(lambda: outlet.matched)
    for number in range(10):
        outlet.put(b"%d" % number, b"")
    until(lambda: target.arrivals() == 10)
    kept = [session.read(target.mailbox.take()).payload for _ in range(len(target.mailbox))]
    assert kept == [b"7", b"8", b"9"]
    assert target.mailbox.dropped == 7


def test_a_slow_subscriber_does_not_hold_up_a_fast_one(net: Network) -> None:
    """A camera that nobody has time for, and a topic beside it in the same session that must not notice."""
    publisher, session = net.session(), net.session()
    slow, fast = Subscriber(Inbox(), depth=2), Subscriber(Inbox(), depth=0)
    session.subscribe(CHATTER, PLAIN, slow.sink)
    session.subscribe(OTHER, KEEP_ALL, fast.sink)
    camera, quick = publisher.advertise(CHATTER, KEEP_ALL), publisher.advertise(OTHER, KEEP_ALL)
    until(lambda: camera.matched and quick.matched)
    took = 0.0
    for number in range(100):
        camera.put(bytes(100_000), b"")
        begin = time.perf_counter()
        quick.put(b"%d" % number, b"")
        while len(fast.mailbox) == 0:
            if (arrival := fast.inbox.wait(PATIENCE)) is not None:
                fast.inbox.deliver(arrival)
        took = max(took, time.perf_counter() - begin)
        assert session.read(fast.mailbox.take()).payload == b"%d" % number
    assert took < 4.0
    until(lambda: slow.arrivals() == 100)
    assert len(slow.mailbox) == 2


def test_a_message_that_no_receiver_would_take_is_refused(net: Network, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(base, "LARGEST_PAYLOAD", 100_000)
    session = net.session()
    outlet, desk = session.advertise(CHATTER, PLAIN), Desk(session)
    outlet.put(bytes(100_000), b"")
    with pytest.raises(TransportError, match=r"chatter.*: a message of 100,001 bytes .* \(100,000\): send it in parts"):
        outlet.put(bytes(100_001), b"")
    with pytest.raises(TransportError, match="100,001 bytes"):
        session.call(ADD, bytes(100_001), b"", print)
    caller = Caller(session)
    with pytest.raises(TransportError, match=r"the answer to a call of 0/add_two_ints/.*: a message of 100,001 bytes"):
        desk.next().reply(bytes(100_001), b"")
    assert caller.arrived.get(timeout=PATIENCE) is None


@pytest.mark.processes
def test_a_message_beyond_the_64_mib_that_once_were_the_limit_arrives(zenoh_net: Network) -> None:
    outlet, ear = zenoh_net.session().advertise(CHATTER, PLAIN), Ear(zenoh_net.session())
    reach(outlet, ear)
    for _ in range(20):  # on a busy machine one may be dropped
        outlet.put(bytes(65 << 20), b"")
        with contextlib.suppress(queue.Empty):
            assert ear.session.size(ear.arrived.get(timeout=3.0)) == 65 << 20
            return
    raise AssertionError("it never came")
