"""Bare zenoh-python: the least that a program can do with a message, which is to take its bytes and to send some.

Variants: `same` sends the same object again, `echo` what has just come; `handed` has each message, with an attachment,
handed to the main thread by a queue, as any program must whose callbacks run one at a time. Without a variant small
messages are the same object and large ones are made anew each time, as those of a program are that has something new to
say. The session is robolink's (its settings come in ROBOLINK_BENCH_CONFIG), and so is what happens to messages for
which there is no room.
"""

from __future__ import annotations

import functools
import os
import queue
import struct
import time
from collections.abc import Callable
from typing import Any

import zenoh

from benchmarks.messages.games import Beat, Count, Ping, Task, pour, say_ready, wait_for_the_end
from benchmarks.messages.running import CONFIG
from benchmarks.messages.samples import position


def opened() -> Any:
    return zenoh.open(zenoh.Config.from_json5(os.environ[CONFIG]))


def publisher(session: Any, key: str) -> Any:
    """A publisher as robolink's are."""
    return session.declare_publisher(
        key, congestion_control=zenoh.CongestionControl.DROP, reliability=zenoh.Reliability.RELIABLE
    )


def content(task: Task) -> bytearray:
    return bytearray((bytes(range(251)) * (task.size // 251 + 1))[: task.size])


def sender(task: Task, put: Callable[[Any], object]) -> Callable[[Any], object]:
    """Function that sends: called with each message that came, or with what is sent first."""
    buffer = content(task)
    same = bytes(buffer)
    if task.variant == "echo":
        return put
    if task.variant == "same" or not task.large:
        return lambda _: put(same)
    return lambda _: put(bytes(buffer))


def putter(task: Task, out: Any) -> Callable[[Any], object]:
    """Function that puts a payload."""
    if task.variant != "handed":
        put: Callable[[Any], object] = out.put
        return put
    return functools.partial(out.put, attachment=bytes(33))  # as long as robolink's


def subscriber(
    task: Task, session: Any, key: str, handle: Callable[[Any], object]
) -> tuple[Any, Callable[[float], object]]:
    """A subscriber, and a function that lets it call `handle`, or wait for so many seconds."""
    if task.variant != "handed":
        return session.declare_subscriber(key, handle), time.sleep
    arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def serve(seconds: float) -> None:
        try:
            got = arrived.get(True, seconds)
        except queue.Empty:
            return
        got.attachment.to_bytes()
        handle(got)

    return session.declare_subscriber(key, zenoh.handlers.Callback(arrived.put, indirect=False)), serve


def pong(task: Task) -> None:
    session = opened()
    send = sender(task, putter(task, publisher(session, "bench/pong")))
    _keep, serve = subscriber(task, session, "bench/ping", lambda got: send(got.payload.to_bytes()))
    say_ready()
    while task.variant == "handed":
        serve(1.0)
    wait_for_the_end()


def ping(task: Task) -> None:
    session, game, expected = opened(), Ping(task.seconds), bytes(content(task))
    out = publisher(session, "bench/ping")
    send = sender(task, putter(task, out))

    def on_pong(got: Any) -> None:
        data = got.payload.to_bytes()
        if game.answered():
            send(data)
        elif game.checked is None:
            game.checked = data == expected

    _keep, serve = subscriber(task, session, "bench/pong", on_pong)
    wait_for_match(out)
    game.play(lambda: send(expected), serve)
    end = time.monotonic() + task.seconds + 30
    while time.monotonic() < end:
        serve(1.0)


def sink(task: Task) -> None:
    session, count = opened(), Count()
    form, place = position(task.kind)
    number, add = functools.partial(struct.Struct(form).unpack_from, offset=place), count.add
    _keep = session.declare_subscriber("bench/flood", lambda got: add(number(got.payload.to_bytes())[0]))
    count.answer()
    say_ready()
    time.sleep(task.seconds + 60)


def source(task: Task) -> None:
    session = opened()
    out = publisher(session, "bench/flood")
    put, buffer = out.put, content(task)
    form, place = position(task.kind)
    pack = struct.Struct(form).pack_into

    def send(number: int) -> None:
        pack(buffer, place, number)
        put(bytes(buffer))

    wait_for_match(out)
    time.sleep(0.2)
    pour(task, send)


def beat(task: Task) -> None:
    session = opened()
    out = publisher(session, "bench/flood")
    wait_for_match(out)
    message = bytes(content(task))
    Beat(task, lambda: out.put(message)).keep()


def wait_for_match(out: Any) -> None:
    while not out.matching_status.matching:
        time.sleep(0.005)
