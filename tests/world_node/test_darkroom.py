"""The thread of images: its order, what it leaves out, and that nothing ends it."""

from __future__ import annotations

import functools
import threading
from collections.abc import Iterator

import pytest

from robolink.exceptions import InvalidHandle
from robolink.world_node.camera_topics import MOST, Darkroom


@pytest.fixture
def told() -> list[str]:
    return []


@pytest.fixture
def darkroom(told: list[str]) -> Iterator[Darkroom]:
    made = Darkroom(told.append)
    yield made
    made.close()


def fail(error: Exception) -> None:
    raise error


def test_jobs_are_done_in_their_order_on_another_thread(darkroom: Darkroom) -> None:
    here, done = threading.current_thread(), list[tuple[int, bool]]()

    def note(number: int) -> None:
        done.append((number, threading.current_thread() is here))

    for number in range(5):
        assert darkroom.submit(number, functools.partial(note, number))
    darkroom.close()
    assert done == [(number, False) for number in range(5)]


def test_jobs_are_left_out_while_too_many_with_their_key_wait(darkroom: Darkroom) -> None:
    go, done = threading.Event(), list[str]()
    assert all(darkroom.submit("a", lambda: go.wait(10.0)) for _ in range(MOST))
    assert not darkroom.submit("a", lambda: done.append("a"))
    assert darkroom.submit("b", lambda: done.append("b"))
    go.set()
    darkroom.close()
    assert done == ["b"]
    assert darkroom.submit("a", lambda: done.append("again"))
    darkroom.close()
    assert done == ["b", "again"]


def test_an_error_is_told_and_later_jobs_are_done(darkroom: Darkroom, told: list[str]) -> None:
    done: list[int] = []
    darkroom.submit(1, lambda: fail(ZeroDivisionError("oh")))
    darkroom.submit(2, lambda: done.append(2))
    darkroom.close()
    assert done == [2]
    assert told == ["an image could not be published: ZeroDivisionError: oh"]


def test_a_robot_that_has_left_is_no_error(darkroom: Darkroom, told: list[str]) -> None:
    darkroom.submit(1, lambda: fail(InvalidHandle("gone")))
    darkroom.close()
    assert told == []


def test_it_may_be_closed_twice_and_unused(darkroom: Darkroom) -> None:
    darkroom.close()
    darkroom.close()
