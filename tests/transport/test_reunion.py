"""A session that is opened again, since this machine has another address: all goes on, and nothing comes twice."""

from __future__ import annotations

import contextlib
import itertools
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
import zenoh

from robolink.exceptions import SessionReplacedError, TransportClosedError
from robolink.transport import addresses, network, open_zenoh, roaming
from robolink.transport.base import Sample
from robolink.transport.reach import Reach
from robolink.transport.roaming import Moves, RoamingTransport
from robolink.transport.zenoh_handles import Changes
from robolink.transport.zenoh_mending import MOST, Sieve
from tests.support import stalls
from tests.support.reunions import move, play
from tests.support.transports import (
    CHATTER,
    KEEP_ALL,
    OTHER,
    PATIENCE,
    Caller,
    Desk,
    Ear,
    Watcher,
    find,
    latched,
    reach,
    stamped,
    until,
)

TOKEN = "@ros2_lv/0/a/0/0/NN/%/%/robot"
ANOTHER = "@ros2_lv/0/b/0/0/NN/%/%/laptop"


class Pair:
    """Two sessions as on networks that leave the machine, of which the first one is opened again."""

    def __init__(self, here: RoamingTransport, there: RoamingTransport) -> None:
        self.here, self.there = here, there

    def reopen(self) -> None:
        former = self.here.plain
        self.here.reopen()
        assert self.here.plain is not former


def opened(domain: int) -> RoamingTransport:
    transport = open_zenoh(domain, environ={})
    assert isinstance(transport, RoamingTransport)
    return transport


