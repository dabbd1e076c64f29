"""Playback: a message that is due does not wait for the one behind it."""

from __future__ import annotations

from collections.abc import Iterator

from robolink.bag.playing.playback import Playback
from robolink.bag.playing.settings import PlaySettings
from robolink.bag.topic import BagMessage


class Slow:
    """Messages at 1, 2, ... ns, which are noted as they are read."""

    start_time, end_time = 1, 5

    def __init__(self, happened: list[str]) -> None:
        self.happened = happened

    def time_of(self, message: BagMessage) -> int:
        return message.log_time

    def messages(self, start: int, end: int | None) -> Iterator[BagMessage]:
        for number in range(start, 6):
            self.happened.append(f"read {number}")
            yield BagMessage("/a", b"", number, number)

    def latched(self, before: int) -> list[BagMessage]:
        return []


def test_a_message_is_delivered_before_the_next_one_is_read() -> None:
    happened: list[str] = []
    playback = Playback(
        Slow(happened), lambda message, _: happened.append(f"play {message.log_time}"), lambda: 0, PlaySettings()
    )
    playback.begin()
    playback.pause()
    assert playback.burst(2) == 2
    assert happened == ["read 1", "play 1", "read 2", "play 2", "read 3"]


def test_who_gets_a_message_may_jump() -> None:
    played: list[int] = []

    def deliver(message: BagMessage, _: int) -> None:
        played.append(message.log_time)
        if message.log_time == 2:
            playback.seek(4)

    playback = Playback(Slow([]), deliver, lambda: 0, PlaySettings())
    playback.begin()
    playback.pause()
    playback.burst(0)
    assert played == [1, 2, 4, 5]
