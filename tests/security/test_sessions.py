"""Sessions with keys and rights: what the environment asks for, what is refused before it is declared, and why."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import Node
from robolink.cli.doctor.gathering import gather
from robolink.cli.doctor.look import look
from robolink.context import Context
from robolink.exceptions import SecurityError
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.networks.request import FIRST_PORT
from robolink.parameter_client import AsyncParameterClient
from robolink.security import session
from robolink.security.keystore import KEY, Keystore
from robolink.security.policy import Profile, Rule
from robolink.transport import connect, network
from robolink.wire import NodeToken
from tests.support.domains import free_domain
from tests.support.waits import wait_until

pytest.importorskip("cryptography", reason="needs the extra `security`")

RULES = [
    *(Rule("publish", True, name) for name in ("/student/*", "/turn")),
    *(Rule("subscribe", True, name) for name in ("/scan", "/student/*")),
    Rule("request", True, "/robot/get_parameters"),
    Rule("publish", False, "/turn"),
]


@pytest.fixture
def domain() -> Iterator[int]:
    with free_domain() as domain:
        yield domain


@pytest.fixture
def store(tmp_path: Path, domain: int, monkeypatch: pytest.MonkeyPatch) -> Keystore:
    store = Keystore(tmp_path / "keys", domain)
    store.create()
    store.create_enclave("/robot")
    store.create_enclave("/student")
    store.permit_profiles("/student", [Profile("/student", "me", RULES)])
    for name, value in {
        "ROS_SECURITY_ENABLE": "true",
        "ROS_SECURITY_STRATEGY": "Enforce",
        "ROS_SECURITY_KEYSTORE": str(store.path),
        "ROS_DOMAIN_ID": str(store.domain),
    }.items():
        monkeypatch.setenv(name, value)
    return store


@pytest.fixture
def student(store: Keystore) -> Iterator[Node]:
    context = Context()
    context.init(args=["--ros-args", "--enclave", "/student"])
    node = Node("me", namespace="/student", context=context)
    yield node
    context.shutdown()


def test_a_node_has_what_every_node_needs_and_its_rights(student: Node) -> None:
    student.create_publisher(String, "pose", 10)
    student.create_subscription(String, "/scan", print, 10)
    student.create_client(Trigger, "/robot/get_parameters")
    assert student.context.transport.enclave == "/student"


def test_what_is_refused_is_told_with_enclave_name_and_rule(student: Node, store: Keystore) -> None:
    place = store.folder("/student") / "permissions.xml"
    with pytest.raises(SecurityError) as caught:
        student.create_publisher(String, "/cmd_vel", 10)
    assert str(caught.value) == (
        f"enclave '/student' may not publish /cmd_vel: no rule allows it in domain {store.domain} ({place})"
    )
    with pytest.raises(PermissionError, match=r"may not publish /turn: '/turn' is denied \(.*permissions\.xml:\d+\)"):
        student.create_publisher(String, "/turn", 10)
    with pytest.raises(SecurityError, match="may not subscribe to /map"):
        student.create_subscription(String, "/map", print, 10)
    with pytest.raises(SecurityError, match="may not serve /reset"):
        student.create_service(Trigger, "/reset", lambda request, response: response)
    with pytest.raises(SecurityError, match="may not call /reset"):
        student.create_client(Trigger, "/reset")
    with pytest.raises(SecurityError, match="may not call /robot/list_parameters"):
        AsyncParameterClient(student, "/robot")
    student.create_publisher(String, "pose", 10)  # what was good goes on


def test_keys_of_another_domain_are_told(store: Keystore) -> None:
    """`create_enclave` in a shell without ROS_DOMAIN_ID makes permissions for domain 0, as SROS2's does."""
    other = (store.domain + 1) % 200
    context = Context()
    context.init(args=["--ros-args", "--enclave", "/robot"], domain_id=other)
    with context, pytest.raises(SecurityError) as caught:
        Node("me", context=context)
    told = f"in domain {other}, its permissions were made for domain {store.domain}: go there, or make them anew with"
    assert f"{told} ROS_DOMAIN_ID={other} (" in str(caught.value)


