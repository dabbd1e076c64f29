"""node list and node info: ros2's output, twins, actions by their parts, and announcements that cannot be read."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli.main import main
from robolink.cli.shared import session
from robolink.cli.shared.graph import sections_of
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.qos import QoSProfile
from robolink.transport import Handle
from robolink.transport.memory import MemoryTransport
from robolink.wire import NO_HASH, BridgeToken, EndpointKind, EndpointToken, NodeToken, format_bridge, format_token
from tests.support.seen_by_commands import a_node_that_commands_see

Captured = pytest.CaptureFixture[str]
Announce = Callable[..., None]

ROBOT = """\
/lab/robot
  Subscribers:
    /lab/scan: sensor_msgs/msg/LaserScan
  Publishers:
    /parameter_events: rcl_interfaces/msg/ParameterEvent
  Service Servers:
    /lab/reset: std_srvs/srv/Trigger
    /lab/robot/get_type_description: type_description_interfaces/srv/GetTypeDescription
  Service Clients:
    /arm: std_srvs/srv/SetBool
  Action Servers:

  Action Clients:

"""

FIB = "example_interfaces/action/Fibonacci"
ACTION_SERVICES = {
    "send_goal": f"{FIB}_SendGoal",
    "get_result": f"{FIB}_GetResult",
    "cancel_goal": "action_msgs/srv/CancelGoal",
}
ACTION_TOPICS = {"feedback": f"{FIB}_FeedbackMessage", "status": "action_msgs/msg/GoalStatusArray"}
PARTS = {**ACTION_SERVICES, **ACTION_TOPICS}


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.fixture
def announce(node: Node) -> Iterator[Announce]:
    """Announce a node of another session, with endpoints given as (kind, name, type)."""
    handles: list[Handle] = []
    sessions = itertools.count(0xABC)

    def announce(namespace: str, name: str, *ends: tuple[EndpointKind, str, str]) -> None:
        session = f"{next(sessions):x}"
        texts = [format_token(NodeToken(7, session, "0", "/", namespace, name))]
        for number, (kind, topic, type_name) in enumerate(ends, 1):
            texts.append(format_token(end(kind, topic, type_name, (session, number, namespace, name))))
        handles.extend(node.context.transport.announce(each) for each in texts)

    yield announce
    for handle in handles:
        handle.close()


def end(
    kind: EndpointKind, topic: str, type_name: str, owner: tuple[str, int, str, str] = ("abc", 1, "/", "x")
) -> EndpointToken:
    session, number, namespace, name = owner
    return EndpointToken(
        7, session, "0", str(number), kind, "/", namespace, name, topic, type_name, NO_HASH, QoSProfile(depth=10)
    )


def action_parts(action: str, *, server: bool, without: str = "") -> list[tuple[EndpointKind, str, str]]:
    services = EndpointKind.SERVICE if server else EndpointKind.CLIENT
    topics = EndpointKind.PUBLISHER if server else EndpointKind.SUBSCRIPTION
    return [
        (services if part in ACTION_SERVICES else topics, f"{action}/_action/{part}", type_name)
        for part, type_name in PARTS.items()
        if part != without
    ]


def busy(node: Node) -> None:
    node.create_subscription(LaserScan, "scan", print, 10)
    node.create_publisher(LaserScan, "_raw", 10)
    node.create_service(Trigger, "reset", lambda request, response: response)
    node.create_client(SetBool, "/arm")


# --- node list ------------------------------------------------------------------------------------------------


def test_only_the_nodes_own_name_hides_it(announce: Announce, capsys: Captured) -> None:
    announce("/_cell", "arm")
    announce("/", "_quiet")
    assert main(["node", "list"]) == 0
    assert capsys.readouterr() == ("/_cell/arm\n/lab/robot\n", "")


def test_nodes_of_one_name_are_listed_each_with_a_warning(announce: Announce, capsys: Captured) -> None:
    announce("/lab", "robot")
    assert main(["node", "list"]) == 0
    warning = "WARNING: several nodes have the exact same name: /lab/robot (2 times)\n"
    assert capsys.readouterr() == ("/lab/robot\n/lab/robot\n", warning)
    assert main(["node", "list", "-c"]) == 0
    assert capsys.readouterr() == ("2\n", "")


@pytest.mark.parametrize(
    ("texts", "said"),
    [
        (["@ros2_lv/7/nonsense"], "robolink: 1 announcement could not be read\n"),
        (
            ["@ros2_lv/7/a/0/0/NN", "@ros2_lv/7/zz" * 5000, "@ros2_lv/7/abc/0/0/NN/%/%/a%00b\0"],
            "robolink: 3 announcements could not be read\n",
        ),
    ],
)
def test_announcements_that_cannot_be_read_are_counted(
    texts: list[str], said: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    stranger = MemoryTransport("strangers")
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://strangers")
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    for text in [*texts, format_token(NodeToken(7, "abc", "0", "/", "/", "good"))]:
        stranger.announce(text)
    assert main(["node", "list"]) == 0
    assert capsys.readouterr() == ("/good\n", said)
    stranger.close()


# --- node info ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["/lab/robot", "lab/robot"])
def test_info_has_ros2s_six_sections(node: Node, name: str, capsys: Captured) -> None:
    busy(node)
    assert main(["node", "info", name]) == 0
    assert capsys.readouterr() == (ROBOT, "")


def test_hidden_names_are_shown_when_wanted(node: Node, capsys: Captured) -> None:
    busy(node)
    assert main(["node", "info", "/lab/robot", "--include-hidden"]) == 0
    assert "    /lab/_raw: sensor_msgs/msg/LaserScan\n" in capsys.readouterr().out


def test_info_as_json(node: Node, capsys: Captured) -> None:
    busy(node)
    assert main(["node", "info", "/lab/robot", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["name"] == "/lab/robot"
    assert told["subscribers"] == {"/lab/scan": ["sensor_msgs/msg/LaserScan"]}
    assert told["service_clients"] == {"/arm": ["std_srvs/srv/SetBool"]}
    assert (told["action_servers"], told["count"]) == ({}, 1)


def test_an_action_is_one_line_and_its_parts_are_hidden(announce: Announce, capsys: Captured) -> None:
    announce("/", "fib", *action_parts("/fibonacci", server=True), *action_parts("/arm/move", server=False))
    assert main(["node", "info", "/fib"]) == 0
    assert capsys.readouterr().out == (
        "/fib\n  Subscribers:\n\n  Publishers:\n\n  Service Servers:\n\n  Service Clients:\n\n"
        f"  Action Servers:\n    /fibonacci: {FIB}\n  Action Clients:\n    /arm/move: {FIB}\n"
    )
    assert main(["node", "info", "/fib", "--include-hidden"]) == 0
    assert f"    /fibonacci/_action/send_goal: {FIB}_SendGoal\n" in capsys.readouterr().out


@pytest.mark.parametrize("missing", PARTS)
@pytest.mark.parametrize("server", [True, False])
def test_who_only_has_some_parts_has_no_action(missing: str, server: bool) -> None:
    parts = [end(*each) for each in action_parts("/f", server=server, without=missing)]
    assert dict(sections_of(parts, hidden=True))["Action Servers" if server else "Action Clients"] == []


def test_parts_of_two_sides_are_no_action() -> None:
    mixed = action_parts("/f", server=True)[:3] + action_parts("/f", server=False)[3:]
    sections = dict(sections_of([end(*each) for each in mixed], hidden=True))
    assert (sections["Action Servers"], sections["Action Clients"]) == ([], [])


def test_twins_are_shown_together_with_a_warning(node: Node, announce: Announce, capsys: Captured) -> None:
    busy(node)
    announce("/lab", "robot", (EndpointKind.CLIENT, "/spin", "std_srvs/srv/Trigger"))
    assert main(["node", "info", "/lab/robot"]) == 0
    out, err = capsys.readouterr()
    assert "    /arm: std_srvs/srv/SetBool\n    /spin: std_srvs/srv/Trigger\n" in out
    assert err == "2 nodes are named /lab/robot: this is what they do together\n"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/lab/robt", "no node named '/lab/robt' in domain 7 (did you mean '/lab/robot'?)"),
        ("zzz", "no node named '/zzz' in domain 7"),
        ("//", "no node named '//' in domain 7"),
        ("../..", "no node named '/../..' in domain 7"),
        ("*", "no node named '/*' in domain 7"),
        ("a\nb\x1b[2J", r"no node named '/a\nb\x1b[2J' in domain 7"),
        ("", "no node named '/' in domain 7"),
    ],
)
@pytest.mark.usefixtures("node")
def test_an_unknown_node_is_one_line(name: str, said: str, capsys: Captured) -> None:
    assert main(["node", "info", name]) == 1
    assert capsys.readouterr() == ("", f"robolink: {said}\n")


@pytest.mark.usefixtures("node")
def test_a_megabyte_of_a_name_is_not_repeated(capsys: Captured) -> None:
    assert main(["node", "info", "/x" * 500_000]) == 1
    assert len(capsys.readouterr().err) < 400


ENDS = st.builds(
    end,
    st.sampled_from(EndpointKind),
    st.sampled_from(["/f/_action/", "/_action/", "/a/_action/_action/", "/"]).flatmap(
        lambda prefix: st.sampled_from([*PARTS, "feedback/x", "x"]).map(lambda part: prefix + part)
    ),
    st.sampled_from(list(PARTS.values())),
)


@given(st.lists(ENDS, max_size=20), st.booleans())
def test_whatever_is_announced_can_be_sorted_into_sections(ends: list[EndpointToken], hidden: bool) -> None:
    sections = sections_of(ends, hidden)
    assert [title for title, _ in sections][:2] == ["Subscribers", "Publishers"]
    assert all(types or "Action" in title for title, listed in sections for _, types in listed)


def test_info_says_that_a_node_is_behind_a_bridge(node: Node, announce: Announce, capsys: Captured) -> None:
    announce("/", "base", (EndpointKind.PUBLISHER, "/odom", "nav_msgs/msg/Odometry"))
    node.context.transport.announce(format_bridge(BridgeToken(7, "abc", "dds", "turtle")))
    assert main(["node", "info", "/base"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:3] == ["/base", "  Network: DDS, through the bridge on turtle", "  Subscribers:"]
    assert main(["node", "info", "/base", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["bridge"] == {"network": "dds", "host": "turtle"}
    assert main(["node", "info", "/lab/robot"]) == 0
    assert "Network" not in capsys.readouterr().out


def test_a_process_that_goes_on_keeps_no_session_of_a_look(node: Node) -> None:
    before = node.context.transport.tokens("@ros2_lv/7/**")
    assert [main(["node", "list"]), main(["node", "info", "/nobody"])] == [0, 1]
    assert not session.any_looks()
    assert node.context.transport.tokens("@ros2_lv/7/**") == before


# --- the graph --------------------------------------------------------------------------------------------------


def test_the_graph_of_what_runs_is_drawn(node: Node, capsys: Captured) -> None:
    node.create_publisher(LaserScan, "scan", 10)
    node.create_subscription(LaserScan, "scan", lambda message: None, 10)
    node.create_service(Trigger, "reset", lambda request, response: response)
    node.create_client(Trigger, "reset")
    assert main(["node", "graph"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "flowchart LR",
        '    n0["/lab/robot"]',
        '    p0{{"/lab/reset<br/>std_srvs/srv/Trigger"}}',
        '    p1(["/lab/scan<br/>sensor_msgs/msg/LaserScan"])',
        "    p0 -.-> n0",
        "    n0 -.-> p0",
        "    p1 --> n0",
        "    n0 --> p1",
    ]


def test_the_graph_is_for_graphviz_too(node: Node, capsys: Captured) -> None:
    node.create_publisher(LaserScan, "scan", 10)
    assert main(["node", "graph", "--format", "dot"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("digraph system {")
    assert '"node /lab/robot" -> "topic /lab/scan sensor_msgs/msg/LaserScan";' in out


def test_a_hidden_node_is_drawn_on_demand(node: Node, capsys: Captured) -> None:
    Node("_quiet", context=node.context, enable_rosout=False, start_parameter_services=False)
    assert main(["node", "graph"]) == 0
    assert "_quiet" not in capsys.readouterr().out
    assert main(["node", "graph", "--include-hidden"]) == 0
    assert '["/_quiet"]' in capsys.readouterr().out


def test_another_format_is_refused(capsys: Captured) -> None:
    assert main(["node", "graph", "--format", "dott"]) == 2
    assert "'dott' is none of mermaid, dot (did you mean 'dot'?)" in capsys.readouterr().err
