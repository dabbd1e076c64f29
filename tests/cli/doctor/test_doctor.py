"""robolink doctor: what the command says of sound, wrong and hostile systems."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli import doctor
from robolink.cli.doctor import dds, gathering, graph_checks, look
from robolink.cli.doctor.facts import MOST_SHOWN, Facts, Seen
from robolink.cli.doctor.report import sections
from robolink.cli.main import main
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.networks.request import FIRST_PORT
from robolink.qos import QoSProfile
from robolink.transport import Query, Transport, shared_memory
from robolink.wire import (
    DataKey,
    EndpointKind,
    EndpointToken,
    format_key,
    format_token,
    pack_attachment,
    unpack_attachment,
)
from tests.support.domains import free_domain
from tests.support.interop import put_router_at
from tests.support.ports import free_port, stranger, zenoh_router
from tests.support.programs import Program
from tests.support.seen_by_commands import LATCHED, a_node_that_commands_see, made
from tests.support.transports import Network

SERVICE = EndpointKind.SERVICE
HASH = "RIHS01_" + "a" * 64
PARAMETERS = "rcl_interfaces/srv/GetParameters"
PLAIN = QoSProfile(depth=10)
ROOMY = shared_memory.Machine(total=2**30, free=2**30)


@pytest.fixture(autouse=True)
def _usual_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever this machine's settings and memory are."""
    for name in list(os.environ):
        if name.startswith(("ROS_", "RMW_", "ZENOH_", "ROBOLINK_")):
            monkeypatch.delenv(name)
    monkeypatch.setattr(shared_memory, "this_machine", lambda: ROOMY)
    monkeypatch.setattr(dds, "look", lambda domain: dds.Dds())


# --- The command ----------------------------------------------------------------------------------------------------

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as found:
        yield found


def outcome(capsys: Captured, *options: str) -> tuple[int, dict[str, Any]]:
    """Run doctor --json: the exit code, and each check's level by name besides the totals."""
    code = main(["doctor", "--json", *options])
    found = json.loads(capsys.readouterr().out)
    return code, found | {each["name"]: each["level"] for each in found["checks"]}


def test_a_sound_system_passes(robot: Node, capsys: Captured) -> None:
    robot.create_publisher(Twist, "/cmd_vel", 10)
    assert main(["doctor"]) == 0
    out = capsys.readouterr().out
    assert "WARN  settings        ROBOLINK_TRANSPORT=memory://" in out
    assert "ok    domains         domain 7 has 1 node\n" in out
    assert out.endswith(
        "\n20 of 22 checks passed, 1 warning, 1 not known\n\nBy what one sees: docs/reference/troubleshooting.md\n"
    )


@pytest.mark.parametrize(
    ("levels", "said"),
    [
        ({"ok": 17}, "All 17 checks passed"),
        ({"ok": 15, "warning": 2}, "15 of 17 checks passed, 2 warnings"),
        ({"ok": 16, "unknown": 1}, "16 of 17 checks passed, 1 not known"),
        ({"warning": 1, "unknown": 2}, "0 of 3 checks passed, 1 warning, 2 not known"),
    ],
)
def test_what_has_not_passed_is_not_said_to_have(levels: dict[str, int], said: str) -> None:
    assert doctor._passed([level for level, count in levels.items() for _ in range(count)]) == said


