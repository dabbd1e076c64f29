"""Fixtures for tests of `robolink.testing`: a system in virtual time, and a project that uses the plugin for pytest."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from robolink import logging
from robolink.testing import System
from tests.support.plugged import NODE

assert np  # imported here: a pytest within the test forgets what it has imported, and numpy can be imported only once


@pytest.fixture
def tested() -> Iterator[System]:
    logging.set_console_handler(None)
    with System(seed=7) as made:
        yield made


@pytest.fixture
def project(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    """A project of somebody's own, with a node."""
    monkeypatch.delenv("PYTHONHASHSEED", raising=False)
    pytester.makepyfile(counter=NODE)
    pytester.syspathinsert()
    return pytester
