"""Networks that lead to another machine: who is met there, and what doctor says where nobody is."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from robolink.networks.request import FIRST_PORT
from tests.support import stalls
from tests.support.authority import can_make, make_authority, make_certificate
from tests.support.machines import HERE, NODE, ROUTER, THERE, Machines, nodes

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]


@pytest.fixture
def machines() -> Iterator[Machines]:
    with ExitStack() as stack:
        yield Machines(stack)


@pytest.mark.parametrize("mode", ['mode="client";', ""])
def test_an_override_that_names_an_endpoint_joins_it(machines: Machines, mode: str) -> None:
    for name in "ab":
        machines.start(machines.there, NODE, name, ROBOLINK_NETWORK="lan")
    override = f'{mode}connect/endpoints=["tcp/{THERE}:{FIRST_PORT + machines.domain}"]'
    assert nodes(machines.doctor(ZENOH_CONFIG_OVERRIDE=override)) == ["/a", "/b"]


def test_an_override_that_names_a_ros_2_router_joins_it(machines: Machines) -> None:
    machines.start(machines.there, ROUTER)
    machines.start(machines.there, NODE, "far")
    override = f'mode="client";connect/endpoints=["tcp/{THERE}:7447"]'
    assert nodes(machines.doctor(ZENOH_CONFIG_OVERRIDE=override)) == ["/far"]


def test_doctor_says_that_multicast_does_not_pass_and_what_does(machines: Machines) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    found = machines.doctor(ROBOLINK_NETWORK="lan")
    (said,) = found["checks"]["reach"]["warnings"]
    assert said.startswith("network lan: no other machine has answered (the local network (multicast 224.0.0.224:")
    assert "multicast does not pass" in said
    assert said.endswith("here, say --network HOST, that machine's name")
    for name in (THERE, f"tcp/{THERE}:{FIRST_PORT + machines.domain}"):
        found = machines.doctor(ROBOLINK_NETWORK=name)
        assert (nodes(found), found["checks"]["reach"]["level"]) == (["/far"], "ok")


def test_doctor_says_that_a_router_passes_nothing_on_to_a_peer(machines: Machines) -> None:
    machines.start(machines.there, ROUTER)
    machines.start(machines.there, NODE, "far")
    found = machines.doctor(ZENOH_CONFIG_OVERRIDE=f'connect/endpoints=["tcp/{THERE}:7447"]')
    (said,) = found["checks"]["reach"]["warnings"]
    assert said.endswith(
        'but nobody there has a node; a router of ROS 2 passes things on to its clients only: add mode="client"'
    )


def test_doctor_says_that_nobody_answers_at_an_endpoint(machines: Machines) -> None:
    found = machines.doctor(ZENOH_CONFIG_OVERRIDE=f'connect/endpoints=["tcp/{THERE}:7447"]')
    (said,) = found["checks"]["reach"]["warnings"]
    assert f"no other machine has answered (whoever answers at tcp/{THERE}:7447)" in said


@pytest.fixture
def certified(tmp_path: Path) -> dict[str, str]:
    """The documentation's configurations with certificates: of the machine there, which listens, and of this one."""
    make_authority(tmp_path, "lab")
    found = {}
    for name, address, listens in (("there", THERE, "17447"), ("here", HERE, "0")):
        make_certificate(tmp_path, name, "lab", address)
        own = {f"{use}_certificate": str(tmp_path / f"{name}.pem") for use in ("listen", "connect")}
        own |= {f"{use}_private_key": str(tmp_path / f"{name}.key") for use in ("listen", "connect")}
        tls = {"enable_mtls": True, "root_ca_certificate": str(tmp_path / "lab.pem")} | own
        wished = {
            "listen": {"endpoints": [f"tls/0.0.0.0:{listens}"]},
            "connect": {"endpoints": [f"tls/{THERE}:17447"] if name == "here" else []},
            "scouting": {"multicast": {"enabled": False}},
            "transport": {"link": {"protocols": ["tls"], "tls": tls}},
        }
        path = tmp_path / f"{name}.json5"
        path.write_text(json.dumps(wished))
        found[name] = str(path)
    return found


@pytest.mark.skipif(not can_make(), reason="there is no `openssl` to make certificates")
def test_certified_machines_meet_with_one_file_each(machines: Machines, certified: dict[str, str]) -> None:
    for name in "ab":
        machines.start(machines.there, NODE, name, ZENOH_SESSION_CONFIG_URI=certified["there"])
        machines.start(machines.here, NODE, name.upper(), ZENOH_SESSION_CONFIG_URI=certified["here"])
    found = machines.doctor(ZENOH_SESSION_CONFIG_URI=certified["here"])
    assert nodes(found) == ["/A", "/B", "/a", "/b"]
    assert found["checks"]["certificates"]["level"] == "ok"
    assert found["checks"]["reach"]["summary"].endswith("linked to 2 sessions there")
