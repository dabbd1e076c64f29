"""Service calls: robolink's clients and services, and the least that a program of Zenoh does to ask and to answer.

Variants: `querier` is bare Zenoh, `future` is `call_async` and `spin_until_future_complete`, `call` is `client.call`.
"""

from __future__ import annotations

import importlib
from typing import Any

from benchmarks.messages.games import Ping, Task, say_ready, wait_for_the_end

KEY = "bench/call"
REQUEST, RESPONSE, ATTACHMENT = bytes(5), bytes(13), bytes(33)
"""As long as a Trigger's are."""

_stored: list[Any] = []


def pong(task: Task) -> None:
    """Answer."""
    if task.variant == "querier":
        answer_barely()
    else:
        from benchmarks.messages.nodes import run, started, trigger

        node = started("server")
        node.create_service(trigger(), "call", lambda _, response: response)
        say_ready()
        run(node, task)


def ping(task: Task) -> None:
    """Ask again and again, and hand in how long each answer took."""
    game = Ping(task.seconds)
    ask = asker_of_zenoh() if task.variant == "querier" else asker(task.variant)
    for _ in range(20):
        ask()
    game.play(ask, lambda _: ask() and game.answered())
    while game.answered():
        ask()


def answer_barely() -> None:
    from benchmarks.messages.bare import opened

    session = opened()

    def answer(query: Any) -> None:
        query.payload.to_bytes()
        query.reply(KEY, RESPONSE, attachment=ATTACHMENT)
        query.drop()

    _keep = session.declare_queryable(KEY, answer, complete=True)
    say_ready()
    wait_for_the_end()


def asker_of_zenoh() -> Any:
    import zenoh

    from benchmarks.messages.bare import opened, wait_for_match

    _stored.append(session := opened())
    querier = session.declare_querier(
        KEY, target=zenoh.QueryTarget.ALL_COMPLETE, consolidation=zenoh.ConsolidationMode.NONE
    )
    wait_for_match(querier)

    def ask() -> bytes:
        sample = querier.get(payload=REQUEST, attachment=ATTACHMENT).recv().ok
        assert sample is not None
        return bytes(sample.payload.to_bytes())

    return ask


def asker(variant: str) -> Any:
    from benchmarks.messages.nodes import started, trigger

    spin_until_future_complete = importlib.import_module("rclpy").spin_until_future_complete
    node = started("client")
    client, request = node.create_client(trigger(), "call"), trigger().Request()
    client.wait_for_service()

    def ask_by_future() -> object:
        future = client.call_async(request)
        spin_until_future_complete(node, future)
        return future.result()

    return ask_by_future if variant == "future" else lambda: client.call(request)
