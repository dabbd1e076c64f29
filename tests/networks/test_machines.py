"""Two machines, in network namespaces, that one side's `--network HOST` joins where no multicast passes."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import main
from tests.support import stalls
from tests.support.machines import NODE, ROUTER, THERE, Machines, nodes
from tests.support.robot_and_laptop import ALL, PLAY

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]

ENCLAVES = ("robot", "router", "laptop")

POLICY = """
<policy version="0.2.0"><enclaves><enclave path="/laptop"><profiles><profile ns="/" node="laptop">
  <topics subscribe="ALLOW"><topic>map</topic><topic>/tf</topic><topic>/tf_static</topic></topics>
  <services request="ALLOW"><service>go</service><service>/robot/*</service></services>
  <actions call="ALLOW"><action>fibonacci</action></actions>
</profile></profiles></enclave></enclaves></policy>
"""


@pytest.fixture
def machines() -> Iterator[Machines]:
    with ExitStack() as stack:
        yield Machines(stack)


def used_by_laptop(machines: Machines, network: str, **environ: str) -> dict[str, Any]:
    """Return what a laptop here, which names the network, got from the robot there."""
    done = machines.run_here([sys.executable, "-c", PLAY, "laptop"], ROBOLINK_NETWORK=network, **environ)
    assert done.stderr == ""
    got: dict[str, Any] = json.loads(done.stdout)
    del got["seconds"]  # a figure for whoever runs it by hand
    return got


def nodes_once_seen(machines: Machines, expected: list[str], **environ: str) -> list[str]:
    """Return the nodes that `doctor` sees, at the latest in the moment when these are all: a link may take a while."""
    deadline = time.monotonic() + 60.0
    while (found := nodes(machines.doctor(**environ))) != expected and time.monotonic() < deadline:
        pass
    return found


def test_a_host_named_on_one_side_suffices(machines: Machines) -> None:
    """Services, parameters, actions, transforms and a latched map, from a robot of two processes on `lan`."""
    machines.start(machines.there, NODE, "first", ROBOLINK_NETWORK="lan")  # which holds the port
    machines.start(machines.there, PLAY, "robot", ROBOLINK_NETWORK="lan")
    assert used_by_laptop(machines, THERE) == ALL
    assert nodes_once_seen(machines, ["/first", "/robot"], ROBOLINK_NETWORK=THERE) == ["/first", "/robot"]


def test_the_same_by_a_router(machines: Machines) -> None:
    machines.command(machines.there, "router", "--listen", "lan")
    machines.start(machines.there, PLAY, "robot")
    assert used_by_laptop(machines, THERE) == ALL


@pytest.mark.parametrize("way", ["direct", "router"])
def test_the_same_with_keys(machines: Machines, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: str) -> None:
    """A keystore of `robolink security`: the laptop may use what the policy says, by its name with `tls/` before it."""
    keys = tmp_path / "keys"
    policy = tmp_path / "policy.xml"
    policy.write_text(POLICY)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(machines.domain))  # of which permissions are
    for words in (["create_keystore", str(keys)], *(["create_enclave", str(keys), f"/{each}"] for each in ENCLAVES)):
        assert main(["security", *words]) == 0
    assert main(["security", "create_permission", str(keys), "/laptop", str(policy)]) == 0

    def enclave(name: str) -> dict[str, str]:
        given = {"ENABLE": "true", "STRATEGY": "Enforce", "KEYSTORE": str(keys), "ENCLAVE_OVERRIDE": f"/{name}"}
        return {f"ROS_SECURITY_{variable}": value for variable, value in given.items()}

    if way == "router":
        machines.command(machines.there, "router", "--listen", "lan", **enclave("router"))
    own = "lan" if way == "direct" else "localhost"
    machines.start(machines.there, PLAY, "robot", ROBOLINK_NETWORK=own, **enclave("robot"))
    assert used_by_laptop(machines, f"tls/{THERE}", **enclave("laptop")) == ALL


def test_the_processes_here_meet_each_other_too(machines: Machines) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    for name in ("near", "nearer"):
        machines.start(machines.here, NODE, name, ROBOLINK_NETWORK=THERE)
    everybody = ["/far", "/near", "/nearer"]
    assert nodes_once_seen(machines, everybody, ROBOLINK_NETWORK=THERE) == everybody


def test_newcomers_find_the_others_when_the_first_process_has_ended(machines: Machines) -> None:
    """It has held the port, which is all that they know; another process has taken it then."""
    first = machines.start(machines.there, NODE, "first", ROBOLINK_NETWORK="lan")
    for name in ("second", "third"):
        machines.start(machines.there, NODE, name, ROBOLINK_NETWORK="lan")
    everybody = ["/first", "/second", "/third"]
    assert nodes_once_seen(machines, everybody, ROBOLINK_NETWORK=THERE) == everybody
    first.kill()
    assert nodes_once_seen(machines, everybody[1:], ROBOLINK_NETWORK=THERE) == everybody[1:]


def test_a_router_on_the_robot_opens_the_way_to_local_nodes(machines: Machines) -> None:
    machines.start(machines.there, ROUTER)
    machines.start(machines.there, NODE, "local")
    found = machines.doctor(ROBOLINK_NETWORK=THERE)
    assert (nodes(found), found["checks"]["reach"]["level"]) == (["/local"], "ok")


def test_a_name_of_the_file_of_networks(machines: Machines, tmp_path_factory: pytest.TempPathFactory) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    folder = tmp_path_factory.mktemp("workspace")
    (folder / "networks.yaml").write_text(f"robot: {THERE}\npeers: {{peers: [{THERE}]}}\n")
    for name in ("robot", "peers"):
        assert nodes_once_seen(machines, ["/far"], ROBOLINK_NETWORK=name, ROBOLINK_WORKSPACE=str(folder)) == ["/far"]


def test_nobody_answers(machines: Machines) -> None:
    machines.start(machines.there, NODE, "local")  # whom nobody reaches
    done = machines.run_here([sys.executable, "-m", "robolink", "--network", THERE, "topic", "list"])
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"robolink: --network: nobody answers at {THERE}, no robolink process (port ")
    assert done.stderr.count("\n") == 1


def test_a_launch_joins_its_files_network_once(machines: Machines, tmp_path_factory: pytest.TempPathFactory) -> None:
    machines.start(machines.there, NODE, "far", ROBOLINK_NETWORK="lan")
    folder = tmp_path_factory.mktemp("workspace")
    (folder / "look.yaml").write_text(f"network: {THERE}\nnodes: [run: [robolink, node, list]]\n")
    done = machines.run_here([sys.executable, "-m", "robolink", "launch", os.fspath(folder / "look.yaml")])
    assert "/far" in done.stdout + done.stderr
    (folder / "look.yaml").write_text("network: 10.78.0.1:9\nnodes: [run: [robolink, node, list]]\n")
    done = machines.run_here([sys.executable, "-m", "robolink", "launch", os.fspath(folder / "look.yaml")])
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert "network, in the launch file: nobody answers at 10.78.0.1, port 9" in done.stderr


def test_our_router_opens_the_way_to_local_nodes(machines: Machines) -> None:
    machines.command(machines.there, "router", "--listen", "lan")
    machines.start(machines.there, NODE, "local")
    assert nodes_once_seen(machines, ["/local"], ROBOLINK_NETWORK=THERE) == ["/local"]


def test_two_routers_join_two_machines_whose_nodes_stay_local(machines: Machines) -> None:
    machines.command(machines.there, "router", "--listen", "lan")
    machines.start(machines.there, NODE, "far")
    machines.command(machines.here, "router", "--connect", THERE)
    machines.start(machines.here, NODE, "near")
    assert nodes_once_seen(machines, ["/far", "/near"]) == ["/far", "/near"]
