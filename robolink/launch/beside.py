"""Companions of a launched system: recorder, view and file watch, and the keys that these need."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.exceptions import SecurityError
from robolink.extensions import optional
from robolink.launch.entry import Entry
from robolink.launch.planning import Launched
from robolink.launch.readiness import Awaited
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.policy import Rules
from robolink.system.processes import own_command
from robolink.workspace.packages import import_roots, source_packages

if TYPE_CHECKING:
    from robolink.supervisor.monitoring.file_watch import Watch

RECORDER = "bag-record"
"""Name of the recorder's process, which no node can have."""

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
    from robolink.bag.topic import BagError

    folder = Path(path)
    if path and folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise BagError(f"record: '{path}' exists already: choose another folder for the bag, or delete it")
    where = ["-o", path] if path else []
    keys = ["--enclave", enclave] if enclave else []
    words = [*own_command(), "bag", "record", "-a", *where, "--disable-keyboard-controls", *keys]
    return Process(RECORDER, words, rules=Rules(on_exit="ignore"))


def behind(processes: Iterable[Process]) -> list[Process]:
    """Return processes that start when the recorder listens, so that the bag has their first messages too."""
    return [
        replace(each, rules=replace(each.rules, held=True, awaits=each.rules.awaits | {RECORDER})) for each in processes
    ]


def view(taken: set[str], enclave: str) -> Process:
    """Return the process of the view: a part of the system that may fail without the others.

    Raises:
        MissingPartError: (an ImportError) If this installation lacks it.
    """
    optional.check(optional.PAGE, "--view ('robolink view')")
    names = itertools.chain(["view"], (f"view-{number}" for number in itertools.count(2)))
    name = next(each for each in names if each not in taken)
    keys = ["--enclave", enclave] if enclave else []
    return Process(name, [*own_command(), "view", *keys], rules=Rules(on_exit="ignore"))


# Keys


def check_keys(enclave: str, started: Mapping[str, bool]) -> None:
    """Raise SecurityError, once for all that is started beside the nodes, if it cannot have keys that it must have.

    Args:
        enclave: Its enclave; '' is `/`.
        started: Whether each part of the system is started: by its name for people, such as `recorder`.
    """
    from robolink.networks.request import domain_id
    from robolink.security import session  # few systems have keys

    names = [name for name, is_started in started.items() if is_started]
    try:
        if names:
            session.requested(os.environ, domain_id(os.environ), enclave or None)
    except SecurityError as error:
        raise SecurityError(f"--enclave NAME gives the {' and the '.join(names)} keys: {error}") from None


def unprotected(entries: Sequence[Entry], environ: Mapping[str, str]) -> Iterator[str]:
    """Yield a line for the nodes and commands whose `env` switches security off, or lets them do without keys.

    Nothing is said where security is on neither in the environment nor for any of them.

    Args:
        entries: Nodes and commands of a system.
        environ: Environment of the launcher.
    """
    if not any(name.startswith("ROS_SECURITY_") for each in entries for name in each.node.env):
        return
    from robolink.security import session

    for variable, strong, weak, what in (
        (session.ENABLE, "true", "false", "is off for {}"),
        (session.STRATEGY, "enforce", "permissive", "does not insist on keys for {}"),
    ):
        values = [each.node.env.get(variable) for each in entries]
        if strong not in {(value or "").strip().lower() for value in (environ.get(variable), *values)}:
            continue
        # '' is what is usual, and that is the weak one.
        concerned = [
            each.name
            for each, value in zip(entries, values, strict=True)
            if value is not None and (value.strip().lower() or weak) == weak
        ]
        if concerned:
            names = ", ".join(concerned[:3]) + (f" and {len(concerned) - 3} more" if concerned[3:] else "")
            yield f"security {what.format(names)}: the launch file's `env` sets {variable}"


# Files that are watched


def watch(launched: Sequence[Launched], path: Path, supervisor: Supervisor) -> Watch:
    """Return a file watcher that restarts processes when the files of their nodes are saved."""
    from robolink.supervisor.monitoring.file_watch import Watch

    roots, settings = roots_of(launched), [path.resolve(), *settings_of(launched)]
    return Watch(files_of(launched), roots=roots, settings=settings, restart=supervisor.restart, say=supervisor.say)


def files_of(launched: Iterable[Launched]) -> dict[str, list[Path]]:
    """Return the Python files of each process: of its nodes, or those that its command names.

    Nodes of an installed package have none.
    """
    return {each.name: [*_of_nodes(each.entries), *_of_command(each.command)] for each in launched}


def roots_of(launched: Iterable[Launched]) -> list[Path]:
    """Return the folders, besides a file's own, from which nodes import the user's code: those of packages."""
    entries = [entry for each in launched for entry in each.entries]
    roots = [entry.source.root for entry in entries if entry.source is not None and entry.source.root is not None]
    for home in dict.fromkeys(entry.home for entry in entries if entry.home is not None):
        roots += [root for package in source_packages(home).values() for root in import_roots(package)]
    return list(dict.fromkeys(roots))


def settings_of(launched: Iterable[Launched]) -> set[Path]:
    """Return the launch files and parameter files, which are read once, before anything is started."""
    return {file.resolve() for each in launched for entry in each.entries for file in entry.files}


def _of_nodes(entries: Sequence[Entry]) -> list[Path]:
    return [each.source.path for each in entries if each.source is not None]


def _of_command(command: Sequence[str]) -> list[Path]:
    return [Path(word).resolve() for word in command if word.endswith(".py") and Path(word).is_file()]
