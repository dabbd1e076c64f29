"""The file of networks: names for hosts and for groups of peers, the user's and the workspace's."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from robolink.exceptions import TransportError
from robolink.networks import hosts, networks_file, places
from robolink.networks.networks_file import Peers
from robolink.networks.port_probe import REFUSES, ROUTER, SILENT, STRANGER, Port
from robolink.transport import network

FILE = """
robot: 10.0.0.1
lab: {peers: [10.0.0.2, "tls/arm.local:9000"], lan: true}
field: {peers: [10.0.0.3]}
room: lan
street: lab.json5
router: tcp/10.0.0.9:7447
"""


@pytest.fixture
def environ(tmp_path: Path) -> dict[str, str]:
    (tmp_path / "networks.yaml").write_text(FILE)
    return {"ROBOLINK_WORKSPACE": str(tmp_path)}


def refusal(value: str, environ: dict[str, str]) -> str:
    with pytest.raises(TransportError) as caught:
        network.plan(value, 0, environ)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_group_of_peers_on_the_local_network(environ: dict[str, str]) -> None:
    found = network.plan("lab", 5, environ)
    assert found.meets
    config = found.config()
    assert json.loads(config.get_json("mode")) == "peer"
    assert {"tcp/10.0.0.2:17452", "tls/arm.local:9000"} <= set(json.loads(config.get_json("connect/endpoints")))
    assert json.loads(config.get_json("listen/endpoints"))[0] == "tcp/0.0.0.0:17452"
    assert json.loads(config.get_json("scouting/multicast/enabled")) is True


def test_peers_alone_open_nothing_here(environ: dict[str, str]) -> None:
    config = network.plan("field", 0, environ).config()
    assert all(each.startswith("tcp/127.0.0.1:") for each in json.loads(config.get_json("listen/endpoints")))
    assert json.loads(config.get_json("scouting/multicast/enabled")) is False
    assert json.loads(config.get_json("access_control/enabled")) is False
    assert "tcp/10.0.0.3:17447" in json.loads(config.get_json("connect/endpoints"))


def test_names_for_other_networks(environ: dict[str, str], tmp_path: Path) -> None:
    assert network.plan("room", 0, environ).request.value == "lan"
    assert network.plan("router", 0, environ).request.value == "tcp/10.0.0.9:7447"
    assert network.plan("street", 0, environ).request.value == str(tmp_path / "lab.json5")


def test_a_name_for_a_host(environ: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    request: list[hosts.Host] = []

    def seek(host: hosts.Host, domain: int) -> Port:
        request.append(host)
        return Port(7447, ROUTER, "ab")

    monkeypatch.setattr(hosts, "seek", seek)
    found = network.plan("robot", 0, environ)
    assert request == [hosts.Host("10.0.0.1")]
    assert found.place == places.Place(("tcp/10.0.0.1:7447",), is_client=True, session="ab")


def test_nobody_answers_there(environ: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hosts, "seek", lambda host, domain: None)
    monkeypatch.setattr(places, "wants_keys", lambda host, port: False)
    assert refusal("robot", environ) == (
        "network: nobody answers at 10.0.0.1, no robolink process (port 17447, domain 0) and no router (port 7447): "
        "start its nodes with --network lan there, or a router (robolink router --listen lan), and open its firewall"
    )
    assert refusal("robot.example:8000", environ) == (
        "network: nobody answers at robot.example, port 8000: is it on, is the port right, and does its firewall let "
        "it through?"
    )


@pytest.mark.parametrize(
    ("port", "said"),
    [
        (Port(8000, STRANGER), "is a program that does not speak Zenoh: is the port right?"),
        (Port(8000, STRANGER, hung_up=True), "somebody hangs up at once: it starts or ends just now, has too many"),
        (Port(8000, SILENT), "somebody listens and does not answer: is that process stopped (Ctrl-Z), or no robolink"),
        (Port(8000, REFUSES), "is a Zenoh session that refuses this one: it has its most sessions, or is of another"),
    ],
)
def test_somebody_else_is_there(port: Port, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hosts, "seek", lambda host, domain: port)
    monkeypatch.setattr(places, "wants_keys", lambda host, port: False)
    assert refusal("robot.example:8000", {}).startswith(f"network: at robot.example, port 8000, {said}")


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("http://robot", "write HOST:PORT in place of a URL"),
        ("robot:70000", "ports are 1 to 65535"),
        ("[::1]:0", "ports are 1 to 65535"),
        ("tcp/robot", "write tcp/HOST:PORT, or HOST alone"),
        ("~nobody-here/lab.json5", places.KNOWN),
        ("x" * 5000, places.KNOWN),
    ],
)
def test_what_is_no_network(value: str, said: str) -> None:
    assert refusal(value, {}) == f"network: no network, host or file '{value[:200]}'; {said}"


def test_the_nearest_name(environ: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(host: hosts.Host, domain: int) -> None:
        raise hosts.UnknownHostError

    monkeypatch.setattr(hosts, "seek", unknown)
    assert "no network, host or file 'robott' (did you mean 'robot'?)" in refusal("robott", environ)
    assert refusal("robott", environ).endswith("field, lab, robot, room, router, street of networks.yaml")
    assert refusal("robot", environ) == "network: 'robot' is 10.0.0.1, a host that is not known"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("lan: robot", "networks.yaml:1:1: lan: 'lan' is the name of another network already"),
        ("'my robot': 10.0.0.1", "a name has letters, digits, _ and - only"),
        ("lab: {peers: []}", "networks.yaml:1:14: lab.peers: name at least one host"),
        ("lab: {peers: [a, 'b c']}", "lab.peers[1]: 'b c' is not a host: write HOST or HOST:PORT"),
        ("lab: {peer: [a]}", "unknown key 'peer' (did you mean 'peers'?)"),
        ("robot: 'a b'", "robot: 'a b' is not a network"),
        ("robot: 'http://robot'", "'http://robot' is not a network: write HOST:PORT in place of a URL"),
        ("robot: tcp/10.0.0.1", "'tcp/10.0.0.1' is not a network: write tcp/HOST:PORT, or HOST alone"),
        ("robot: arm\narm: robot", "robot: 'arm' is a name of this file itself: write the host that it stands for"),
        ("robot: 10.0.0.1\nlab: {peers: [robot]}", "lab.peers[0]: 'robot' is a name of this file itself"),
        ("robot: 5", "robot: expected"),
        ("[", "networks.yaml:1:"),
    ],
)
def test_mistakes_have_a_place(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "networks.yaml").write_text(text)
    assert said in refusal("robot", {"ROBOLINK_WORKSPACE": str(tmp_path)})


def test_the_workspace_counts_more_than_the_user(tmp_path: Path, environ: dict[str, str]) -> None:
    own = tmp_path / "settings/robolink"
    own.mkdir(parents=True)
    (own / "networks.yaml").write_text("robot: 10.9.9.9\nhome: 10.8.8.8\n")
    given = environ | {"XDG_CONFIG_HOME": str(own.parent), "APPDATA": str(own.parent), "HOME": str(tmp_path)}
    if sys.platform == "darwin":
        (tmp_path / "Library").mkdir()
        own.parent.rename(tmp_path / "Library/Application Support")
    found = networks_file.read_all(given, "network")
    assert (found["robot"], found["home"]) == ("10.0.0.1", "10.8.8.8")
    assert found["lab"] == Peers(["10.0.0.2", "tls/arm.local:9000"], lan=True)


def test_where_the_users_file_is() -> None:
    assert networks_file._own_folder({"HOME": "/home/a"}, "linux") == Path("/home/a/.config/robolink")
    assert networks_file._own_folder({"HOME": "/home/a", "XDG_CONFIG_HOME": "not/absolute"}, "linux") == Path(
        "/home/a/.config/robolink"
    )
    assert networks_file._own_folder({"HOME": "/Users/a"}, "darwin") == Path(
        "/Users/a/Library/Application Support/robolink"
    )
    assert networks_file._own_folder({"APPDATA": "C:/a"}, "win32") == Path("C:/a/robolink")
    assert networks_file._own_folder({}, "linux") is networks_file._own_folder({}, "win32") is None


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has other rights")
def test_a_file_that_others_may_write_is_not_found_by_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "networks.yaml").write_text("robot: 10.0.0.1")
    (tmp_path / "below").mkdir()
    monkeypatch.chdir(tmp_path / "below")
    assert networks_file._workspace({}) == tmp_path
    Path(tmp_path / "networks.yaml").chmod(0o666)
    assert networks_file._workspace({}) != tmp_path
    assert f"{tmp_path / 'networks.yaml'} is not read, since others may write it" in refusal("[robot", {})


def test_a_file_that_is_none_is_told(tmp_path: Path) -> None:
    (tmp_path / "networks.yaml").mkdir()
    assert "networks.yaml: cannot be read: " in refusal("robot", {"ROBOLINK_WORKSPACE": str(tmp_path)})


def test_a_home_folder_of_nobody() -> None:
    assert networks_file._workspace({"ROBOLINK_WORKSPACE": "~nobody-here"}) == Path("~nobody-here")
    assert "no file '~nobody-here/x'" in refusal("lan", {"ROBOLINK_LIMITS": "~nobody-here/x"})
