"""Virtual time patches Python's names while there is a host: exactly those of its page, and restores every one."""

from __future__ import annotations

import _queue
import _thread
import concurrent.futures.thread
import os
import pkgutil
import queue
import random
import re
import selectors
import signal
import subprocess
import sys
import threading
import time
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robolink import Node, logging
from robolink.host import Host
from robolink.host.patches.install import replacements
from tests.support.hosts import Counter, Stage

PAGE = Path(__file__).parents[2] / "docs" / "development" / "host.md"

OWNERS: dict[str, Any] = {
    **{each: pkgutil.resolve_name(each) for each in sorted({path.rpartition(".")[0] for path in replacements()})},
    "concurrent.futures.thread": concurrent.futures.thread,
    "threading.Event": threading.Event,
    "subprocess": subprocess,
    "selectors": selectors,
    "queue.Queue": queue.Queue,
}
"""Names in Python's modules and classes that virtual time touches, by dotted path."""


def names() -> dict[str, Any]:
    """Return every attribute of every owner, by dotted path."""
    found = {f"{path}.{name}": value for path, owner in OWNERS.items() for name, value in vars(owner).items()}
    streams = {f"sys.{name}": getattr(sys, name) for name in ("argv", "stdin", "stdout", "stderr", "path")}
    return {**found, **streams, "__main__": sys.modules["__main__"], "os.environ": os.environ}


def changed(before: dict[str, Any]) -> set[str]:
    """Return the names that are no longer the same objects, have gone, or have come."""
    now, missing = names(), object()
    return {each for each in before.keys() | now.keys() if before.get(each, missing) is not now.get(each, missing)}


def test_a_host_replaces_exactly_the_names_that_it_lists() -> None:
    before = names()
    with Host():
        assert changed(before) == replacements().keys()
    assert changed(before) == set()


def test_the_page_lists_exactly_the_names_patched() -> None:
    table = PAGE.read_text(encoding="utf-8").partition("## Every patched name")[2].partition("\n## ")[0]
    rows = [re.findall(r"`([\w.]+)`", line.split("|")[1]) for line in table.splitlines() if line.startswith("| `")]
    assert sorted(name for row in rows for name in row) == sorted(replacements())


LIVES: dict[str, str] = {
    "fails at once": "raise ValueError('no')",
    "fails in a thread": "import threading\ndef f():\n    1 / 0\nthreading.Thread(target=f).start()",
    "waits for ever": "import threading\nthreading.Lock().acquire()\nthreading.Event().wait()",
    "sleeps in a pool": (
        "import concurrent.futures, time\npool = concurrent.futures.ThreadPoolExecutor(2)\n"
        "pool.submit(time.sleep, 1e6).result()"
    ),
    "handles signals": "import signal, time\nsignal.signal(signal.SIGINT, print)\ntime.sleep(1e6)",
    "fails in a callback": (
        "import rclpy\nrclpy.init()\nnode = rclpy.create_node('n')\nnode.create_timer(0.1, lambda: 1 / 0)\n"
        "rclpy.spin(node)"
    ),
    "patches names itself": ("import random, time\ntime.sleep = random.seed = print\nraise SystemExit"),
}


@pytest.mark.parametrize("life", LIVES)
def test_every_name_is_restored_however_a_program_ends(tmp_path: Path, life: str) -> None:
    logging.set_console_handler(None)
    before, handler, environment = names(), signal.getsignal(signal.SIGINT), dict(os.environ)
    with Host() as host:
        Stage(tmp_path, host).start("program", LIVES[life], env={"OF_THE_PROGRAM": "1"})
        host.start_node(Counter)
        host.run(1.0)
        assert host.programs["Counter"].error is None
    assert changed(before) == set()
    assert signal.getsignal(signal.SIGINT) is handler
    assert dict(os.environ) == environment


class Unmade(Node):
    def __init__(self) -> None:
        super().__init__("unmade")
        raise ValueError("cannot be made")


def raises_in_start(host: Host) -> None:
    host.start_node(Unmade)


def raises_in_act(host: Host) -> None:
    host.at(0.5, lambda: dict[str, int]()["no"])
    host.run(1.0)


@pytest.mark.parametrize("end", [raises_in_start, raises_in_act])
def test_every_name_is_restored_when_the_test_itself_fails(end: Callable[[Host], None]) -> None:
    logging.set_console_handler(None)
    before = names()
    with pytest.raises((ValueError, KeyError)), Host() as host:
        end(host)
    assert changed(before) == set()


def test_the_last_of_several_hosts_restores_them() -> None:
    before = names()
    first, second = Host(), Host()
    first.close()
    assert changed(before) == replacements().keys()
    second.close()
    assert changed(before) == set()


def test_a_class_of_a_module_with_earlier_imports_gets_virtual_time_and_gives_it_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    module = types.ModuleType("imported_earlier")
    vars(module).update(sleep=time.sleep, Lock=threading.Lock, now=time.time)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    before = dict(vars(module))
    with Host() as host:
        host.start_node(type("Early", (Counter,), {"__module__": module.__name__}))
        assert all(vars(module)[name] is not before[name] for name in ("sleep", "Lock", "now"))
    assert vars(module) == before


def test_code_of_nobodys_program_gets_what_python_gives() -> None:
    real = time.monotonic
    with Host() as host:
        host.run(1e6)
        begin = real()
        assert begin <= time.monotonic() <= real()
        assert type(threading.Lock()) is type(_thread.allocate_lock())
        assert type(queue.SimpleQueue()) is _queue.SimpleQueue
        assert random.Random().random() != random.Random().random()
