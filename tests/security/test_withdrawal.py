"""Withdrawal while all runs: an enclave is out when its permissions have changed, and back when it has them again."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from robolink.qos import QoSProfile
from robolink.security.keystore import EVERYTHING, Keystore
from robolink.security.policy import Rule
from robolink.transport import Transport, connect
from robolink.transport.base import Outlet
from robolink.wire import DataKey, NodeToken, format_key, format_token
from tests.support.domains import free_domain

pytest.importorskip("cryptography", reason="needs the extra `security`")

LONG = 60.0


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Keystore]:
    with free_domain() as domain:
        store = Keystore(tmp_path / "keys", domain)
        store.create()
        for name in ("/robot", "/student"):
            store.create_enclave(name)
        monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
        monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(store.path))
        yield store


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + LONG
    while not condition():
        assert time.monotonic() < deadline, "never came"
        time.sleep(0.05)


def announced(transport: Transport, domain: int) -> str:
    return format_token(NodeToken(domain, transport.session_id, "0", "/student", "/", "me"))


@pytest.mark.slow
def test_who_is_withdrawn_is_out_and_comes_back(store: Keystore) -> None:
    key = format_key(DataKey(store.domain, "/cmd_vel", "std_msgs/msg/String", "RIHS01_" + "0" * 64))
    robot = connect("zenoh://", store.domain, enclave="/robot")
    student = connect("zenoh://", store.domain, enclave="/student")
    heard: list[object] = []
    robot.subscribe(key, QoSProfile(depth=10), heard.append)
    outlet: Outlet = student.advertise(key, QoSProfile(depth=10))
    token = announced(student, store.domain)
    student.announce(token)

    def is_there() -> bool:
        outlet.put(b"go", b"")
        return token in robot.tokens(f"@ros2_lv/{store.domain}/**")

    until(lambda: is_there() and bool(heard))
    store.withdraw("/student")
    until(lambda: not is_there())
    until(lambda: _is_silent(heard, outlet))
    store.permit("/student", [*EVERYTHING, Rule("publish", False, "/other")])
    until(lambda: is_there() and bool(heard))
    student.close()
    robot.close()


def _is_silent(heard: list[object], outlet: Outlet) -> bool:
    heard.clear()
    for _ in range(10):
        outlet.put(b"go", b"")
        time.sleep(0.02)
    return not heard
