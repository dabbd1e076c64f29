"""Ctrl-C, SIGTERM and the end of the context while a node runs on asyncio's event loop: none leaves it hanging."""

from __future__ import annotations

import asyncio
import gc
import signal
import threading
from collections.abc import Iterator

import pytest

from robolink import Context, signals
from robolink.exceptions import ExternalShutdownException, NotInitializedException
from robolink.experimental import AsyncNode
from tests.support.loops import run, until

PATIENCE = 30.0


@pytest.fixture(autouse=True)
def _handlers() -> Iterator[None]:
    signals.install_signal_handlers()
    yield
    signals.uninstall_signal_handlers()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("by", ["loop", "timer"])
def test_a_signal_ends_the_program_and_its_node(
    context: Context, number: int, by: str, caplog: pytest.LogCaptureFixture
) -> None:
    ends: list[str] = []

    async def main() -> None:
        async with AsyncNode("node", context=context) as node:
            if by == "loop":
                asyncio.get_running_loop().call_later(0.005, signal.raise_signal, number)
            else:
                node.create_timer(0.005, lambda: signal.raise_signal(number))
            try:
                await asyncio.Event().wait()
            finally:
                ends.append("block")

    with pytest.raises(KeyboardInterrupt):
        asyncio.run(main())
    assert ends == ["block"]
    assert context.nodes == []
    gc.collect()
    assert not caplog.records


@pytest.mark.parametrize("shape", ["block", "run"])
def test_a_node_in_another_thread_meets_an_external_shutdown(context: Context, shape: str) -> None:
    met: list[BaseException] = []
    running = threading.Event()

    async def main() -> None:
        node = AsyncNode("node", context=context)
        node.create_timer(0.0, running.set)
        try:
            if shape == "run":
                await node.run()
            else:
                async with node:
                    await asyncio.Event().wait()
        except BaseException as error:
            met.append(error)
            raise

    thread = threading.Thread(target=asyncio.run, args=(main(),), daemon=True)
    thread.start()
    assert running.wait(PATIENCE)
    context.interrupt()
    thread.join(PATIENCE)
    assert not thread.is_alive()
    assert [type(each) for each in met] == [ExternalShutdownException]
    assert context.nodes == []


def test_the_end_of_the_context_in_another_thread_ends_the_node(context: Context) -> None:
    async def main() -> None:
        node = AsyncNode("node", context=context)
        ending = threading.Timer(0.005, context.shutdown)
        ending.start()
        await node.run()
        await until(lambda: not ending.is_alive())

    run(main())


def test_a_node_does_not_begin_after_a_signal(context: Context) -> None:
    async def main() -> None:
        node = AsyncNode("node", context=context)
        context.interrupt()
        with pytest.raises(NotInitializedException, match="cannot run node /node"):
            await node.run()

    run(main())
