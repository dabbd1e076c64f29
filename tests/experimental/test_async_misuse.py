"""Misuse of asyncio with nodes: each program ends with one line or rclpy's own error, and in virtual time likewise."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import logging as python_logging
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import Context, logging
from robolink.experimental import AsyncNode
from robolink.host import Host, HostError
from tests.support.hosts import Stage
from tests.support.loops import run
from tests.support.misused import ASYNCHRONOUS, HEAD, TAIL

pytestmark = [
    pytest.mark.timeout(60),
    pytest.mark.filterwarnings("ignore::RuntimeWarning"),  # coroutines that are never awaited
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


@pytest.fixture(autouse=True)
def _quiet(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    logging.set_console_handler(None)
    python_logging.getLogger("asyncio").setLevel(python_logging.CRITICAL)
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://misused")
    yield
    gc.collect()  # what was never awaited is reported here, where it is ignored, and not in a later test


@pytest.fixture
def stage(tmp_path: Path) -> Iterator[Stage]:
    with Host() as host:
        yield Stage(tmp_path, host)


@pytest.fixture
def log() -> Iterator[list[str]]:
    lines: list[str] = []

    def note(record: logging.Record) -> None:
        lines.append(record.message)

    logging.add_handler(note)
    yield lines
    logging.remove_handler(note)


def words(error: BaseException | None) -> str:
    """Return the kind and the text of an exception, and of the only one in a group."""
    if error is None:
        return ""
    inner = getattr(error, "exceptions", ())
    text = ": ".join([type(error).__name__, str(error), *map(words, inner)])
    return re.sub(r"0x[0-9a-f]+|<(Hosted)?Task pending name='Task-\d+'", "...", text)


def in_real_time(text: str) -> str:
    try:
        exec(compile(text, "program.py", "exec"), {"__name__": "__main__"})
    except BaseException as error:
        return words(error)
    return ""


def in_virtual_time(text: str, folder: Path) -> str:
    with Host() as host:
        program = Stage(folder, host).start("program", text)
        host.scheduler.patience = 10.0
        assert host.run_until(lambda: program.is_over, 100.0)
        return words(program.error)


@pytest.mark.parametrize("name", ASYNCHRONOUS)
def test_a_misuse_ends_in_one_way_in_real_and_in_virtual_time(tmp_path: Path, name: str) -> None:
    program, end = ASYNCHRONOUS[name]
    text = f"{HEAD}{program}{TAIL}"
    real, virtual = in_real_time(text), in_virtual_time(text, tmp_path)
    assert re.match(end or "$", real), real
    assert virtual == real


def test_code_that_lets_nobody_go_on_is_named_in_virtual_time(stage: Stage) -> None:
    stage.host.scheduler.patience = 0.3
    endless = "async def main():\n    async with AsyncNode('a'):\n        while True:\n            pass"
    with pytest.raises(HostError, match=r"program has kept all others waiting for 0\.3 s of real time: .*program\.py:"):
        stage.start("program", f"{HEAD}{endless}{TAIL}")
    assert stage.host.program("program").state == "crashed"


def test_a_callback_that_goes_on_after_its_cancellation_is_named(
    context: Context, log: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robolink.experimental.pump.STAYS", 0.01)

    async def stays() -> None:
        for _ in range(2):
            with contextlib.suppress(asyncio.CancelledError):
                await asyncio.sleep(0.1)

    async def main() -> None:
        async with AsyncNode("node", context=context) as node:
            node.create_timer(0.001, stays)
            await asyncio.sleep(0.01)

    run(main())
    assert [line for line in log if "stays (test_async_misuse.py:" in line and "is still running" in line]
