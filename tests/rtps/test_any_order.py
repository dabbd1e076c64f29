"""Participants that come, go, are cut off and lose datagrams in any order know all of each other in the end."""

from __future__ import annotations

import random

import pytest

from robolink.rtps import Qos
from robolink.rtps.core import LocalReader, LocalWriter
from robolink.rtps.discovery import fits
from robolink.rtps.parameters import Locator
from tests.support.rtps_network import VENDORS, Faults, Member, Network, numbers, sample

PROFILES = (Qos(), Qos(transient_local=True, depth=1), Qos(reliable=False), Qos(depth=0))
HEALED_WITHIN = 4.0
"""Seconds: one announcement of somebody who believes that all know him, and one question to who has not answered."""


class Story:
    """A few participants, and what befalls them by a seed."""

    def __init__(self, seed: int) -> None:
        self._dice, self.network = random.Random(seed), Network(seed)
        self.members: dict[int, Member] = {}
        self._writers: dict[int, list[LocalWriter]] = {}
        self._readers: dict[int, list[tuple[LocalReader, list[bytes]]]] = {}
        self.network.faults = Faults(
            loss=self._dice.choice((0.0, 0.05, 0.3, 0.6)),
            twice=self._dice.choice((0.0, 0.1)),
            jitter=self._dice.choice((0.0, 0.002, 0.05)),
        )

    def play(self) -> None:
        for index in range(self._dice.randint(2, 4)):
            self._join(index)
            self._wait(1.5)
        for _ in range(self._dice.randint(1, 12)):
            index = self._dice.choice([*self.members])
            self._dice.choice((self._add, self._add, self._add, self._remove, self._restart, self._cut_off))(index)
            self._wait(3.0)
        self.network.faults = Faults(jitter=0.001)

    def _wait(self, most: float) -> None:
        self.network.run(self._dice.choice((0.0, 0.001, 0.02, self._dice.uniform(0.0, most))))

    def _join(self, index: int) -> None:
        self.members[index] = self.network.join(self._dice.choice([*VENDORS]), index=index)
        self._writers[index], self._readers[index] = [], []

    def _add(self, index: int) -> None:
        member, topic, qos = self.members[index], f"rt/{self._dice.randrange(3)}", self._dice.choice(PROFILES)
        if self._dice.random() < 0.5:
            self._writers[index].append(member.writer(topic, qos=qos))
        else:
            self._readers[index].append(member.reader(topic, qos=qos))

    def _remove(self, index: int) -> None:
        for ends in (self._writers[index], [reader for reader, _ in self._readers[index]]):
            for each in ends[:1]:
                self.members[index].core.remove(self.network.now, each)
        del self._writers[index][:1], self._readers[index][:1]

    def _restart(self, index: int) -> None:
        """End it, with or without a goodbye, and start another one at its port."""
        self._dice.choice((self.members[index].kill, self.members[index].leave))()
        self._wait(3.0)
        self._join(index)

    def _cut_off(self, index: int) -> None:
        """Lose what it sends, what it is sent, or both, for less than a lease or for longer."""
        member, before = self.members[index], self.network.faults
        loses_sent, loses_received = self._dice.choice(((True, False), (False, True), (True, True)))

        def is_lost(raw: bytes, address: Locator) -> bool:
            is_sent = raw[8:20] == member.core.prefix
            return (is_sent and loses_sent) or (address in (member.metatraffic, member.default) and loses_received)

        self.network.faults = Faults(is_lost=is_lost)
        self.network.run(self._dice.choice((1.0, 5.0, 19.9, 21.0, 70.0)))
        self.network.faults = before

    def is_whole(self) -> bool:
        """Return whether all that live know each other, and whatever fits is matched at both ends."""
        for index, member in self.members.items():
            others = [other for other in self.members if other != index]
            if not {self.members[other].core.prefix for other in others} <= {e.prefix for e in member.core.peers()}:
                return False
        return all(
            reader.guid in writer.readers and writer.guid in reader.writers for writer, reader, _ in self._pairs()
        )

    def _pairs(self) -> list[tuple[LocalWriter, LocalReader, list[bytes]]]:
        return [
            (writer, reader, got)
            for index, writers in self._writers.items()
            for writer in writers
            for other, readers in self._readers.items()
            for reader, got in readers
            if other != index and reader.data.topic == writer.data.topic and fits(writer.qos, reader.qos)
        ]

    def unheard(self) -> list[str]:
        """Send a sample by each writer; return the topics of the readers that do not get it."""
        for index, writers in self._writers.items():
            for writer in writers:
                self.members[index].put(writer, sample(77))
        self.network.run(1.0)
        return [reader.data.topic for _, reader, got in self._pairs() if 77 not in numbers(got)]


@pytest.mark.parametrize("seed", range(40))
def test_all_that_live_are_matched_and_heard_once_the_network_is_well(seed: int) -> None:
    story = Story(seed)
    story.play()
    assert story.network.run(HEALED_WITHIN, until=story.is_whole)
    assert story.unheard() == []
