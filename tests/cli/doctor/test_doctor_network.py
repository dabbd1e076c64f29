"""robolink network: the facts of doctor in a few lines."""

from __future__ import annotations

import json

import pytest

from robolink.cli.doctor import checks, gathering
from robolink.cli.doctor import network as command
from robolink.cli.doctor.facts import Facts, Seen, Settings, Verdict
from robolink.cli.main import main
from robolink.networks.port_probe import ROUTER, Port
from robolink.transport.reach import Link, Reach
from robolink.wire import NodeToken

LAN = Reach("peer", ("tcp/127.0.0.1:7447",), ("tcp/0.0.0.0:17447", "tcp/0.0.0.0:0"), "224.0.0.224:17447")
HERE = Link("peer", "tcp/127.0.0.1:5000", "tcp/127.0.0.1:17447", "aa")
ROUTED = Link("router", "tcp/127.0.0.1:5001", "tcp/127.0.0.1:7447", "bb")
FAR = Link("peer", "tcp/10.0.0.1:5002", "tcp/10.0.0.2:33333", "cc")


def said(facts: Facts) -> list[str]:
    return command.lines(command.describe(facts))


def test_whom_it_has_found_and_how() -> None:
    token = NodeToken(0, "cc", "0", "0", "far", "/")
    settings = Settings(network="lan", origin="ROBOLINK_NETWORK")
    assert said(Facts(settings=settings, reach=LAN, seen=Seen("ee", (token,), links=(HERE, ROUTED, FAR)))) == [
        "network   lan (asked for by ROBOLINK_NETWORK), domain 0",
        "meets     the local network (multicast 224.0.0.224:17447)",
        "listens   tcp/0.0.0.0:17447, tcp/0.0.0.0:0",
        "goes to   multicast 224.0.0.224:17447, tcp/127.0.0.1:7447",
        "found     3 sessions, 1 node",
        "          peer at tcp/127.0.0.1:17447: the domain's port",
        "          router at tcp/127.0.0.1:7447: the router on this machine",
        "          peer at tcp/10.0.0.2:33333: gossip, for it does not answer a multicast",
    ]


@pytest.mark.annex("dds")
def test_a_network_of_another_kind_says_whom_it_meets() -> None:
    token = NodeToken(0, "cc", "0", "0", "far", "/")
    settings = Settings(network="dds", origin="--network", transport="dds", whom="nodes of ROS 2 over DDS")
    facts = Facts(settings=settings, seen=Seen("ee", (token,)))
    assert said(facts) == [
        "network   dds (asked for by --network), domain 0",
        "meets     nodes of ROS 2 over DDS",
        "found     1 node",
    ]
    assert checks.reach(facts) == Verdict("nodes meet nodes of ROS 2 over DDS")


@pytest.mark.annex("dds")
def test_what_ros_has_for_dds_has_its_effect_there() -> None:
    environ = {"ROS_STATIC_PEERS": "10.0.0.9", "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}
    there = Settings(network="dds", transport="dds", whom="nodes of ROS 2 over DDS")
    assert checks.settings(Facts(environ, settings=there)).warnings == ()
    assert len(checks.settings(Facts(environ)).warnings) == 2


def read(**environ: str) -> Settings:
    return gathering.read_settings(environ)[0]


@pytest.mark.annex("dds")
def test_the_settings_of_dds_are_read_as_nodes_read_them() -> None:
    found = read(ROBOLINK_NETWORK="dds", ROS_DOMAIN_ID="7")
    assert (found.transport, found.domain, found.meets, found.errors) == ("dds", 7, False, ())
    assert found.whom == "nodes of ROS 2 over DDS on this machine only"
    assert "ROS_SECURITY_ENABLE" in read(ROBOLINK_NETWORK="dds", ROS_SECURITY_ENABLE="true").errors[0]
    wrong = Facts(settings=read(ROBOLINK_NETWORK="dds", ROS_AUTOMATIC_DISCOVERY_RANGE="far"))
    assert checks.settings(wrong).findings == [
        "ROS_AUTOMATIC_DISCOVERY_RANGE must be one of SYSTEM_DEFAULT, LOCALHOST, SUBNET, OFF, got 'far'"
    ]


def test_a_word_when_nobody_answers() -> None:
    found = said(Facts(settings=Settings(network="lan"), reach=LAN))
    assert found[4] == "found     0 sessions, 0 nodes"
    assert found[5].startswith("WARN      network lan: no other machine has answered")
    assert "say --network HOST, that machine's name" in found[5]


def test_a_system_that_could_not_be_looked_at_is_not_empty() -> None:
    facts = Facts(
        settings=Settings(network="lan"), reach=LAN, seen=Seen(error="joining the network took more than 2 s")
    )
    assert said(facts)[4:] == ["found     not known: joining the network took more than 2 s"]
    assert command.describe(facts)._asdict()["unseen"] == "joining the network took more than 2 s"


def test_a_host_that_was_named_is_found_so_whatever_its_address_is() -> None:
    link = Link("router", "tcp/10.0.0.1:5003", "tcp/10.0.0.9:7447", "dd")
    facts = Facts(reach=Reach("client", ("tcp/robot.local:7447",)), seen=Seen("ee", links=(link,)))
    assert command.how(link, facts) == "by its name or address"


def test_a_router_that_listens_everywhere_is_told_and_how_to_close_it() -> None:
    facts = Facts(
        reach=Reach("peer", interfaces=("lo",)),
        ports={7447: Port(7447, ROUTER)},
        router_open_at=("10.0.0.5",),
    )
    (line,) = [each for each in said(facts) if each.startswith("WARN")]
    assert "also listens at 10.0.0.5: through it other machines hear and command your nodes" in line
    assert "robolink's router: without --listen" in line


def test_wrong_settings_are_failures() -> None:
    assert said(Facts(settings=Settings(errors=("ROBOLINK_NETWORK: nobody answers",))))[-1] == (
        "FAIL      ROBOLINK_NETWORK: nobody answers"
    )


def test_foreign_text_is_one_plain_line() -> None:
    found = said(Facts(settings=Settings(network="evil\x1b[2J\nforged")))
    assert all("\n" not in each and "\x1b" not in each for each in found)


def test_json(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    facts = Facts(settings=Settings(network="lan"), reach=LAN, seen=Seen(links=(FAR,)))
    monkeypatch.setattr("robolink.cli.doctor.gathering.gather", lambda: facts)
    assert main(["network", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["network"], found["multicast"], found["nodes"]) == ("lan", "224.0.0.224:17447", 0)
    assert found["links"] == [
        {
            "role": "peer",
            "address": "tcp/10.0.0.2:33333",
            "session": "cc",
            "found": "gossip, for it does not answer a multicast",
            "certificate": "",
        }
    ]


def test_with_security_each_link_has_a_name() -> None:
    keyed = Link("peer", "tls/10.0.0.1:5002", "tls/10.0.0.2:33333", "cc", "/student7")
    facts = Facts(
        settings=Settings(network="lan"), reach=LAN, seen=Seen(links=(keyed,)), by_multicast=frozenset(["cc"])
    )
    assert said(facts)[5] == ("          peer at tls/10.0.0.2:33333: multicast, with the certificate of /student7")
