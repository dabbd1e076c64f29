"""What robolink bridge dds asks for, and what it says."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from robolink.cli.bridge.running import checked_network, dds_environ, met, opening, report
from robolink.cli.main import main
from robolink.dds.mirror import Count
from robolink.exceptions import RobolinkError, TransportError

RANGE, INTERFACE, PEERS = "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROBOLINK_DDS_INTERFACE", "ROS_STATIC_PEERS"


@pytest.mark.parametrize(
    ("environ", "interface", "expected"),
    [
        ({}, "", {RANGE: "LOCALHOST"}),
        ({RANGE: "SUBNET", INTERFACE: "eth0", PEERS: "robot"}, "", {RANGE: "LOCALHOST"}),
        ({RANGE: "off"}, "", {RANGE: "OFF"}),
        ({}, "eth0", {RANGE: "SUBNET", INTERFACE: "eth0"}),
        (
            {RANGE: "LOCALHOST", PEERS: "robot"},
            "eth0",
            {RANGE: "LOCALHOST", INTERFACE: "eth0", PEERS: "robot"},
        ),
    ],
)
def test_dds_leaves_the_machine_only_where_an_interface_is_named(
    environ: dict[str, str], interface: str, expected: dict[str, str]
) -> None:
    assert dds_environ(environ, interface) == expected


def test_the_zenoh_side_is_as_for_nodes_but_never_dds() -> None:
    assert checked_network({}) == "localhost"
    assert checked_network({"ROBOLINK_NETWORK": "robot.local"}) == "robot.local"
    with pytest.raises(TransportError, match="ROBOLINK_NETWORK: 'dds' is the other side of the bridge"):
        checked_network({"ROBOLINK_NETWORK": "dds"})


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ["--network", "dds"],
            "--network: 'dds' is the other side of the bridge: name the Zenoh network, such as localhost\n",
        ),
        (["--domain", "300"], "--domain must be a number from 0 to 232, got 300\n"),
    ],
)
def test_wrong_options_are_one_line(options: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bridge", "dds", *options]) == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.endswith(said)


def test_under_security_it_refuses(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    assert main(["bridge", "dds", "--domain", "57"]) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "ROS_SECURITY_ENABLE is true, and robolink has no security on DDS" in err


def test_it_says_who_can_hear_and_command_the_nodes() -> None:
    assert opening(7, "localhost", "", {}) == [
        "robolink bridge: DDS on this machine and Zenoh (localhost), domain 7; Ctrl-C ends it"
    ]
    lan = opening(7, "lan", "", {PEERS: "robot"})
    assert lan[1].startswith(
        "all nodes on DDS here are now on that network, too: whoever is there may hear and command"
    )
    assert lan[2] == f"WARN {PEERS} has no effect without --interface"
    interface = opening(7, "localhost", "eth0", {PEERS: "robot"})
    assert interface[0].startswith("robolink bridge: DDS on this machine and eth0 and Zenoh (localhost)")
    assert interface[1].startswith("whoever reaches eth0 may hear and command all nodes over DDS")
    assert len(interface) == 2


def test_what_was_met_is_said_when_it_has_settled() -> None:
    counts: Iterator[Count] = iter(
        [
            Count((0, 0), 0, 0, 0, 0),
            Count((1, 2), 1, 0, 0, 0),
            Count((1, 3), 1, 7, 0, 0),
            *[Count((1, 3), 1, 7, 0, 0)] * 3,
            *[Count((1, 3), 2, 7, 5, 1)] * 2,
        ]
    )
    lines: list[str] = []

    def check() -> None:
        if len(lines) == 2:
            raise RobolinkError("another bridge")

    with pytest.raises(RobolinkError, match="another bridge"):
        report(lambda: next(counts), check, lines.append, lambda seconds: None)
    assert lines == [
        "nodes: 1 on Zenoh, 3 on DDS; topics flowing: 1; services: 7",
        "nodes: 1 on Zenoh, 3 on DDS; topics flowing: 2; services: 7; messages dropped: 5; not carried: 1",
    ]
    assert met(Count((0, 0), 0, 0, 0, 0)) == "nodes: 0 on Zenoh, 0 on DDS; topics flowing: 0; services: 0"
