"""Scouting: who answers a multicast is told from who does not."""

from __future__ import annotations

import collections
from typing import Any, NamedTuple

import pytest
import zenoh

from robolink.transport.reach import answering


class Hello(NamedTuple):
    zid: str


class Scout:
    """Answers, each of which comes after a look that finds nothing."""

    def __init__(self, *sessions: str) -> None:
        self.left = collections.deque(answer for each in sessions for answer in (None, Hello(each)))
        self.stopped = False

    def try_recv(self) -> Hello | None:
        return self.left.popleft() if self.left else None

    def stop(self) -> None:
        self.stopped = True


def test_it_ends_once_all_have_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    scout = Scout("a", "stranger", "b", "late")
    monkeypatch.setattr(zenoh, "scout", lambda **_: scout)
    assert answering(zenoh.Config(), {"a", "b"}, within=600.0) == {"a", "stranger", "b"}
    assert scout.stopped


def test_who_is_silent_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh, "scout", lambda **_: Scout("a"))
    assert answering(zenoh.Config(), {"a", "silent"}, within=0.1) <= {"a"}


def test_without_an_interface_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(**_: object) -> Any:
        raise zenoh.ZError("no multicast")

    monkeypatch.setattr(zenoh, "scout", refuse)
    assert answering(zenoh.Config(), {"a"}, within=600.0) == frozenset()
