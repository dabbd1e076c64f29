"""Requests that no client would send: each is answered soon, and takes little memory."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from tests.support.hostile_requests import requests

pytestmark = pytest.mark.processes

WITHIN = 2.0
"""Seconds of the processor. By the clock a machine that runs three tests at once may take several times as long."""

AT_MOST = 10.0
"""Seconds by the clock, however busy the machine is."""

MOST = 300.0
"""MB of the whole process, the request's own bytes included."""


def test_each_is_answered_in_two_seconds_with_less_than_300_mb() -> None:
    command = [sys.executable, "-m", "tests.support.hostile_requests"]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert ran.returncode == 0, ran.stderr[-2000:]
    told = [json.loads(line) for line in ran.stdout.splitlines()]
    assert len(told) == len(list(requests()))
    assert [each for each in told if each["cpu"] >= WITHIN or each["seconds"] >= AT_MOST] == []
    assert [each for each in told if each["peak"] >= MOST][:1] == []
