"""Recovery of messages that a lost link has cost: they come once, in their order, and nobody asks without a cut."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, cast

import msgspec
import pytest
import zenoh

from robolink.qos import QoSProfile
from robolink.transport import addresses, open_zenoh, roaming, zenoh_recovery
from robolink.transport.addresses import PAUSE, Waiting
from robolink.transport.base import Sample
from robolink.transport.reach import Link, Reach
from robolink.transport.roaming import RoamingTransport
from robolink.transport.roaming_handles import Holdings, RoamingSubscription
from robolink.transport.zenoh_mending import Mending
from robolink.transport.zenoh_recovery import Answer, Position, Recovery, newer, parts, together
from tests.support.ports import free_port
from tests.support.transports import BEST_EFFORT, CHATTER, KEEP_ALL, OTHER, PLAIN, Ear, latched, stamped, until

GID = b"%16d" % 0


def sample(number: int, publisher: int = 0) -> Sample:
    return Sample(b"%d" % number, stamped(number, publisher))


def numbers(passed: list[Sample]) -> list[int]:
    return [int(each.payload) for each in passed]


# --- what is kept ---------------------------------------------------------------------------------------------------


def test_who_asks_gets_what_is_newer_than_what_it_has() -> None:
    retained = [sample(number) for number in (3, 4, 5)]
    assert newer(retained, Position("key", 0, {GID: 0})) == retained
    assert newer(retained, Position("key", 0, {GID: 4})) == [sample(5)]


def test_a_subscription_gets_of_unknown_publishers_what_is_younger_than_itself() -> None:
    now = time.time_ns()
    old, new = (b"old", stamped(1, at=now - 100 * 10**9)), (b"new", stamped(2, at=now))
    assert newer([old, new, (b"plain", b"no number")], Position("key", 60 * 10**9, {})) == [new]


def test_an_answer_is_in_the_order_of_numbers_though_threads_overtook_each_other() -> None:
    retained = [sample(number) for number in (1, 3, 2, 4)]
    assert newer(retained, Position("key", 0, {GID: 1})) == [sample(number) for number in (2, 3, 4)]


def test_a_topic_is_asked_for_once_for_all_of_its_subscriptions() -> None:
    other = b"%16d" % 1
    positions = [Position("key", 5, {GID: 7}), Position("other", 1, {}), Position("key", 9, {GID: 3, other: 2})]
    assert together(positions) == [Position("key", 9, {GID: 3, other: 2}), Position("other", 1, {})]
    assert together(positions[::-1])[0] == Position("key", 9, {GID: 3, other: 2})


def test_an_answer_comes_in_parts_that_are_not_too_large() -> None:
    messages = [(bytes(zenoh_recovery.PART // 2), b"%d" % number) for number in range(5)]
    answers = [msgspec.msgpack.decode(each, type=Answer) for each in parts("key", messages)]
    assert [len(each.messages) for each in answers] == [2, 2, 1]
    assert [each for answer in answers for each in answer.messages] == messages


# --- who keeps ------------------------------------------------------------------------------------------------------


def nothing(*_: Any) -> Any:
    raise AssertionError("nothing is declared")


@pytest.mark.parametrize("qos", [BEST_EFFORT, latched(1)])
def test_only_reliable_volatile_topics_are_kept(qos: QoSProfile) -> None:
    recovery = Recovery(Holdings(), "a", 0, [])
    assert recovery.cache(CHATTER, qos, nothing) is None
    assert recovery.mend(CHATTER, qos, bool, nothing) is None


@pytest.mark.parametrize("thinned", [None, ["0/chatter/*/*"]])
def test_topics_that_limits_thin_are_not_kept_and_none_is_on_this_machine(thinned: list[str] | None) -> None:
    assert Recovery(Holdings(), "a", 0, thinned).cache(CHATTER, PLAIN, nothing) is None


# --- a router -------------------------------------------------------------------------------------------------------


class Cut:
    """Two sessions and the router between them, which may be gone for a while."""

    def __init__(self, stack: contextlib.ExitStack, domain: int, environ: dict[str, str]) -> None:
        self._stack, self._port = stack, free_port()
        self._router = self._open()
        network = f"tcp/127.0.0.1:{self._port}"
        self.here, self.there = (
            cast(RoamingTransport, stack.enter_context(contextlib.closing(open_zenoh(domain, network, environ))))
            for _ in range(2)
        )

    def _open(self) -> Any:
        listens = {"mode": "router", "listen": {"endpoints": [f"tcp/127.0.0.1:{self._port}"]}}
        wished = listens | {"scouting": {"multicast": {"enabled": False}}, "timestamping": {"enabled": True}}
        return self._stack.enter_context(zenoh.open(zenoh.Config.from_json5(json.dumps(wished))))

    @contextlib.contextmanager
    def cut(self) -> Iterator[None]:
        self._router.close()
        until(lambda: not self.here.links() and not self.there.links())
        yield
        self._router = self._open()


MakeCut = Callable[..., Cut]


@pytest.fixture
def make_cut(domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[MakeCut]:
    monkeypatch.setattr(Reach, "leaves_machine", True)
    monkeypatch.setattr(addresses, "watch", lambda _: None)
    with contextlib.ExitStack() as stack:
        yield lambda **environ: Cut(stack, domain, environ)


def hear(outlet: Any, ear: Ear) -> int:
    """Publish until one comes; return the number of the last one, whose forerunners have come or are forgotten."""
    for number in range(1, 10_000):
        outlet.put(b"%d" % number, stamped(number, at=time.time_ns()))
        with contextlib.suppress(Exception):
            while int(ear.session.read(ear.arrived.get(timeout=0.05)).payload) != number:
                pass
            return number
    raise AssertionError("nothing has come")


def publish(outlet: Any, first: int, count: int) -> list[bytes]:
    sent = [b"%d" % number for number in range(first, first + count)]
    for each in sent:
        outlet.put(each, stamped(int(each), at=time.time_ns()))
    return sent


@pytest.mark.slow
def test_what_was_published_during_a_cut_comes_afterwards_in_its_order(make_cut: MakeCut) -> None:
    net = make_cut()
    outlet, ears = net.here.advertise(CHATTER, KEEP_ALL), [Ear(net.there, qos=KEEP_ALL) for _ in range(2)]
    last = hear(outlet, ears[0])
    ears[1].until(b"%d" % last)
    for _ in range(2):
        with net.cut():
            sent = publish(outlet, last + 1, 100)
        last += len(sent)
        for ear in ears:
            assert ear.take(len(sent)) == sent
    sent = publish(outlet, last + 1, 10)
    assert ears[0].take(len(sent)) == sent
    assert ears[0].arrived.empty()


@pytest.mark.slow
def test_keep_last_has_the_last_of_a_cut(make_cut: MakeCut) -> None:
    net = make_cut()
    outlet, ear = net.here.advertise(CHATTER, QoSProfile(depth=10)), Ear(net.there, qos=QoSProfile(depth=10))
    last = hear(outlet, ear)
    with net.cut():
        sent = publish(outlet, last + 1, 50)
    assert ear.take(10) == sent[-10:]


@pytest.mark.slow
def test_a_publisher_that_was_silent_before_the_cut_is_asked_as_well(make_cut: MakeCut) -> None:
    net = make_cut()
    outlet, ear = net.here.advertise(CHATTER, KEEP_ALL), Ear(net.there, qos=KEEP_ALL)
    until(lambda: outlet.matched)
    until(lambda: bool(net.there._recovery._known))
    with net.cut():
        sent = publish(outlet, 1, 3)
    assert ear.take(3) == sent


@pytest.mark.slow
def test_a_thinned_topic_is_not_asked_for(make_cut: MakeCut) -> None:
    net = make_cut(ROBOLINK_LIMITS="{size: {/chatter: 1000}}")
    outlet, ear = net.here.advertise(CHATTER, KEEP_ALL), Ear(net.there, qos=KEEP_ALL)
    net.here.advertise(CHATTER.replace("chatter", "other"), KEEP_ALL)  # so that there is somebody to ask
    last = hear(outlet, ear)
    with net.cut():
        publish(outlet, last + 1, 20)
    hear_from(outlet, ear, last + 21)


def hear_from(outlet: Any, ear: Ear, first: int) -> int:
    """Publish from this number until one comes, which is the first that does; return how many it took."""
    for count in range(1, 10_000):
        publish(outlet, first + count - 1, 1)
        with contextlib.suppress(Exception):
            came = int(ear.session.read(ear.arrived.get(timeout=0.05)).payload)
            assert came >= first
            return count
    raise AssertionError("nothing has come")


def test_nonsense_is_no_question_and_no_answer(make_cut: MakeCut) -> None:
    net = make_cut()
    outlet, ear = net.here.advertise(CHATTER, KEEP_ALL), Ear(net.there, qos=KEEP_ALL)
    hear(outlet, ear)
    recovery = net.here._recovery
    pattern = f"{recovery._prefix}/**"
    for payload in (None, b"", b"nonsense", msgspec.msgpack.encode([1, 2])):
        assert list(net.there.plain.session.get(pattern, payload=payload, timeout=5.0)) == []
    replies = net.there.plain.session.get(
        pattern, payload=msgspec.msgpack.encode([Position(CHATTER, 10**12, {})]), timeout=5.0
    )
    (answer,) = [msgspec.msgpack.decode(each.ok.payload.to_bytes(), type=Answer) for each in replies]
    assert answer.key == CHATTER
    greedy = msgspec.msgpack.encode([Position(CHATTER, 10**12, {})] * 1000)
    every = zenoh.ConsolidationMode.NONE
    assert len(list(net.there.plain.session.get(pattern, payload=greedy, timeout=5.0, consolidation=every))) == 1
    mending = Mending(nothing)
    for ok in (None, zenoh_sample(b"nonsense"), zenoh_sample(msgspec.msgpack.encode(answer))):
        zenoh_recovery._take({OTHER: [mending]}, zenoh_reply(ok))


def zenoh_sample(content: bytes) -> Any:
    class Payload:
        def to_bytes(self) -> bytes:
            return content

    class Found:
        payload = Payload()

    return Found()


def zenoh_reply(found: Any) -> Any:
    class Reply:
        ok = found

    return Reply()


class Token(NamedTuple):
    """A token that has come, as Zenoh tells of it."""

    key_expr: str
    kind: zenoh.SampleKind = zenoh.SampleKind.PUT


def test_calls_without_end_do_not_fill_the_memory(make_cut: MakeCut, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_recovery, "ASKS_AFTER", (3600.0,))
    net = make_cut()
    ear = Ear(net.there, qos=KEEP_ALL)
    recovery = net.there._recovery
    recovery._known["somebody"] = None
    recovery._is_asking = True  # so that no thread takes them
    for number in range(3000):
        recovery._on_call(net.there.plain.session, cast(Any, Token(f"{recovery._prefix}/somebody/{number}")))
    assert len(recovery._to_ask) == zenoh_recovery.MOST_WAITING
    assert ear.arrived.empty()


def test_a_former_session_hears_of_others_until_it_is_left(make_cut: MakeCut) -> None:
    net = make_cut()
    Ear(net.there, qos=KEEP_ALL)
    recovery, former = net.there._recovery, net.there.plain
    (watch,) = (each for each in net.there._holdings.all() if not isinstance(each, RoamingSubscription))
    tell = watch._handle._gates[0]
    watch.move_to(net.here.plain)
    tell(Token(f"{recovery._prefix}/somebody/anywhere"))
    assert "somebody" in recovery._known
    former.close()
    tell(Token(f"{recovery._prefix}/another/anywhere"))
    assert "another" not in recovery._known


def test_a_link_that_stands_still_is_made_again(make_cut: MakeCut, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Link, "leaves_machine", True)
    net = make_cut()
    former = net.here.plain.session

    def all_wait(connections: list[tuple[Any, Any]]) -> list[Waiting]:
        return [Waiting(*each, PAUSE + 1) for each in connections]

    monkeypatch.setattr(roaming, "waiting", all_wait)

    def is_another() -> bool:
        net.here.unstick()
        return net.here.plain.session is not former

    until(is_another)
