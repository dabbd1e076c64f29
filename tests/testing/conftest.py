"""A system under test, in virtual time."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from robolink import logging
from robolink.testing import System


@pytest.fixture
def tested() -> Iterator[System]:
    logging.set_console_handler(None)
    with System(seed=7) as made:
        yield made
