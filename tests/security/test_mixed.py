"""A session with security and one without: whoever comes second is told what the other one wants."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.exceptions import SecurityError, TransportError
from robolink.networks.refusals import of_holder, wants_keys
from robolink.networks.request import FIRST_PORT
from robolink.security.keystore import Keystore
from robolink.transport import connect
from tests.support.domains import free_domain
from tests.support.ports import free_port, stranger

pytest.importorskip("cryptography", reason="needs the extra `security`")


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Keystore]:
    for name in [each for each in os.environ if each.startswith("ROS_")]:
        monkeypatch.delenv(name)
    with free_domain() as domain:
        store = Keystore(tmp_path / "keys", domain)
        store.create()
        store.create_enclave("/robot")
        monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(store.path))
        yield store


@pytest.mark.slow
def test_without_keys_beside_one_that_has_some(store: Keystore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    holder = connect("zenoh://", store.domain, enclave="/robot")
    monkeypatch.delenv("ROS_SECURITY_ENABLE")
    port = FIRST_PORT + store.domain
    with pytest.raises(TransportError) as caught:
        connect("zenoh://", store.domain)
    assert str(caught.value) == (
        f"port {port} is taken by a process with security, which lets nobody in without keys: set "
        "ROS_SECURITY_ENABLE=true and ROS_SECURITY_KEYSTORE here, as they are set there (docs/why/security.md)"
    )
    with pytest.raises(TransportError) as caught:
        connect("zenoh://", store.domain, network="127.0.0.1")
    assert f"at 127.0.0.1, port {port}, is a process which lets nobody in without keys" in str(caught.value)
    holder.close()


@pytest.mark.slow
def test_with_keys_beside_one_that_has_none(store: Keystore, monkeypatch: pytest.MonkeyPatch) -> None:
    holder = connect("zenoh://", store.domain)
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    with pytest.raises(SecurityError) as caught:
        connect("zenoh://", store.domain, enclave="/robot")
    port = FIRST_PORT + store.domain
    assert str(caught.value) == (
        f"port {port} is taken by a process which has no keys, while ROS_SECURITY_ENABLE is "
        "true here: end it and start it again with security, or choose another ROS_DOMAIN_ID"
    )
    holder.close()


@pytest.mark.slow
@pytest.mark.parametrize("secured", [True, False])
def test_a_stranger_is_neither(secured: bool) -> None:
    with stranger() as port:
        assert "does not answer as a robolink session does" in of_holder(port, secured=secured)


def test_nobody_wants_no_keys() -> None:
    assert not wants_keys("127.0.0.1", free_port())