def test_nothing_is_in_the_clear(store: Keystore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", "access_control/enabled=false;transport/shared_memory/enabled=true")
    environ = os.environ | {"ROS_SECURITY_ENCLAVE_OVERRIDE": "/student"}
    config = network.load("subnet", store.domain, environ)
    for path in ("listen/endpoints", "connect/endpoints"):
        assert "tcp/" not in config.get_json(path)
    assert config.get_json("transport/link/protocols") == '["tls"]'
    assert config.get_json("transport/shared_memory/enabled") == "false"
    assert '"enabled":true' in config.get_json("access_control")
    with pytest.raises(SecurityError, match="quic/h:1 is not secured"):
        network.load(None, store.domain, environ | {"ZENOH_CONFIG_OVERRIDE": 'connect/endpoints=["quic/h:1"]'})


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"ROS_SECURITY_ENABLE": "yes"}, "ROS_SECURITY_ENABLE is true or false, got 'yes'"),
        ({"ROS_SECURITY_STRATEGY": "Enforced"}, "ROS_SECURITY_STRATEGY is enforce or permissive, got 'Enforced'"),
        ({"ROS_SECURITY_KEYSTORE": ""}, "ROS_SECURITY_KEYSTORE names no keystore"),
        (
            {"ROS_SECURITY_ENCLAVE_OVERRIDE": "/studnt"},
            "enclave '/studnt' has no keys in {} (did you mean '/student'?)",
        ),
        ({"ROS_SECURITY_ENCLAVE_OVERRIDE": "../x"}, "'../x' is not a valid enclave name"),
    ],
)
def test_without_what_was_asked_for_there_is_no_session(
    store: Keystore, changed: dict[str, str], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in changed.items():
        monkeypatch.setenv(name, value)
    with pytest.raises(SecurityError) as caught:
        connect("zenoh://", store.domain, enclave="/student")
    assert told.format(store.path) in str(caught.value)


def damage(store: Keystore, how: str) -> str:
    """Damage the files of /student; return what is to be told of it."""
    folder = store.folder("/student")
    if how == "withdrawn":
        store.withdraw("/student")
        return "enclave '/student' has been withdrawn"
    if how == "ended":
        store.create_enclave("/student", renew=True, days=-1)
        return "cert.pem has expired"
    if how == "another key":
        (folder / "key.pem").write_bytes((store.folder("/robot") / "key.pem").read_bytes())
        return "is not the key of"
    if how == "another authority":
        other = Keystore(store.path.parent / "other")
        other.create()
        made = other.create_enclave("/student")
        for name in ("key.pem", "cert.pem"):
            (folder / name).write_bytes((made / name).read_bytes())
        return "is not signed by root_ca_certificate"
    if how == "exposed":
        (folder / "key.pem").chmod(0o644)
        return "may be read or changed by others (mode 0644): chmod 600"
    name = "key.pem" if how == "nonsense" else "permissions.xml"
    (folder / name).write_text("nonsense", encoding="utf-8")
    return "holds no private key" if how == "nonsense" else "no XML: "


DAMAGES = ["withdrawn", "ended", "another key", "another authority", "exposed", "nonsense", "broken permissions"]


@pytest.mark.parametrize("how", DAMAGES)
def test_files_that_are_wrong_are_one_line(store: Keystore, how: str) -> None:
    if how == "exposed" and sys.platform == "win32":
        pytest.skip("Windows has no modes")
    told = damage(store, how)
    with pytest.raises(SecurityError) as caught:
        connect("zenoh://", store.domain, enclave="/student")
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


def test_permissive_without_keys_is_open_and_says_so(
    store: Keystore, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Permissive")
    transport = connect("zenoh://", store.domain, enclave="/nobody")
    transport.close()
    assert transport.enclave == ""
    assert "enclave '/nobody' has no keys" in capfd.readouterr().err


@pytest.mark.parametrize("word", ["FALSE", "false", ""])
def test_security_that_is_off_is_off_without_a_word(
    store: Keystore, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], word: str
) -> None:
    monkeypatch.setenv("ROS_SECURITY_ENABLE", word)
    transport = connect("zenoh://", store.domain)
    transport.close()
    assert transport.enclave == ""
    assert capfd.readouterr().err == ""


def test_a_mistake_of_another_enclave_takes_its_rights_alone(store: Keystore) -> None:
    (store.folder("/robot") / "permissions.xml").write_text("<dds", encoding="utf-8")
    security = session.requested(os.environ, store.domain, "/student")
    assert security is not None
    assert len(security.warnings) == 1
    assert {each["id"] for each in session.settings(security)["access_control"]["subjects"]} == {"/student"}


TALKER = """
import robolink
from robolink import Node
from robolink.cli.doctor.gathering import gather
from robolink.cli.doctor.look import look
from robolink.interfaces.std_msgs.msg import String

robolink.init()
node = Node("robot")
publisher = node.create_publisher(String, "/scan", 10)
node.create_subscription(String, "/student/pose", lambda pose: publisher.publish(pose), 10)
robolink.spin(node)
"""


@pytest.mark.processes
def test_two_processes_meet_over_tls(student: Node, tmp_path: Path) -> None:
    (tmp_path / "talker.py").write_text(TALKER, encoding="utf-8")
    command = [sys.executable, str(tmp_path / "talker.py"), "--ros-args", "--enclave", "/robot"]
    heard: list[str] = []
    student.create_subscription(String, "/scan", lambda scan: heard.append(scan.data), 10)
    publisher = student.create_publisher(String, "pose", 10)
    talker = subprocess.Popen(command)
    try:
        from robolink.executors import SingleThreadedExecutor

        executor = SingleThreadedExecutor(context=student.context)
        executor.add_node(student)
        deadline = time.monotonic() + 60
        while not heard and time.monotonic() < deadline:
            publisher.publish(String(data="there and back"))
            executor.spin_once(timeout_sec=0.05)
        assert heard[:1] == ["there and back"]
        assert {"robot", "me"} <= {name for name, _ in student.get_node_names_and_namespaces()}
        links = student.context.transport.links()
        assert all(each.here.startswith("tls/") for each in links)
        assert {each.certificate for each in links} == {"/robot"}
    finally:
        talker.kill()
        talker.wait()


def test_a_host_is_asked_by_tls_alone_where_there_are_keys(store: Keystore) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        environ = {**os.environ, "ROS_SECURITY_ENCLAVE_OVERRIDE": "/student"}
        plan = network.plan(f"127.0.0.1:{port}", store.domain, environ)
        assert plan.place is not None
        assert plan.place.endpoints == (f"tls/127.0.0.1:{port}",)
        connection, _ = server.accept()
        with connection:
            assert connection.recv(100) == b""


def test_doctor_looks_with_keys_and_says_who_has_some(store: Keystore, monkeypatch: pytest.MonkeyPatch) -> None:
    context = Context()
    context.init(args=["--ros-args", "--enclave", "/robot"])
    with context, Node("arm", context=context):
        monkeypatch.setenv("ROS_SECURITY_ENCLAVE_OVERRIDE", "/student")
        assert look("zenoh://", store.domain).error == ""
        wait_until(lambda: any(isinstance(each, NodeToken) for each in look("zenoh://", store.domain).tokens))

        def finds_keys() -> bool:
            """Return whether a look finds them: it takes a second at most, in which a busy machine may do nothing."""
            facts = gather()
            return (set(facts.keyed_ports), facts.seen.error) == ({FIRST_PORT + store.domain}, "")

        wait_until(finds_keys)
        monkeypatch.delenv("ROS_SECURITY_ENABLE")
        wait_until(lambda: "with security" in gather().seen.error)


def test_a_key_that_is_a_link_to_nothing_is_told(store: Keystore) -> None:
    key = store.folder("/student") / KEY
    key.unlink()
    key.symlink_to(key.with_name("gone.pem"))
    with pytest.raises(SecurityError) as caught:
        session.requested(os.environ, store.domain, "/student")
    assert str(caught.value) == f"the key of enclave '/student' is a link that leads nowhere: {key}"
    assert "/student" not in store.names()