def test_another_distributions_robolink_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, owned in [("robodk", "robolink/__init__.py"), ("lone", "robolink.py"), ("far", "robolinks/a.py")]:
        folder = tmp_path / f"{name}-1.2.dist-info"
        folder.mkdir()
        (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n")
        (folder / "RECORD").write_text(f"{name}/a.py,,\n{owned},sha256=abc,12\n")
    (tmp_path / "bare-1.0.dist-info").mkdir()
    (tmp_path / "bare-1.0.dist-info" / "METADATA").write_text("Metadata-Version: 2.1\nName: bare\nVersion: 1.0\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert sorted(gathering.namesakes()) == ["lone 1.2", "robodk 1.2"]


def test_what_is_wrong_fails_and_is_named(robot: Node, capsys: Captured) -> None:
    robot.create_publisher(String, "/chatter", 10)
    robot.create_subscription(Int32, "/chatter", print, LATCHED)
    robot.create_client(SetBool, "/lamp")
    robot.create_service(Trigger, "/lamp", lambda request, response: response)
    assert main(["wtf"]) == 1
    out = capsys.readouterr().out
    assert "FAIL  topic types     /chatter: /lab/robot publishes std_msgs/msg/String, /lab/robot subscribes to" in out
    assert "FAIL  service types   /lamp: " in out
    assert "WARN  qos             /chatter: " in out
    failed = "\n2/22 check(s) failed\n\nFailed modules: middleware\n"
    assert out.endswith(f"{failed}By what one sees: docs/reference/troubleshooting.md\n")


def test_warnings_count_when_asked_to(robot: Node, capsys: Captured) -> None:
    robot.create_subscription(LaserScan, "/scan", print, 10)
    made(robot.context, "robot", "/lab")
    code, found = outcome(capsys)
    assert (code, found["failed"], found["topics"]) == (0, 0, "warning")
    code, found = outcome(capsys, "-iw")
    assert code == 1
    assert found["failed_modules"] == ["network", "node", "topic"]


def test_the_report_has_ros2s_sections(robot: Node, capsys: Captured) -> None:
    robot.create_publisher(Clock, "/clock", 10)
    robot.create_subscription(Clock, "/clock", print, 10)
    assert main(["doctor", "-r"]) == 0
    out = capsys.readouterr().out
    for heading in ("NETWORK CONFIGURATION", "PLATFORM INFORMATION", "TOPIC LIST", "QOS COMPATIBILITY LIST"):
        assert f"\n   {heading}\n" in out
    assert "topic               : /clock\npublisher count     : 1\nsubscriber count    : 1\n" in out
    assert "topic [type]            : /clock [rosgraph_msgs/msg/Clock]\n" in out


def test_the_report_of_failed_modules_only(robot: Node, capsys: Captured) -> None:
    assert main(["doctor", "-rf"]) == 0
    assert "LIST" not in capsys.readouterr().out
    robot.create_publisher(String, "/chatter", 10)
    robot.create_subscription(Int32, "/chatter", print, 10)
    code, found = outcome(capsys, "-rf")
    assert code == 1
    assert sorted(found["report"]) == ["QOS COMPATIBILITY LIST", "RMW MIDDLEWARE"]


def test_malformed_announcements_break_nothing(robot: Node, capsys: Captured) -> None:
    for text in (
        "@ros2_lv/7",
        "@ros2_lv/7/zz/%/\x1b[31m",
        "@ros2_lv/" + "9" * 5000,
        "@ros2_lv/7/" + "/".join("abcdefghijk"),
    ):
        robot.context.transport.announce(text)
    code, found = outcome(capsys, "-r")
    assert (code, found["announcements"], found["nodes"]) == (0, "warning", "ok")


@given(st.lists(st.text(max_size=60)))
def test_any_announcement_can_be_reported(texts: list[str]) -> None:
    found = Facts(seen=Seen(malformed=tuple(texts)))
    assert all(line for section in sections(found) for line in section.lines())
    assert len(graph_checks.announcements(found).findings) == min(len(texts), MOST_SHOWN + 1)


def test_settings_that_cannot_be_fail_and_nothing_is_tried(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "666")
    code, found = outcome(capsys)
    assert (code, found["settings"], found["announcements"], found["domains"]) == (1, "error", "error", "unknown")
    assert found["failed_modules"] == ["middleware", "network"]


# --- Clocks ---------------------------------------------------------------------------------------------------------


def test_a_node_is_asked_for_the_time(robot: Node) -> None:
    ahead = announce_clock(robot, lambda query: answer(query, 5.0))
    (found,) = look.look(ahead.url, 7).clocks
    assert found.node == "/far"
    assert abs(found.seconds - 5.0) <= found.uncertainty + 1e-3
    assert found.uncertainty < 4.0


@pytest.mark.parametrize("reply", [None, b"", b"x" * 40])
def test_who_does_not_tell_the_time_is_not_waited_for(robot: Node, reply: bytes | None) -> None:
    def refuse(query: Query) -> None:
        if reply is not None:
            query.reply(b"", reply)
            query.close()

    transport = announce_clock(robot, refuse)
    begin = time.monotonic()
    assert look.look(transport.url, 7).clocks == ()
    assert time.monotonic() - begin < 5.0


def announce_clock(robot: Node, on_query: Callable[[Query], object]) -> Transport:
    """The node /far, of another session, which serves its parameters."""
    robot.destroy_node()
    transport = robot.context.transport
    far = EndpointToken(7, "b", "0", "1", SERVICE, "/", "/", "far", "/far/get_parameters", PARAMETERS, HASH, PLAIN)
    transport.serve(format_key(DataKey(7, far.name, far.type_name, HASH)), lambda got: on_query(transport.accept(got)))
    transport.announce(format_token(far))
    return transport


def answer(query: Query, ahead: float) -> None:
    asked = unpack_attachment(query.attachment)
    assert query.payload == b"\x00\x01\x00\x00" + bytes(4)
    query.reply(b"", pack_attachment(asked.sequence, time.time_ns() + int(ahead * 1e9), asked.gid))
    query.close()


# --- Over Zenoh -----------------------------------------------------------------------------------------------------

TALKER = """
    import robolink
    from robolink.interfaces.std_msgs.msg import String

    robolink.init()
    node = robolink.create_node("talker")
    node.create_publisher(String, "/chatter", 10)
    print("ready", flush=True)
    robolink.spin(node)
"""


@pytest.fixture
def on_domain(domain: int, monkeypatch: pytest.MonkeyPatch) -> int:
    """The domain that commands are on."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    return domain


@pytest.fixture
def routers_port(monkeypatch: pytest.MonkeyPatch) -> int:
    """A free port that stands for the ROS 2 router's."""
    port = free_port()
    put_router_at(monkeypatch, port)
    return port


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch, patient_looks: None) -> None:
    """A doctor who gives a busy machine its time."""
    for name in ("ANSWER_WITHIN", "LOOK_WITHIN", "COUNT_WITHIN"):
        monkeypatch.setattr(gathering, name, 10.0)
    monkeypatch.setattr(look, "CLOCKS_WITHIN", 10.0)


@pytest.mark.processes
@pytest.mark.usefixtures("patient")
def test_nodes_of_another_process_are_seen(on_domain: int, routers_port: int, tmp_path: Path, capsys: Captured) -> None:
    with Program(tmp_path, TALKER, on_domain) as talker:
        assert talker.line() == "ready"
        assert main(["doctor", "-iw"]) == 0
        out = capsys.readouterr().out
    assert f"port {FIRST_PORT + on_domain} of domain {on_domain} is held by a Zenoh peer" in out
    assert f"domain {on_domain} has 1 node" in out
    assert "1 node asked" in out
    if sys.platform == "linux":
        assert "program_0.py" in out


@pytest.mark.processes
@pytest.mark.usefixtures("patient")
def test_nodes_on_another_domain_are_pointed_at(
    on_domain: int, routers_port: int, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    answering = gathering._other_domains
    with free_domain() as other, Program(tmp_path, TALKER, other) as talker:
        assert talker.line() == "ready"
        # Other tests have their own domains meanwhile, and only the first few are named.
        monkeypatch.setattr(
            gathering, "_other_domains", lambda found: [each for each in answering(found) if each == other]
        )
        main(["doctor"])
        out = capsys.readouterr().out
    assert f"WARN  domains         domain {on_domain} has 0 nodes, but " in out
    assert f"domain {other} has 1 node" in out


@pytest.mark.parametrize("says", [None, b"HTTP/1.1 400 Bad Request\r\n\r\n"])
def test_a_stranger_on_the_rendezvous_port_is_named_at_once(
    on_domain: int, routers_port: int, says: bytes | None, capsys: Captured
) -> None:
    with stranger(FIRST_PORT + on_domain, says):
        code, found = outcome(capsys)
    assert (code, found["rendezvous"], found["announcements"]) == (1, "error", "error")
    assert "taken by a stranger" in found["checks"][-1]["errors"][0]  # so joining was not even tried


def test_a_stranger_on_the_routers_port_breaks_nothing(on_domain: int, routers_port: int, capsys: Captured) -> None:
    with stranger(routers_port):
        code, found = outcome(capsys)
    assert (code, found["router"], found["announcements"]) == (1, "error", "ok")


@pytest.mark.usefixtures("patient")
def test_a_ros_2_router_and_the_nodes_behind_it_are_seen(
    on_domain: int, routers_port: int, capsys: Captured, zenoh_net: Network
) -> None:
    with zenoh_router(routers_port) as session:
        peer = zenoh_net.session()
        peer.announce(f"@ros2_lv/{on_domain}/{peer.session_id}/0/0/NN/%/%/far")
        code, found = outcome(capsys, "-r")
    assert (code, found["router"], found["domains"]) == (0, "ok", "ok")
    assert any(session in value for _, value in found["report"]["NETWORK CONFIGURATION"])
    assert ["node", f"/far (session {peer.session_id[:8]})"] in found["report"]["NODE LIST"]


def test_a_router_that_is_asked_for_and_is_not_there(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", f"tcp/127.0.0.1:{free_port()}")
    code, found = outcome(capsys)
    assert (code, found["router"], found["announcements"]) == (1, "error", "error")


@pytest.mark.usefixtures("patient")
def test_a_router_that_is_asked_for_answers(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    port = free_port()
    monkeypatch.setenv("ROBOLINK_NETWORK", f"tcp/127.0.0.1:{port}")
    with zenoh_router(port):
        code, found = outcome(capsys)
    assert (code, found["router"], found["announcements"]) == (0, "ok", "ok")


@pytest.mark.parametrize("endpoint", ["tcp/nowhere.invalid:7447", "tcp/127.0.0.1:99999", "tcp/[::1]:9"])
def test_a_router_that_cannot_be(endpoint: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", endpoint)
    code, found = outcome(capsys)
    assert (code, found["router"]) == (1, "error")
