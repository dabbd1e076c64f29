"""service list, type, find and info: ros2's output, and what is not there."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest

from robolink import Node
from robolink.cli.main import main
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.message import type_hash
from robolink.wire import EndpointKind
from tests.support.seen_by_commands import a_node_that_commands_see

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


def echo(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success, response.message = True, f"was {request.data}"
    return response


@pytest.fixture
def busy(node: Node) -> Node:
    node.create_service(SetBool, "arm", echo)
    node.create_service(Trigger, "/reset", echo)
    node.create_service(Trigger, "/_quiet", echo)
    node.create_client(Trigger, "/elsewhere")
    node.create_client(Trigger, "/reset")
    return node


OWN = "/lab/robot/get_type_description"

LISTED = ["/elsewhere", "/lab/arm", OWN, "/reset"]


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        ([], LISTED),
        (["--include-hidden-services"], ["/_quiet", *LISTED]),
        (["-c"], ["4"]),
        (["--count-services", "--include-hidden-services"], ["5"]),
    ],
)
@pytest.mark.usefixtures("busy")
def test_services_are_listed_by_name(options: list[str], shown: list[str], capsys: Captured) -> None:
    assert main(["service", "list", *options]) == 0
    assert capsys.readouterr() == ("".join(f"{each}\n" for each in shown), "")


@pytest.mark.usefixtures("busy")
def test_types_are_listed_as_ros2_lists_them(capsys: Captured) -> None:
    assert main(["service", "list", "-t"]) == 0
    assert "/lab/arm [std_srvs/srv/SetBool]\n" in capsys.readouterr().out
    assert main(["service", "list", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["/reset"] == ["std_srvs/srv/Trigger"]


@pytest.mark.parametrize("name", ["/lab/arm", "lab/arm"])
@pytest.mark.usefixtures("busy")
def test_the_type_of_a_service(name: str, capsys: Captured) -> None:
    assert main(["service", "type", name]) == 0
    assert capsys.readouterr() == ("std_srvs/srv/SetBool\n", "")


@pytest.mark.parametrize("type_", ["Trigger", "std_srvs/Trigger", "std_srvs/srv/Trigger", "std_srvs.srv.Trigger"])
@pytest.mark.usefixtures("busy")
def test_services_are_found_by_their_type(type_: str, capsys: Captured) -> None:
    assert main(["service", "find", type_]) == 0
    assert capsys.readouterr() == ("/elsewhere\n/reset\n", "")
    assert main(["service", "find", type_, "-c", "--include-hidden-services"]) == 0
    assert capsys.readouterr() == ("3\n", "")


@pytest.mark.usefixtures("busy")
def test_nothing_is_found_of_a_type_that_nobody_uses(capsys: Captured) -> None:
    assert [main(["service", "find", each]) for each in ("nav_msgs/srv/GetMap", "", "*", "x" * 100_000)] == [0] * 4
    assert capsys.readouterr() == ("", "")
    assert main(["service", "find", "Nothing", "--json"]) == 0
    assert capsys.readouterr() == ("[]\n", "")


@pytest.mark.usefixtures("busy")
def test_info_counts_both_sides(capsys: Captured) -> None:
    assert main(["service", "info", "reset"]) == 0
    assert capsys.readouterr() == ("Type: std_srvs/srv/Trigger\nClients count: 1\nServices count: 1\n", "")


@pytest.mark.usefixtures("busy")
def test_info_shows_who_serves_and_calls(capsys: Captured) -> None:
    assert main(["service", "info", "-v", "/reset"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:4] == ["Type: std_srvs/srv/Trigger", "Clients count: 1", "", "Node name: robot"]
    assert f"Service type hash: {type_hash(Trigger)}" in lines
    assert [each for each in lines if "Endpoint type" in each] == ["Endpoint type: CLIENT", "Endpoint type: SERVER"]
    assert lines.count("Endpoint count: 1") == 2
    assert lines[-9:-7] == ["QoS profile:", "  Reliability: RELIABLE"]


def test_info_as_json_has_the_gids_of_the_wire(busy: Node, capsys: Captured) -> None:
    assert main(["service", "info", "/reset", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    ((gid, _),) = busy.context.graph.gids(EndpointKind.SERVICE, "/reset")
    assert told["servers"] == [
        {
            "node": "/lab/robot",
            "type": "std_srvs/srv/Trigger",
            "hash": type_hash(Trigger),
            "gid": ".".join(f"{each:02x}" for each in gid),
        }
    ]
    assert (told["types"], len(told["clients"])) == (["std_srvs/srv/Trigger"], 1)


@pytest.mark.parametrize("verb", ["type", "info"])
@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/resett", "no service named '/resett' in domain 7 (did you mean '/reset'?)"),
        ("../..", "no service named '/../..' in domain 7"),
        ("a\0b\n", r"no service named '/a\x00b\n' in domain 7"),
    ],
)
@pytest.mark.usefixtures("busy")
def test_an_unknown_service_is_one_line(verb: str, name: str, said: str, capsys: Captured) -> None:
    assert main(["service", verb, name]) == 1
    assert capsys.readouterr() == ("", f"robolink: {said}\n")
