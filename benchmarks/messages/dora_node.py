"""dora: a dataflow of two nodes, started by `dora run`, whose arrays are Arrow's; numbers alone, without a ROS type.

An end's lines go to a file (BENCH_LINES), since a node's standard output is the daemon's. They
are started by `benchmarks/messages/dataflow.py`.
"""

from __future__ import annotations

import importlib
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.messages.games import Beat, Count, Ping, Task, pour
from benchmarks.messages.samples import SPIN, pixels, ranges

pa: Any = importlib.import_module("pyarrow")
LINES = "BENCH_LINES"


def node() -> Any:
    sys.stdout = Path(os.environ[LINES]).open("w", encoding="utf-8")  # noqa: SIM115 - until the process ends
    return importlib.import_module("dora").Node()


def content(task: Task) -> Any:
    if task.kind == "twist":
        return np.array((0.3, 0.0, 0.0, 0.0, 0.0, SPIN))
    return np.array(ranges(), np.float32) if task.kind == "scan" else np.frombuffer(pixels(task.kind), np.uint8).copy()


def array(event: Any) -> Any:
    """Return the array that has come."""
    return event["value"].to_numpy(zero_copy_only=True)


def pong(_: Task) -> None:
    own = node()
    for event in own:
        if event["type"] == "INPUT":
            own.send_output("ball", pa.array(array(event)))


def ping(task: Task) -> None:
    own, game, message = node(), Ping(task.seconds, retry=3.0), content(task)

    def serve(seconds: float) -> None:
        event = own.next(seconds)
        if event is None or event["type"] != "INPUT":
            return
        got = array(event)
        if game.answered():
            own.send_output("ball", pa.array(message))
        elif game.checked is None:
            game.checked = bool(np.all(got == message))

    game.play(lambda: own.send_output("ball", pa.array(message)), serve)
    while True:
        serve(1.0)


def sink(_: Task) -> None:
    own, count = node(), Count()
    for event in own:
        if event["type"] == "INPUT":
            count.add(numbers(array(event))[0])
    count.say()


def numbers(message: Any) -> Any:
    """Return the part of an array whose first element is a flood's number."""
    return message if message.dtype == np.float64 else message[:8].view(np.int64)


def source(task: Task) -> None:
    own, message = node(), content(task)
    place = numbers(message)

    def send(number: int) -> None:
        place[0] = number
        own.send_output("ball", pa.array(message))

    time.sleep(0.2)
    pour(task, send)


def beat(task: Task) -> None:
    """Publish for each event of dora's timer."""
    own, message = node(), content(task)
    beats = Beat(task, lambda: own.send_output("ball", pa.array(message)))
    for event in own:
        if event.get("id") == "tick":
            beats.tick()
