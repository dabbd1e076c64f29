"""Who is announced: `zenoh` and `ros2_sdk` hear the first token, `nodes` asks a node's graph every 2 ms for `alone`."""

from __future__ import annotations

import threading
import time
from typing import Any

from benchmarks.messages.games import Task, say, say_ready, wait_for_the_end

PERIOD = 0.002


def zenoh(_: Task) -> None:
    """Say when the first token of robolink's or of a bare program came."""
    from benchmarks.messages.bare import opened

    hear(opened())


def ros2_sdk(task: Task) -> None:
    """Say when the first token of zenoh-ros2-sdk came, which connects to a port that it is given."""
    from benchmarks.messages.ros2_sdk import Peer

    hear(Peer(task, first=True).session)


def hear(session: Any) -> None:

    came = threading.Event()

    def on_token(_: object) -> None:
        if not came.is_set():
            came.set()
            say(time.monotonic())

    _keep = session.liveliness().declare_subscriber("@ros2_lv/**", on_token)
    say_ready()
    wait_for_the_end()


def nodes(_: Task) -> None:
    from benchmarks.messages.nodes import started

    node = started("watches")
    say_ready()
    while "alone" not in node.get_node_names():
        time.sleep(PERIOD)
    say(time.monotonic())
    wait_for_the_end()