@pytest.fixture
def pair(domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[Pair]:
    monkeypatch.setattr(Reach, "leaves_machine", True)
    monkeypatch.setattr(addresses, "watch", lambda _: None)
    monkeypatch.setattr(roaming, "SETTLED_AFTER", 0.0)  # only watches settle
    monkeypatch.setattr(roaming, "OVERLAP", 0.5)
    monkeypatch.setattr(roaming, "LINKS_WITHIN", PATIENCE)  # on a busy machine
    there = opened(domain)  # it holds the rendezvous port, and stays
    with contextlib.closing(there), contextlib.closing(opened(domain)) as here:
        yield Pair(here, there)


@pytest.mark.slow
def test_topics_go_on_in_both_directions(pair: Pair) -> None:
    outlets = pair.here.advertise(CHATTER, KEEP_ALL), pair.there.advertise(OTHER, KEEP_ALL)
    ears = Ear(pair.there, CHATTER, KEEP_ALL), Ear(pair.here, OTHER, KEEP_ALL)
    for _ in range(2):
        for outlet, ear in zip(outlets, ears, strict=True):
            reach(outlet, ear)
        pair.reopen()
    for outlet, ear in zip(outlets, ears, strict=True):
        reach(outlet, ear)
        outlet.put(b"hello", b"")
        assert ear.next() == b"hello"
        assert outlet.matched


@pytest.mark.slow
def test_services_go_on_in_both_directions(pair: Pair) -> None:
    for server, client in ((pair.here, pair.there), (pair.there, pair.here)):
        desk = Desk(server)
        find(client, desk)
        pair.reopen()
        find(client, desk)
        caller = Caller(client, b"2 + 2")
        query = desk.next()
        query.reply(b"4", b"")
        query.close()
        assert [each.payload for each in caller.replies()] == [b"4"]
        desk.handle.close()


def test_a_call_that_is_under_way_ends_with_an_error(pair: Pair) -> None:
    desk = Desk(pair.there)
    find(pair.here, desk)
    caller = Caller(pair.here, b"2 + 2")
    query = desk.next()
    pair.reopen()
    with pytest.raises(SessionReplacedError, match="call again if that does no harm"):
        pair.here.read(caller.arrived.get(timeout=PATIENCE))
    assert caller.replies() == []
    query.close()


def test_a_call_that_was_given_up_stays_so(pair: Pair) -> None:
    desk = Desk(pair.there)
    find(pair.here, desk)
    caller = Caller(pair.here, b"2 + 2")
    query = desk.next()
    caller.handle.close()
    pair.reopen()
    assert caller.arrived.empty()
    query.close()


def test_a_call_that_has_been_answered_stays_so(pair: Pair) -> None:
    desk = Desk(pair.there)
    find(pair.here, desk)
    caller = Caller(pair.here, b"2 + 2")
    query = desk.next()
    query.reply(b"4", b"")
    query.close()
    assert [each.payload for each in caller.replies()] == [b"4"]
    pair.reopen()
    assert caller.arrived.empty()


def test_nobody_sees_a_node_go_whose_session_is_opened_again(pair: Pair) -> None:
    pair.here.announce(TOKEN)
    watcher = Watcher(pair.there)
    assert watcher.next() == (TOKEN, True)
    pair.reopen()
    pair.here.announce(ANOTHER)
    assert watcher.next() == (ANOTHER, True)
    assert TOKEN in pair.there.tokens("@ros2_lv/0/**")


@pytest.mark.slow
def test_a_watch_tells_of_what_came_and_went_meanwhile(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(roaming, "SETTLED_AFTER", 5.0)
    own, others = pair.here.announce(TOKEN), pair.there.announce(ANOTHER)
    watcher = Watcher(pair.here)
    assert {watcher.next(), watcher.next()} == {(TOKEN, True), (ANOTHER, True)}
    pair.reopen()
    others.close()
    assert watcher.next() == (ANOTHER, False)
    own.close()
    assert watcher.next() == (TOKEN, False)


def test_a_token_that_is_not_found_again_is_told_as_gone() -> None:
    told: list[tuple[str, bool]] = []
    changes = Changes(lambda token, alive: told.append((token, alive)))
    changes(token_sample(TOKEN))
    changes(token_sample(ANOTHER))
    changes.count_again()
    changes(token_sample(ANOTHER))
    changes.settle()
    changes.settle()
    assert told == [(TOKEN, True), (ANOTHER, True), (TOKEN, False)]


def token_sample(token: str) -> Any:
    class Found:
        key_expr, kind = token, zenoh.SampleKind.PUT

    return Found()


def test_latched_values_are_there_for_late_joiners_and_come_once(pair: Pair) -> None:
    outlet = pair.here.advertise(CHATTER, latched(3))
    for number in range(5):
        outlet.put(b"%d" % number, stamped(number))
    early, own = Ear(pair.there, qos=latched(3)), Ear(pair.here, qos=latched(3))
    assert early.take(3) == own.take(3) == [b"2", b"3", b"4"]
    pair.reopen()
    late = Ear(pair.there, qos=latched(3))
    assert late.take(3) == [b"2", b"3", b"4"]
    outlet.put(b"5", stamped(5))
    assert [each.next() for each in (late, early, own)] == [b"5"] * 3


def test_latched_values_of_others_come_once(pair: Pair) -> None:
    outlet = pair.there.advertise(CHATTER, latched(2))
    ear = Ear(pair.here, qos=latched(2))
    outlet.put(b"1", stamped(1))
    assert ear.next() == b"1"
    pair.reopen()
    outlet.put(b"2", stamped(2))
    assert ear.next() == b"2"


@pytest.mark.slow
def test_what_is_published_and_declared_meanwhile_is_neither_lost_nor_doubled(pair: Pair) -> None:
    outlet, ears = pair.here.advertise(CHATTER, KEEP_ALL), [Ear(each, qos=KEEP_ALL) for each in (pair.here, pair.there)]
    reach(outlet, *ears)
    has_moved, numbers = threading.Event(), itertools.count()

    def publish() -> list[int]:
        sent = []
        while not has_moved.is_set():
            sent.append(next(numbers))
            outlet.put(b"%d" % sent[-1], stamped(sent[-1]))
            time.sleep(0.001)
        return sent

    def declare() -> None:
        while not has_moved.is_set():
            pair.here.subscribe(OTHER, KEEP_ALL, bool).close()
            pair.here.advertise(OTHER, latched(1)).close()
            pair.here.announce(ANOTHER).close()
            pair.here.serve(OTHER, bool).close()

    with ThreadPoolExecutor(4) as pool:
        publishing, declaring = [pool.submit(publish) for _ in range(2)], pool.submit(declare)
        try:
            pair.reopen()
            pair.reopen()
        finally:
            has_moved.set()
        declaring.result(PATIENCE)
        sent = sorted(number for each in publishing for number in each.result(PATIENCE))
    assert sorted(map(int, ears[0].take(len(sent)))) == sent
    until(lambda: ears[1].arrived.qsize() >= len(sent))
    assert sorted(map(int, ears[1].take(len(sent)))) == sent
    assert all(ear.arrived.empty() for ear in ears)


def test_what_has_been_closed_meanwhile_stays_so(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    outlet, ear = pair.there.advertise(CHATTER, KEEP_ALL), Ear(pair.here, qos=KEEP_ALL)
    own = pair.here.advertise(OTHER, KEEP_ALL)
    reach(outlet, ear)
    made = RoamingTransport._declare_in

    def closed_then(here: Any, plain: Any) -> Any:
        declared = made(here, plain)
        ear.handle.close()
        own.close()
        return declared

    monkeypatch.setattr(RoamingTransport, "_declare_in", closed_then)
    pair.reopen()
    outlet.put(b"late", b"")
    assert not {ear.handle, own} & set(pair.here._holdings.all())
    assert ear.arrived.empty()
    with pytest.raises(TransportClosedError):
        own.put(b"", b"")


def test_a_transport_that_is_closed_meanwhile_leaves_no_session(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    opened = list[Any]()
    made = RoamingTransport._declare_in

    def closed_then(here: Any, plain: Any) -> Any:
        opened.append(plain.session)
        declared = made(here, plain)
        pair.here.close()
        return declared

    pair.here.advertise(CHATTER, KEEP_ALL)
    monkeypatch.setattr(RoamingTransport, "_declare_in", closed_then)
    pair.here.reopen()
    until(lambda: opened[0].is_closed())
    assert pair.here.plain.session.is_closed()


# --- addresses ------------------------------------------------------------------------------------------------------


def test_a_move_is_made_once_for_each_new_address() -> None:
    state = Moves()
    here, elsewhere = frozenset({"10.0.0.1"}), frozenset({"10.0.0.2"})
    assert not state.is_news(here)
    assert not state.is_news(frozenset())
    assert state.is_news(elsewhere)
    assert state.is_news(here | elsewhere)
    with state.moving:
        assert not state.is_news(elsewhere)
    state.addresses = elsewhere
    assert state.is_news(here)


def test_addresses_are_named_where_a_session_is_everywhere() -> None:
    config = network.load("subnet", 0, {}, holds_port=True)
    addresses.named(config, frozenset({"10.0.0.1", "10.1.0.1"}))
    expected = '["tcp/0.0.0.0:17447","tcp/127.0.0.1:0","tcp/10.0.0.1:0","tcp/10.1.0.1:0"]'
    assert config.get_json("listen/endpoints") == expected
    assert config.get_json("scouting/multicast/interface") == '"10.0.0.1,10.1.0.1"'


@pytest.mark.parametrize("value", ["tcp/10.0.0.9:7447", "localhost"])
def test_no_addresses_are_named_for_clients_and_this_machine(value: str) -> None:
    config, before = (network.load(value, 0, {}, holds_port=False) for _ in range(2))
    addresses.named(config, frozenset({"10.0.0.1"}))
    assert config.get_json("listen/endpoints") == before.get_json("listen/endpoints")


def test_a_watch_of_addresses_tells_each_session(monkeypatch: pytest.MonkeyPatch) -> None:
    class Session:
        def __init__(self) -> None:
            self.told: list[frozenset[str]] = []
            self.looks = 0

        def move(self, now: frozenset[str]) -> None:
            self.told.append(now)

        def unstick(self) -> None:
            self.looks += 1

    found = [frozenset({"10.0.0.1"})]
    monkeypatch.setattr(addresses, "current", lambda: found[-1])
    session = Session()
    addresses.watch(session)
    until(lambda: bool(session.told))
    found.append(frozenset({"10.0.0.2"}))
    until(lambda: session.told[-1] == found[-1] and session.looks > 1)
    assert session.told[0] == found[0]
    addresses.forget(session)


def test_the_machines_own_addresses_are_those_that_others_can_reach() -> None:
    assert not [each for each in addresses.current() if each.startswith("127.")]


# --- the sieve ------------------------------------------------------------------------------------------------------


def test_a_sieve_passes_each_message_once_and_remembers_so_many() -> None:
    passed: list[Sample] = []
    sieve = Sieve(passed.append)
    samples = [Sample(b"", stamped(number)) for number in range(MOST + 1)]
    for each in samples * 2:
        sieve(each)
    assert passed[: len(samples)] == samples
    assert len(sieve._seen) == MOST
    sieve(Sample(b"plain", b""))
    sieve(Sample(b"plain", b""))
    assert [each.payload for each in passed[-2:]] == [b"plain"] * 2


# --- two machines ---------------------------------------------------------------------------------------------------


@pytest.mark.processes
@pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts")
def test_a_machine_with_another_address_is_found_again() -> None:
    found = play(move(), "--keep-all", settles=60.0)
    assert found.back < float("inf")
    assert found.latched
