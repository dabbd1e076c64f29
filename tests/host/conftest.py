"""A host in virtual time, a folder of programs for it, and what is logged meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import logging
from robolink.host import Host
from tests.support.hosts import Stage


@pytest.fixture
def host() -> Iterator[Host]:
    logging.set_console_handler(None)
    with Host() as made:
        yield made


@pytest.fixture
def stage(tmp_path: Path, host: Host) -> Stage:
    return Stage(tmp_path, host)


@pytest.fixture
def log() -> Iterator[list[str]]:
    lines: list[str] = []

    def note(record: logging.Record) -> None:
        lines.append(record.message)

    logging.add_handler(note)
    yield lines
    logging.remove_handler(note)
