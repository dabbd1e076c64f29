"""A plain node in a program on asyncio, as the page has it: in a web server, and where a loop runs already."""

from __future__ import annotations

import json
import threading
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import logging
from robolink.host import Host
from robolink.launch.shared_process import Member
from tests.support.ports import free_port
from tests.support.started import PATIENCE, posix_only, started, wait_for
from tools.docs_site.markdown import blocks

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "asyncio.md"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the page's programs."""
    for block in blocks(PAGE.read_text(encoding="utf-8")):
        if block.title in ("beside.py", "server.py"):
            (tmp_path / block.title).write_text(block.text)
    return tmp_path


@pytest.fixture
def host() -> Iterator[Host]:
    logging.set_console_handler(None)
    with Host() as made:
        yield made


def ask(port: int, path: str, body: str | None = None) -> object:
    data = None if body is None else body.encode()
    with urllib.request.urlopen(f"http://localhost:{port}/{path}", data, timeout=PATIENCE) as answer:
        return json.load(answer)


def converse(port: int) -> None:
    assert ask(port, "add?a=3&b=4") == {"sum": 7}
    assert ask(port, "news", "it rains") == {"heard": "it rains"}


@pytest.mark.processes
@posix_only
def test_a_web_server_has_a_plain_node(folder: Path) -> None:
    pytest.importorskip("aiohttp")
    port = free_port()
    with started("run", str(folder / "server.py"), str(port)) as process:
        assert wait_for(process, "=====")
        converse(port)
        process.terminate()
        process.communicate(timeout=PATIENCE)
        assert process.returncode == 0


def test_a_web_server_and_its_plain_node_live_in_virtual_time(folder: Path, host: Host) -> None:
    pytest.importorskip("aiohttp")
    port = free_port()
    program = host.start("server", [Member("server", str(folder / "server.py"), [str(port)])])
    host.run(1.0)
    failures: list[BaseException] = []

    def visit() -> None:
        try:
            converse(port)
        except BaseException as error:
            failures.append(error)

    visitor = threading.Thread(target=visit)
    visitor.start()
    while visitor.is_alive():
        host.run(0.1)
    host.run(3600.0)
    host.stop("server")
    assert (failures, program.error, program.returncode) == ([], None, 0)


def test_the_pages_program_runs_in_virtual_time(folder: Path, host: Host, capsys: pytest.CaptureFixture[str]) -> None:
    program = host.start("beside", [Member("beside", str(folder / "beside.py"), [])])
    assert host.run_until(lambda: program.is_over, 5.0)
    assert (program.error, program.returncode) == (None, 0)
    assert capsys.readouterr().out == "the sum is 3\nheard that it rains\n"


NOTEBOOK = """
import asyncio, sys
import rclpy
sys.path.insert(0, {folder!r})
from beside import AddTwoInts, Beside, String, spinning

async def first():
    global node, spin
    rclpy.init()
    node = Beside(asyncio.get_running_loop())
    spin = spinning(node)
    spin.__enter__()

async def second():
    print((await node.adder.call_async(AddTwoInts.Request(a=1, b=1))).sum)

async def third():
    node.news.publish(String(data="it is dry"))
    print(await node.heard.get())

async def last():
    spin.__exit__(None, None, None)
    rclpy.shutdown()

loop = asyncio.new_event_loop()
for cell in (first, second, third, last):
    loop.run_until_complete(cell())
loop.close()
"""


@pytest.mark.processes
def test_cells_of_a_notebook_share_a_node_on_their_running_loop(folder: Path) -> None:
    (folder / "cells.py").write_text(NOTEBOOK.format(folder=str(folder)))
    with started("run", str(folder / "cells.py")) as process:
        assert process.communicate(timeout=PATIENCE) == ("2\nit is dry\n", "")
