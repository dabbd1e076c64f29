"""A router with keys: clients meet through it over TLS, and it passes on what each enclave may send."""

from __future__ import annotations

import queue
from pathlib import Path

import pytest

from robolink.exceptions import SecurityError
from robolink.qos import QoSProfile
from robolink.security.keystore import Keystore
from robolink.security.policy import Rule
from robolink.transport import connect, router
from robolink.transport.secured import SecuredTransport
from robolink.wire import DataKey, format_key
from tests.support.ports import free_port
from tests.support.waits import wait_until

pytest.importorskip("cryptography", reason="needs the extra `security`")

LONG = 60.0
QOS = QoSProfile(depth=10)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Keystore:
    store = Keystore(tmp_path / "keys")
    store.create()
    for name in ("/robot", "/student"):
        store.create_enclave(name)
    store.permit("/student", [Rule("publish", True, "/student/*")])
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Enforce")
    monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(store.path))
    return store


def key(name: str) -> str:
    return format_key(DataKey(0, name, "std_msgs/msg/String", "RIHS01_" + "0" * 64))


def test_a_router_passes_on_what_an_enclave_may_send(store: Keystore) -> None:
    store.create_enclave("/router")
    port = free_port()
    with router.running([f"tcp/127.0.0.1:{port}"], ["tcp/127.0.0.1:1"]) as running:
        assert (running.listens, running.connects) == ((f"tls/127.0.0.1:{port}",), ("tls/127.0.0.1:1",))
        assert running.enclave == "/router"
        place = f"tls/127.0.0.1:{port}"
        robot = connect("zenoh://", 0, network=place, enclave="/robot")
        student = connect("zenoh://", 0, network=place, enclave="/student")
        heard: queue.SimpleQueue[object] = queue.SimpleQueue()
        for name in ("/cmd_vel", "/student/pose"):
            robot.subscribe(key(name), QOS, heard.put)
        assert isinstance(student, SecuredTransport)
        refused = student.plain.advertise(key("/cmd_vel"), QOS)  # by a program that asks nobody
        allowed = student.advertise(key("/student/pose"), QOS)
        found: list[bytes] = []
        for _ in range(int(LONG / 0.1)):
            refused.put(b"refused", b"")
            allowed.put(b"allowed", b"")
            try:
                found.append(robot.read(heard.get(timeout=0.1)).payload)
                break
            except queue.Empty:
                continue
        assert found == [b"allowed"]
        student.close()
        robot.close()


def test_a_router_without_keys_does_not_start(store: Keystore) -> None:
    with pytest.raises(SecurityError, match="enclave '/router' has no keys"), router.running(["tcp/127.0.0.1:1"], []):
        pass


def test_a_router_that_is_permissive_says_that_it_is_open(
    store: Keystore, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Permissive")
    with router.running([f"tcp/127.0.0.1:{free_port()}"], []) as running:
        assert running.enclave == ""
        assert running.listens[0].startswith("tcp/")
    said = capsys.readouterr().err
    assert "enclave '/router' has no keys" in said
    assert "this router is open to everybody" in said
    assert said.count("\n") == 1


@pytest.mark.slow
def test_a_router_follows_its_permissions(store: Keystore, capsys: pytest.CaptureFixture[str]) -> None:
    store.create_enclave("/router")
    port = free_port()
    with router.running([f"tcp/127.0.0.1:{port}"], []) as running:
        place = f"tls/127.0.0.1:{port}"
        robot, student = (connect("zenoh://", 0, network=place, enclave=each) for each in ("/robot", "/student"))
        try:
            heard: queue.SimpleQueue[object] = queue.SimpleQueue()
            robot.subscribe(key("/cmd_vel"), QOS, heard.put)
            assert isinstance(student, SecuredTransport)
            outlet = student.plain.advertise(key("/cmd_vel"), QOS)
            store.permit("/student", [Rule("publish", True, "/cmd_vel")])

            def is_heard() -> bool:
                running.follow()
                outlet.put(b"its turn", b"")
                return not heard.empty()

            wait_until(is_heard, LONG)
        finally:
            student.close()
            robot.close()
    assert "enclave '/router': permissions or keys have changed, and count from now on" in capsys.readouterr().err


def test_a_router_whose_new_files_are_broken_goes_on_as_it_was(
    store: Keystore, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = store.create_enclave("/router")
    with router.running([f"tcp/127.0.0.1:{free_port()}"], []) as running:
        (folder / "permissions.xml").write_text("no permissions")
        for _ in range(3):
            running.follow()
        assert running.links() == []
    said = capsys.readouterr().err
    assert "permissions or keys have changed, and do not count yet: enclave '/router': " in said
    assert said.count("\n") == 1
