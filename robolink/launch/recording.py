"""Recorder of a launched system: a process `robolink bag record -a`, which is there before the others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from robolink.bag.topic import BagError
from robolink.launch.readiness import Awaited
from robolink.supervisor import Process
from robolink.supervisor.rules import Rules
from robolink.system.own_command import own_command

NAME = "bag-record"
"""Name of the process, which no node can have."""

READY = Awaited("service", ("/rosbag2_recorder/is_paused",))
"""Condition under which the others start: the recorder serves this once it listens."""


def recorder(path: str, enclave: str = "") -> Process:
    """Return the process that records all topics, services and actions.

    Args:
        path: Folder of the bag; '' for one with the date in its name.
        enclave: Enclave whose keys and rights it has, where security is on; '' for `/`.

    Raises:
        BagError: (a ValueError) if there is something already.
    """
    folder = Path(path)
    if path and folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise BagError(f"record: '{path}' exists already: choose another folder for the bag, or delete it")
    where = ["-o", path] if path else []
    keys = ["--enclave", enclave] if enclave else []
    words = [*own_command(), "bag", "record", "-a", *where, "--disable-keyboard-controls", *keys]
    return Process(NAME, words, rules=Rules(on_exit="ignore"))


def behind(processes: Iterable[Process]) -> list[Process]:
    """Return processes that start when the recorder listens, so that the bag has their first messages too."""
    return [
        replace(each, rules=replace(each.rules, held=True, awaits=each.rules.awaits | {NAME})) for each in processes
    ]
