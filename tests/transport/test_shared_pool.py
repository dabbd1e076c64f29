"""Large payloads are written once into a pool of shared memory; where there is no room they go Zenoh's own way."""

from __future__ import annotations

import queue
import sys
import threading
from array import array
from typing import Any

import pytest
import zenoh

from robolink.transport import shared_memory
from robolink.transport.pieces import PIECE, Pieces
from robolink.transport.shared_memory import LEAST_FREE, POOL, SMALLEST_SHARED
from robolink.transport.shared_pool import SIZE, SharedPool, Sharing
from robolink.transport.zenoh_handles import ZenohOutlet
from tests.support.transports import CHATTER, PLAIN, Ear, Network, latched, until

LARGE = bytes(range(251)) * 5000
shares_here = pytest.mark.skipif(
    sys.platform != "linux" or not shared_memory.decision({}).on, reason="no shared memory here"
)


class Provider:
    """Zenoh's provider, with so many places; those that are given back are free after the next collection."""

    def __init__(self, places: int = 1) -> None:
        self.free, self.read, self.calls = places, 0, list[str]()
        self.kind = bytearray

    def garbage_collect(self) -> int:
        self.calls.append("collect")
        self.free, self.read = self.free + self.read, 0
        return 0

    def alloc(self, size: int, _policy: Any) -> bytearray:
        self.calls.append("alloc")
        if not self.free:
            raise zenoh.ZError("out of memory")
        self.free -= 1
        return self.kind(size)


class Room:
    """A pool, what it was made of, and a machine with so much free space."""

    def __init__(self, free: int = LEAST_FREE + POOL, provider: Provider | None = None, *, fails: bool = False) -> None:
        self.provider, self.fails, self.made = provider or Provider(), fails, list[int]()
        self.shares, self.looks = True, 0
        self.pool = SharedPool(self._make, lambda: free)

    def _make(self, size: int) -> Provider:
        self.made.append(size)
        if self.fails:
            raise zenoh.ZError("no room")
        return self.provider

    def _look(self) -> bool:
        self.looks += 1
        return self.shares

    def filled(self, payload: bytes | Pieces = LARGE) -> Any:
        return self.pool.filled(payload, self._look)


@pytest.mark.parametrize(
    "buffers",
    [
        [LARGE],
        [b"head", array("d", range(50_000)), b"", bytearray(b"tail")],
        [memoryview(LARGE)[7:], array("B"), LARGE[: 3 * PIECE]],
    ],
    ids=["one", "arrays", "views"],
)
def test_what_is_in_its_place_is_the_payload(buffers: list[Any]) -> None:
    payload = b"".join(bytes(each) for each in buffers)
    pieces, room = Pieces(buffers), Room(provider=Provider(2))
    assert (len(pieces), bytes(pieces), b"".join(pieces)) == (len(payload), payload, payload)
    assert room.filled(pieces) == payload
    assert room.filled(payload) == payload
    assert room.made == [SIZE]


def test_what_is_free_is_collected_before_each_message_so_that_the_same_places_are_used() -> None:
    room = Room(provider=Provider(1))
    for _ in range(3):
        assert room.filled() == LARGE
        room.provider.read = 1
    assert room.provider.calls == ["collect", "alloc"] * 3


def test_a_pool_whose_places_are_all_in_use_has_no_room_until_one_is_given_back() -> None:
    room = Room()
    assert room.filled() == LARGE
    assert room.filled() is None
    room.provider.read = 1
    assert room.filled() == LARGE


def test_no_place_is_given_away_while_another_one_is_filled_since_that_one_may_be_taken_back() -> None:
    room, others = Room(provider=Provider(2)), list[threading.Thread]()

    class Place(bytearray):
        def __setitem__(self, at: Any, part: Any) -> None:
            room.provider.kind = bytearray
            others.append(threading.Thread(target=room.filled))
            others[-1].start()
            others[-1].join(0.05)
            assert room.provider.calls == ["collect", "alloc"]
            super().__setitem__(at, part)

    room.provider.kind = Place
    assert room.filled() == LARGE
    others[0].join()
    assert room.provider.calls == ["collect", "alloc"] * 2


def test_a_signal_handler_that_publishes_while_a_place_is_filled_fills_another_one() -> None:
    room, found = Room(provider=Provider(2)), list[Any]()

    class Place(bytearray):
        def __setitem__(self, at: Any, part: Any) -> None:
            room.provider.kind = bytearray
            found.append(room.filled(LARGE[1:]))
            super().__setitem__(at, part)

    room.provider.kind = Place
    assert room.filled() == LARGE
    assert found == [LARGE[1:]]


@pytest.mark.parametrize("room", [Room(LEAST_FREE + POOL - 1), Room(fails=True)], ids=["no space", "no pool"])
def test_a_pool_for_which_there_is_no_room_is_tried_once(room: Room) -> None:
    assert [room.filled() for _ in range(3)] == [None] * 3
    assert (room.looks, len(room.made)) == (1, room.fails)


def test_no_pool_is_made_before_there_is_somebody_to_share_it_with() -> None:
    room, now = Room(), [1.0]
    sharing = Sharing(room._look, room.pool, lambda: now[0])
    room.shares = False
    assert [sharing.filled(LARGE), sharing.filled(LARGE)] == [None, None]
    assert (room.looks, room.made) == (1, [])  # a look takes a while: not for each message
    room.shares = True
    now[0] += 10
    assert sharing.filled(bytes(SMALLEST_SHARED - 1)) is None
    assert room.made == []
    assert sharing.filled(LARGE) == LARGE


@shares_here
@pytest.mark.parametrize("pieces", [False, True])
def test_it_arrives_through_shared_memory_in_order_and_whole(zenoh_net: Network, *, pieces: bool) -> None:
    out, ear, shared = zenoh_net.session().advertise(CHATTER, PLAIN), Ear(zenoh_net.session()), list[bool]()
    assert isinstance(out, ZenohOutlet)
    out.on_shared = lambda: shared.append(True)
    until(lambda: out.matched)
    for number in range(40):
        payload = number.to_bytes(4, "little") + LARGE
        out.put(Pieces([payload[:4], memoryview(payload)[4:]]) if pieces else payload, b"")
        assert ear.next() == payload
    until(lambda: bool(shared) or _put_again(out, ear))
    assert shared == [True]  # said once


def _put_again(out: ZenohOutlet, ear: Ear) -> bool:
    out.put(LARGE, b"")
    assert ear.next() == LARGE
    return False


@shares_here
def test_more_than_fits_into_the_pool_at_once_arrives_too(zenoh_net: Network) -> None:
    out, ear = zenoh_net.session().advertise(CHATTER, PLAIN), Ear(zenoh_net.session())
    until(lambda: out.matched)
    payloads = [bytes([number]) * 2_000_000 for number in range(20)]
    for payload in payloads:
        out.put(payload, b"")
    assert ear.take(20) == payloads


def test_what_is_retained_for_late_joiners_holds_no_place(zenoh_net: Network) -> None:
    out, ear = zenoh_net.session().advertise(CHATTER, latched(3)), Ear(zenoh_net.session(), qos=latched(3))
    assert isinstance(out, ZenohOutlet)
    out.on_shared = lambda: pytest.fail("it went to the pool")
    until(lambda: out.matched)
    out.put(LARGE, b"")
    assert ear.next() == LARGE
    with pytest.raises(queue.Empty):
        ear.arrived.get_nowait()
