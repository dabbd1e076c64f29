"""When a host ends, nothing of it goes on, and the process is as it was before."""

from __future__ import annotations

import logging as python_logging
import os
import random
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robolink import logging
from robolink.exceptions import InvalidHandle
from robolink.host import Host, HostError
from robolink.launch.shared_process import Member
from robolink.workspace.interfaces import WORKSPACE_TYPES
from tests.support.hosts import Counter


def test_the_end_destroys_all_and_gives_back_what_was_the_hosts() -> None:
    before = random.getstate()
    with Host(seed=4) as host:
        drawn = random.random()
        counter = host.start_node(Counter)
        host.run(1.0)
    assert random.getstate() == before
    assert not counter.context.ok()
    with pytest.raises(InvalidHandle):
        counter.create_timer(1.0, lambda: None)
    with Host(seed=4):
        assert random.random() == drawn


CARELESS = """
import logging, os, sys
from robolink import Node

class Careless(Node):
    def __init__(self):
        super().__init__("careless")
        os.chdir(os.sep)
        os.environ.update(CARELESS="1", CHANGED="by it")
        os.environ.pop("TAKEN")
        sys.stdout = sys.stderr = None
        sys.path.insert(0, "careless")
        logging.disable(logging.ERROR)
        logging.getLogger("careless").setLevel(logging.ERROR)
        logging.getLogger().setLevel(logging.DEBUG)
"""


def test_what_nodes_change_of_the_process_ends_with_the_host(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CHANGED", "as it was")
    monkeypatch.setenv("TAKEN", "not yet")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "careless.py").write_text(CARELESS)

    def seen() -> list[Any]:
        levels = [python_logging.getLogger(name).level for name in ("", "careless")]
        streams = sys.stdout, sys.stderr
        return [Path.cwd(), dict(os.environ), streams, [*sys.path], python_logging.root.manager.disable, levels]

    before = seen()
    with Host() as host:
        program = host.start("careless", [Member("careless", str(tmp_path / "careless.py"), [])])
        assert host.run_until(lambda: program.has_begun, 10.0)
        assert program.error is None
        assert all(one != other for one, other in zip(before, seen(), strict=True))
    assert seen() == before


def test_types_of_a_workspace_that_a_host_has_used_are_forgotten(tmp_path: Path) -> None:
    package = tmp_path / "interfaces" / "robolink_interfaces" / "srv"
    package.mkdir(parents=True)
    (package / "Spawn.srv").write_text("string who\n---\nbool ok\n")
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "idle.py").write_text("from robolink import Node\n\nclass Idle(Node):\n    pass\n")
    before = WORKSPACE_TYPES.get("robolink_interfaces", "srv", "Spawn")
    with Host() as host:
        host.start("idle", [Member("idle", str(tmp_path / "nodes" / "idle.py"), [])])
        assert WORKSPACE_TYPES.get("robolink_interfaces", "srv", "Spawn") is not before
    assert WORKSPACE_TYPES.get("robolink_interfaces", "srv", "Spawn") is before


def test_nothing_runs_in_a_host_that_is_closed() -> None:
    logging.set_console_handler(None)
    with Host() as host:
        host.start_node(Counter, name="one")
    asked: list[Callable[[], object]] = [
        lambda: host.start_node(Counter),
        lambda: host.restart("one"),
        lambda: host.run(1.0),
        lambda: host.run_until(lambda: True, 1.0),
    ]
    for ask in asked:
        with pytest.raises(HostError, match="this host is closed"):
            ask()
    host.close()
