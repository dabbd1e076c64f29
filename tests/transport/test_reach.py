"""Whom a session can meet, as its configuration has it."""

from __future__ import annotations

import json

import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import TransportError
from robolink.networks.settings import only_on, settings
from robolink.transport import certificates, network, port_sharing
from robolink.transport.reach import Link, Reach, host_of, on_this_machine, reach

ROBOT = 'connect/endpoints=["tcp/robot:7447#so_sndbuf=8192"]'


@pytest.mark.parametrize(
    ("name", "override", "leaves", "said"),
    [
        ("lan", "", True, "the local network (multicast 224.0.0.224:17450)"),
        ("off", "", False, "no other process"),
        ("tcp/10.0.0.1:7447", "", True, "whoever is behind tcp/10.0.0.1:7447, as its client"),
        ("localhost", 'mode="client"', False, "whoever is behind tcp/127.0.0.1:7447, as its client"),
        ("localhost", ROBOT, True, "whoever answers at tcp/robot:7447"),
        ("localhost", 'listen/endpoints={peer: ["tcp/0.0.0.0:7"]}', True, "whoever connects to tcp/0.0.0.0:7"),
        ("localhost", ROBOT + ";scouting/multicast/enabled=true", True,
         "the local network (multicast 224.0.0.224:7446), whoever answers at tcp/robot:7447"),
    ],
)  # fmt: skip
def test_networks_say_whom_they_reach(name: str, override: str, leaves: bool, said: str) -> None:
    found = reach(network.load(name, 3, {"ZENOH_CONFIG_OVERRIDE": override}))
    assert (found.leaves_machine, str(found)) == (leaves, said)


@pytest.mark.parametrize(
    ("platform", "said"), [("linux", " (interface lo)"), ("darwin", " (interface lo0)"), ("win32", "")]
)
def test_nobody_leaves_this_machine_unless_asked_to(platform: str, said: str) -> None:
    config = zenoh.Config.from_json5(json.dumps(settings("localhost", 0, platform=platform)))
    found = reach(config)
    assert (found.leaves_machine, str(found)) == (False, f"those on this machine only{said}")


def test_access_control_for_other_interfaces_too_confines_nobody() -> None:
    wished = settings("lan", 0) | {"access_control": only_on("lo")}
    assert not reach(zenoh.Config.from_json5(json.dumps(wished))).leaves_machine
    wished["access_control"]["subjects"] += [{"id": "wlan", "interfaces": ["wlan0"]}]
    assert reach(zenoh.Config.from_json5(json.dumps(wished))).leaves_machine
    wished["access_control"]["subjects"] = [{"id": "all"}]
    assert reach(zenoh.Config.from_json5(json.dumps(wished))).leaves_machine


def test_zenohs_own_configuration_seeks_the_local_network() -> None:
    assert reach(zenoh.Config()) == Reach("peer", (), ("tcp/[::]:0",), "224.0.0.224:7446", ())


@given(st.text())
def test_any_endpoint_can_be_looked_at(text: str) -> None:
    host_of(text)
    assert not on_this_machine(f"tcp/10.0.0.1:7447?{text}")
    assert on_this_machine(f"tcp/127.0.0.1:7447#{text}")


PATHS = ("mode", "connect", "connect/endpoints", "listen/endpoints", "access_control", "transport/link/tls")
VALUES = (
    *("null", "[]", "{}", "true", '"client"', '"nonsense"', "['x']", "['tls/']", "{peer: null}", "[{id: 'a'}]"),
    *("{endpoints: {peer: ['tcp/1:1'], router: []}}", "{enabled: true, subjects: [{id: 'a'}]}"),
)


@given(st.one_of(st.text(), st.builds("{}={}".format, st.sampled_from(PATHS), st.sampled_from(VALUES))))
def test_any_override_is_read_or_refused_in_a_line(override: str) -> None:
    try:
        config = network.load(None, 0, {"ZENOH_CONFIG_OVERRIDE": override})
    except TransportError as error:
        said = str(error)
    else:
        said = str(reach(config))
        assert certificates.doubts(config) == []
        port_sharing.fixed_listeners(config)
    assert said
    assert "\n" not in said


def test_a_link_to_an_own_address_stays_on_this_machine() -> None:
    assert not Link("peer", "tcp/10.0.0.1:40000", "tcp/10.0.0.1:17447").leaves_machine
    assert Link("peer", "tcp/[fe80::1]:40000", "tcp/[fe80::2]:17447").leaves_machine
