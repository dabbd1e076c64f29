"""Commands beside a camera over 2 Mbit/s: with the documented limits, none is lost."""

from __future__ import annotations

import pytest

from tests.support import slow_link

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(slow_link.missing()), reason=slow_link.missing() or "there is a slow link"),
]


def test_the_camera_is_thinned_and_no_command_is_lost() -> None:
    """How late they are is measured by `python -m tests.support.slow_link`: a busy machine is late by itself."""
    found = slow_link.measure(slow_link.LIMITS, 3.0, patience=60.0)
    commands, images = found["/cmd_vel"], found["/camera/image"]
    assert commands.received == commands.sent == 60
    assert 1 <= images.received < images.sent / 2
