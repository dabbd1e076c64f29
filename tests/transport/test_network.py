"""Networks are local unless asked for; what cannot be is said in one line that names who asked."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
import zenoh

from robolink.exceptions import TransportError
from robolink.networks import request
from robolink.networks.request import FIRST_PORT, NAMES, ROS_ROUTER, checked_domain, domain_id, requested
from robolink.networks.settings import client, most_pending, settings
from robolink.transport import network


def test_domains() -> None:
    assert domain_id({}) == domain_id({"ROS_DOMAIN_ID": " "}) == 0
    assert domain_id({"ROS_DOMAIN_ID": "42"}) == 42
    assert checked_domain(232) == 232


@pytest.mark.parametrize("text", ["x", "-1", "233", "1.5", "9" * 5000, "²"])
def test_no_domain(text: str) -> None:
    with pytest.raises(TransportError, match="ROS_DOMAIN_ID must be a number from 0 to 232, got ") as caught:
        domain_id({"ROS_DOMAIN_ID": text})
    assert len(str(caught.value)) < 120


@pytest.mark.parametrize("value", [None, "", "false", "False"])
def test_security_that_is_switched_off_takes_no_recovery_away(value: str | None) -> None:
    found = network.plan("lan", 0, {} if value is None else {"ROS_SECURITY_ENABLE": value})
    assert found.thinned() == []
    assert found._replace(secure=lambda _: None).thinned() is None


@pytest.mark.parametrize(
    ("argument", "environ", "origin", "value"),
    [
        (None, {}, "ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost"),
        (None, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}, "ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost"),
        (None, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "Subnet"}, "ROS_AUTOMATIC_DISCOVERY_RANGE", "lan"),
        (None, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, "ROS_AUTOMATIC_DISCOVERY_RANGE", "off"),
        (None, {"ZENOH_SESSION_CONFIG_URI": "a.json5", "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, None, "a.json5"),
        (None, {"ROBOLINK_NETWORK": "subnet", "ZENOH_SESSION_CONFIG_URI": "a.json5"}, "ROBOLINK_NETWORK", "lan"),
        ("off", {"ROBOLINK_NETWORK": "subnet"}, "network", "off"),
    ],
)
def test_which_network(argument: str | None, environ: dict[str, str], origin: str | None, value: str) -> None:
    found = requested(argument, environ)
    assert found == (origin or "ZENOH_SESSION_CONFIG_URI", value)


def test_an_error_names_the_word_that_was_used() -> None:
    """The option of the command line is handed on in variables, also to processes that a launch starts."""
    environ = {"ROBOLINK_NETWORK": "localhost"}
    request.ask(environ, "sub/nett", "--network")
    assert refusal(environ).startswith("--network: no network, host or file 'sub/nett'")
    environ["ROBOLINK_NETWORK"] = "no=where"  # which a node's own environment says
    assert refusal(environ).startswith("ROBOLINK_NETWORK: no network, host or file 'no=where'")


def test_an_unknown_range() -> None:
    with pytest.raises(TransportError, match="LOCALHOST, SUBNET, OFF, got 'WORLD'"):
        requested(None, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "WORLD"})


@pytest.mark.parametrize(("platform", "interface"), [("linux", "lo"), ("darwin", "lo0")])
def test_this_machine_only(platform: str, interface: str) -> None:
    found = settings("localhost", 5, platform=platform)
    assert found["listen"]["endpoints"] == ["tcp/127.0.0.1:17452", "tcp/127.0.0.1:0"]
    assert found["connect"]["endpoints"] == ["tcp/127.0.0.1:7447"]
    assert found["scouting"]["multicast"] == {"enabled": False}
    assert found["access_control"]["subjects"] == [{"id": "loopback", "interfaces": [interface]}]
    assert found["access_control"]["default_permission"] == "deny"


def test_windows_does_not_seek_what_could_lead_elsewhere() -> None:
    found = settings("localhost", 0, holds_port=False, platform="win32")
    assert [each.partition("#")[0] for each in found["connect"]["endpoints"]] == ["tcp/127.0.0.1:17447"]
    assert settings("localhost", 0, platform="win32")["connect"]["endpoints"] == []
    assert "access_control" not in found


def test_a_taken_port_is_left_alone() -> None:
    for name in ("localhost", "lan"):
        found = settings(name, 0, holds_port=False, platform="linux")
        assert [endpoint.rpartition(":")[2] for endpoint in found["listen"]["endpoints"]] == ["0"]
        assert found["connect"]["endpoints"][0].startswith("tcp/127.0.0.1:17447#retry_period")


def test_the_subnet_has_its_own_multicast_group() -> None:
    found = settings("lan", 1)
    assert found["listen"]["endpoints"][0] == "tcp/0.0.0.0:17448"
    assert found["scouting"]["multicast"] == {"enabled": True, "address": "224.0.0.224:17448"}


def test_off_and_a_router() -> None:
    off = settings("off", 0)
    assert (off["listen"]["endpoints"], off["scouting"]["gossip"]) == ([], {"enabled": False})
    found = client("tls/robot.local:7447")
    assert (found["mode"], found["connect"]["endpoints"]) == ("client", ["tls/robot.local:7447"])
    assert "listen" not in found


@pytest.mark.parametrize("value", [*NAMES, "tcp/10.0.0.1:7447"])
def test_zenoh_accepts_all_of_them(value: str) -> None:
    config = network.load(value, 7, {})
    assert json.loads(config.get_json("timestamping/enabled")) is True
    assert json.loads(config.get_json("scouting/multicast/enabled")) is (value == "lan")


def test_a_file_of_ones_own(tmp_path: Path) -> None:
    path = tmp_path / "lab.json5"
    path.write_text("{mode: 'client', /* ours */ connect: {endpoints: ['tcp/10.0.0.1:7447']}}")
    for value in (str(path), f"file://{path}"):
        config = network.load(None, 0, {"ROBOLINK_NETWORK": value})
        assert json.loads(config.get_json("connect/endpoints")) == ["tcp/10.0.0.1:7447"]
        assert json.loads(config.get_json("timestamping/enabled")) is True


@pytest.mark.parametrize(
    "override", ['mode="client"', 'connect/endpoints=["tcp/10.0.0.1:7447"]', "listen={endpoints: ['tcp/0.0.0.0:7']}"]
)
def test_overrides_that_name_a_network_are_asked_for_that(override: str) -> None:
    """Nothing stays on that keeps a session on this machine: neither the access control nor the rendezvous."""
    environ = {"ZENOH_CONFIG_OVERRIDE": f"scouting/delay=7; {override}"}
    found = requested("localhost", environ)
    assert found == ("ZENOH_CONFIG_OVERRIDE", override)
    assert not network.meets_at_port(found.value, environ)
    config = network.load(None, 0, environ)
    assert not json.loads(config.get_json("access_control/enabled"))
    assert str(FIRST_PORT) not in config.get_json("connect/endpoints")
    assert config.get_json("scouting/delay") == "7"


def test_overrides_that_name_a_mode_only_go_where_ros_2_goes() -> None:
    for mode in ("peer", "client"):
        config = network.load(None, 0, {"ZENOH_CONFIG_OVERRIDE": f'mode="{mode}"'})
        assert json.loads(config.get_json("connect/endpoints")) == [ROS_ROUTER]
        assert config.get_json("mode") == f'"{mode}"'
        assert "0.0.0.0" not in config.get_json("listen/endpoints")


def test_another_network_that_was_named_stays_what_it_is() -> None:
    environ = {"ZENOH_CONFIG_OVERRIDE": 'connect/endpoints=["tcp/10.0.0.1:7447"]'}
    assert requested("subnet", environ) == ("network", "lan")
    assert requested("off", environ) == ("network", "off")


def test_overridden_access_control_is_not_mixed_with_ours() -> None:
    environ = {"ZENOH_CONFIG_OVERRIDE": 'access_control/enabled=true;access_control/default_permission="allow"'}
    found = json.loads(network.load(None, 0, environ).get_json("access_control"))
    assert (found["enabled"], found["default_permission"], found["rules"]) == (True, "allow", None)
    assert network.meets_at_port(requested(None, environ).value, environ)


def test_overrides_have_the_last_word() -> None:
    environ = {"ZENOH_CONFIG_OVERRIDE": 'mode="client"; scouting/delay=7;'}
    config = network.load(None, 0, environ)
    assert (config.get_json("mode"), config.get_json("scouting/delay")) == ('"client"', "7")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{mode: 'peer', listn: 3}", "unknown field `listn`"),
        ("{mode: 'peer',\n listen {", "line 1, column 8: expected boolean or null"),
        ("", "expected"),
        ("\0" * 10, "expected"),
    ],
)
def test_a_broken_file(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "broken.json5"
    path.write_text(text)
    message = refusal({"ROBOLINK_NETWORK": str(path)})
    assert message.startswith(f"ROBOLINK_NETWORK: {path}: ")
    assert problem in message


@pytest.mark.parametrize(
    ("environ", "message"),
    [
        (
            {"ROBOLINK_NETWORK": "sub/nett"},
            (
                "ROBOLINK_NETWORK: no network, host or file 'sub/nett' (did you mean 'subnet'?); the networks are "
                "localhost, lan, off, dds, HOST[:PORT] and tls/HOST[:PORT] of a robot or router, and files of Zenoh's"
            ),
        ),
        ({"ZENOH_CONFIG_OVERRIDE": "nonsense/x=1"}, "ZENOH_CONFIG_OVERRIDE: 'nonsense/x=1': unknown key"),
        (
            {"ZENOH_CONFIG_OVERRIDE": "scouting/delay={"},
            "ZENOH_CONFIG_OVERRIDE: 'scouting/delay={': line 1, column 2: expected identifier or string",
        ),
        (  # a byte that is not UTF-8, as os.environ has it
            {"ZENOH_CONFIG_OVERRIDE": "scouting/delay=\udcff\x1b[2J"},
            (
                "ZENOH_CONFIG_OVERRIDE: 'scouting/delay=\\udcff\\x1b[2J': "
                "'utf-8' codec can't encode character '\\udcff' in position 0: surrogates not allowed"
            ),
        ),
        (
            {"ZENOH_CONFIG_OVERRIDE": f"nonsense/{'x' * 100_000}=1"},
            f"ZENOH_CONFIG_OVERRIDE: 'nonsense/{'x' * 88}...': unknown key",
        ),
    ],
)
def test_refusals(environ: dict[str, str], message: str) -> None:
    assert refusal(environ) == message


def refusal(environ: dict[str, str]) -> str:
    with pytest.raises(TransportError) as caught:
        network.load(None, 0, environ)
    message = str(caught.value)
    assert "\n" not in message
    assert ".rs:" not in message
    return message


def test_who_meets_at_the_rendezvous_port() -> None:
    assert network.meets_at_port("localhost", {"ZENOH_CONFIG_OVERRIDE": "scouting/delay=7"})
    assert network.meets_at_port("subnet", {})
    assert not network.meets_at_port("tcp/10.0.0.1:7447", {})
    assert not network.meets_at_port("localhost", {"ZENOH_CONFIG_OVERRIDE": "listen/endpoints=[]"})


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit of open files that could be read")
@pytest.mark.parametrize(("files", "pending"), [(256, 128), (1024, 512), (1 << 20, 10_000), (-1, 10_000)])
def test_silent_connections_leave_a_process_half_of_its_files(
    files: int, pending: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("resource.getrlimit", lambda which: (files, files))
    assert most_pending() == pending


def test_the_settings_are_those_that_were_tried() -> None:
    """Guards the parts without which a session listens to the world, hangs at close or misses the graph."""
    found: dict[str, Any] = settings("localhost", 0, platform="linux")
    assert "retry" not in found["listen"]
    assert found["connect"]["timeout_ms"] == -1
    data, graph = found["access_control"]["rules"]
    assert set(data["key_exprs"]) == {"**", "**/@adv/**"}  # tokens are looked up for each kind of message: no more here
    assert set(graph["key_exprs"]) == {"**", "@ros2_lv/**", "**/@adv/**"}
    assert not set(data["messages"]) & set(graph["messages"])
    assert zenoh.Config.from_json5(json.dumps(found)).get_json("adminspace/enabled") == "false"
