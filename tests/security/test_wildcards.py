"""Wildcard keys and endpoint settings that get past Zenoh's own rules: robolink's sessions refuse them."""

from __future__ import annotations

import json
import queue
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import zenoh

from robolink.exceptions import SecurityError
from robolink.networks.request import FIRST_PORT
from robolink.qos import QoSProfile
from robolink.security import session
from robolink.security.keystore import Keystore
from robolink.security.policy import Rule
from robolink.transport import Transport, connect
from robolink.wire import DataKey, format_key
from tests.support.domains import free_domain
from tests.support.waits import wait_until

pytest.importorskip("cryptography", reason="needs the extra `security`")

LONG = 60.0
QOS = QoSProfile(depth=10)
RULES = [
    *(Rule(kind, True, "/own/*") for kind in ("publish", "request")),
    *(Rule(kind, False, "/own/denied") for kind in ("publish", "request")),
]


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Keystore]:
    with free_domain() as domain:
        made = Keystore(tmp_path / "keys", domain)
        made.create()
        for name in ("/robot", "/student"):
            made.create_enclave(name)
        made.permit("/student", RULES)
        monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
        monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(made.path))
        yield made


@pytest.fixture
def robot(store: Keystore) -> Iterator[Transport]:
    made = connect("zenoh://", store.domain, enclave="/robot")
    yield made
    made.close()


@pytest.fixture
def attacker(store: Keystore, robot: Transport) -> Iterator[Any]:
    """A session with the student's key that looks at no rule."""
    environ = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_KEYSTORE": str(store.path)}
    own = session.requested(environ, store.domain, "/student")
    assert own is not None
    config = zenoh.Config()
    place = f"tls/127.0.0.1:{FIRST_PORT + store.domain}"
    plain = {"access_control": {"enabled": False}, "mode": "client", "connect/endpoints": [place]}
    for path, value in {**session.settings(own), **plain, "scouting/multicast/enabled": False}.items():
        config.insert_json5(path, json.dumps(value))
    made: Any = zenoh.open(config)
    yield made
    made.close()


def key(name: str, domain: int) -> str:
    return format_key(DataKey(domain, name, "std_msgs/msg/String", "RIHS01_" + "0" * 64))


def test_a_message_to_a_wildcard_does_not_reach_a_topic_that_is_denied(
    store: Keystore, robot: Transport, attacker: Any
) -> None:
    heard: queue.SimpleQueue[Any] = queue.SimpleQueue()
    for name in ("/own/denied", "/own/allowed"):
        robot.subscribe(key(name, store.domain), QOS, heard.put)
    publisher = attacker.declare_publisher(key("/own/allowed", store.domain))
    wait_until(lambda: publisher.matching_status.matching, LONG)
    for wild in ("own/*/*/*/**", "own/*/*/*", "own/denied/*/*"):
        attacker.put(f"{store.domain}/{wild}", b"attack")
    publisher.put(b"allowed")
    assert robot.read(heard.get(timeout=LONG)).payload == b"allowed"


def test_a_call_of_a_wildcard_does_not_reach_a_service_that_is_denied(
    store: Keystore, robot: Transport, attacker: Any
) -> None:
    asked: queue.SimpleQueue[Any] = queue.SimpleQueue()
    for name in ("/own/denied", "/own/allowed"):
        robot.serve(key(name, store.domain), asked.put)
    querier = attacker.declare_querier(key("/own/allowed", store.domain), target=zenoh.QueryTarget.ALL, timeout=LONG)
    wait_until(lambda: querier.matching_status.matching, LONG)
    for wild in ("own/*/*/*/**", "own/*/*/*"):
        attacker.get(f"{store.domain}/{wild}", payload=b"attack", target=zenoh.QueryTarget.ALL, timeout=LONG)
    replies = querier.get(payload=b"allowed")
    query = robot.accept(asked.get(timeout=LONG))
    assert query.payload == b"allowed"
    query.close()
    del replies


@pytest.mark.parametrize("setting", ["enable_mtls=false", "root_ca_certificate_base64=QQ==", "iface=lo;enable_mtls=0"])
@pytest.mark.parametrize("path", ["listen/endpoints", "connect/endpoints"])
def test_an_endpoint_has_no_settings_that_open_what_security_closes(store: Keystore, path: str, setting: str) -> None:
    config = zenoh.Config()
    config.insert_json5(path, json.dumps([f"tls/127.0.0.1:0#{setting}"]))
    environ = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_KEYSTORE": str(store.path)}
    own = session.requested(environ, store.domain, "/robot")
    assert own is not None
    with pytest.raises(SecurityError, match=r"has a setting of its own, '(enable_mtls|root_ca_certificate_base64)'"):
        session.secure(config, own)
