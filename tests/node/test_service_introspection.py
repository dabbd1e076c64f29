"""Service introspection: what is told on SERVICE/_service_event of whom, when, and what `service echo` shows of it."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from robolink import Context, Node
from robolink.cli.main import main
from robolink.cli.service import verbs
from robolink.client import Client
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.qos import qos_profile_services_default, qos_profile_system_default
from robolink.service import Service
from robolink.service_introspection import ServiceIntrospectionState
from tests.support.seen_by_commands import a_node_that_commands_see, made, press_ctrl_c, when_said
from tests.support.spins import done, spin_for, spin_until

Captured = pytest.CaptureFixture[str]
SENT, RECEIVED = ServiceEventInfo.REQUEST_SENT, ServiceEventInfo.REQUEST_RECEIVED
ANSWERED, GOT = ServiceEventInfo.RESPONSE_SENT, ServiceEventInfo.RESPONSE_RECEIVED
OFF, METADATA, CONTENTS = ServiceIntrospectionState


def answer(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success, response.message = True, f"was {request.data}"
    return response


class Arm:
    """A service /arm, a client of it, and what a third node hears of their talk."""

    def __init__(self, context: Context, executor: SingleThreadedExecutor) -> None:
        self.executor = executor
        server, asker, listener = (Node(name, context=context) for name in ("server", "asker", "listener"))
        self.service: Service = server.create_service(SetBool, "arm", answer)
        self.client: Client = asker.create_client(SetBool, "arm")
        self.clock = server.get_clock()
        self.events: list[Any] = []
        self.listener = listener  # else it ends with the executor that has it
        listener.create_subscription(SetBool.Event, "/arm/_service_event", self.events.append, 10)
        for node in (server, asker, listener):
            executor.add_node(node)

    def introspect(self, end: Client | Service, state: ServiceIntrospectionState) -> None:
        end.configure_introspection(self.clock, qos_profile_system_default, state)

    def call(self) -> list[Any]:
        """Call it once; what is heard of that."""
        self.events.clear()
        done(self.executor, self.client.call_async(SetBool.Request(data=True)))
        spin_for(self.executor, 0.1)
        return list(self.events)


@pytest.fixture
def arm(virtual: Context, executor: SingleThreadedExecutor) -> Arm:
    return Arm(virtual, executor)


def kinds(events: list[Any]) -> list[int]:
    return [each.info.event_type for each in events]


def test_nothing_is_told_until_it_is_asked_for(arm: Arm) -> None:
    assert arm.call() == []
    assert arm.service.introspection is arm.client.introspection is None


def test_each_end_tells_of_what_it_sends_and_receives(arm: Arm) -> None:
    arm.introspect(arm.service, METADATA)
    assert kinds(arm.call()) == [RECEIVED, ANSWERED]
    arm.introspect(arm.client, METADATA)
    assert kinds(arm.call()) == [SENT, RECEIVED, ANSWERED, GOT]
    arm.introspect(arm.service, OFF)
    assert kinds(arm.call()) == [SENT, GOT]
    arm.introspect(arm.client, OFF)
    arm.introspect(arm.client, OFF)
    assert arm.call() == []


def test_all_events_of_a_call_name_it_and_have_the_clocks_stamp(arm: Arm) -> None:
    arm.introspect(arm.service, METADATA)
    arm.introspect(arm.client, METADATA)
    spin_for(arm.executor, 3.0)
    first, second = arm.call(), arm.call()
    for events in (first, second):
        assert len({(bytes(each.info.client_gid), each.info.sequence_number) for each in events}) == 1
        assert [(each.request, each.response) for each in events] == [([], [])] * 4
    assert {each.info.stamp.sec for each in first} == {3}
    assert bytes(first[0].info.client_gid) == arm.client._endpoint.gid
    assert second[0].info.sequence_number == first[0].info.sequence_number + 1


def test_contents_are_told_where_they_are_asked_for(arm: Arm) -> None:
    arm.introspect(arm.service, METADATA)
    arm.introspect(arm.client, CONTENTS)
    events = arm.call()
    request, response = SetBool.Request(data=True), SetBool.Response(success=True, message="was True")
    assert [(each.info.event_type, each.request, each.response) for each in events] == [
        (SENT, [request], []),
        (RECEIVED, [], []),
        (ANSWERED, [], []),
        (GOT, [], [response]),
    ]
    arm.introspect(arm.client, METADATA)
    assert [each.request for each in arm.call()] == [[], [], [], []]


def test_a_blocking_call_is_told_too(context: Context) -> None:
    executor = SingleThreadedExecutor(context=context)
    arm = Arm(context, executor)
    arm.introspect(arm.client, METADATA)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    try:
        assert arm.client.call(SetBool.Request(data=False), timeout_sec=30.0).message == "was False"
    finally:
        executor.shutdown()
        thread.join()
    rest = SingleThreadedExecutor(context=context)
    for node in list(context._nodes.values()):
        rest.add_node(node)
    spin_until(rest, lambda: len(arm.events) >= 2)
    assert kinds(arm.events) == [SENT, GOT]


def test_whoever_is_destroyed_tells_no_more(arm: Arm, virtual: Context) -> None:
    listener = Node("other", context=virtual)
    arm.introspect(arm.service, METADATA)
    arm.introspect(arm.client, METADATA)
    assert listener.count_publishers("/arm/_service_event") == 2
    arm.service.destroy()
    arm.client.destroy()
    assert listener.count_publishers("/arm/_service_event") == 0


def test_what_is_no_state_is_refused(arm: Arm) -> None:
    for end in (arm.service, arm.client):
        with pytest.raises(TypeError, match="introspection_state: expected a ServiceIntrospectionState, got 1"):
            arm.introspect(end, 1)  # type: ignore[arg-type]


# --- service echo ---------------------------------------------------------------------------------------------


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


class Talk:
    """The service /lab/arm of a node, which tells of everything, and a client of it."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.service = node.create_service(SetBool, "arm", answer)
        self.introspect(CONTENTS)
        self.client = made(node.context, "asker").create_client(SetBool, "/lab/arm")
        self.executor = SingleThreadedExecutor(context=node.context)
        self.executor.add_node(node)

    def introspect(self, state: ServiceIntrospectionState) -> None:
        self.service.configure_introspection(self.node.get_clock(), qos_profile_services_default, state)

    def call(self) -> None:
        self.client.call_async(SetBool.Request(data=True))
        for _ in range(2):  # the request, and what the asker does not take
            self.executor.spin_once(timeout_sec=0.05)


@pytest.fixture
def talk(node: Node, monkeypatch: pytest.MonkeyPatch) -> Talk:
    """It begins once the command listens."""
    talk = Talk(node)
    original = SingleThreadedExecutor.add_node

    def add_node(executor: SingleThreadedExecutor, added: Node) -> bool:
        found = original(executor, added)
        if added.get_name().startswith("_robolink_cli"):
            talk.call()
        return found

    monkeypatch.setattr(SingleThreadedExecutor, "add_node", add_node)
    return talk


@pytest.mark.usefixtures("talk")
def test_an_event_is_shown_as_ros2_does(capsys: Captured) -> None:
    assert main(["service", "echo", "/lab/arm", "--once"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:3] == ["info:", "  event_type: REQUEST_RECEIVED", "  stamp:"]
    assert lines[5] == "  client_gid:"
    assert len([each for each in lines if each.startswith("  - ")]) == 16
    assert lines[-5:] == ["  sequence_number: 1", "request:", "- data: true", "response: []", "---"]


@pytest.mark.parametrize(
    ("flags", "begin", "end"),
    [
        (["--csv"], "1,", ",1,True,\n"),
        (["--flow-style"], "info:\n  event_type: REQUEST_RECEIVED\n", "request: [{data: true}]\nresponse: []\n---\n"),
        (
            ["SetBool", "--no-arr"],
            "info:\n  event_type: REQUEST_RECEIVED\n",
            "response: '<sequence type: std_srvs/srv/SetBool_Response[1], length: 0>'\n---\n",
        ),
    ],
)
@pytest.mark.usefixtures("talk")
def test_other_ways_to_show_it(flags: list[str], begin: str, end: str, capsys: Captured) -> None:
    assert main(["service", "echo", "/lab/arm", "--once", *flags]) == 0
    out = capsys.readouterr().out
    assert (out[: len(begin)], out[-len(end) :]) == (begin, end)


@pytest.mark.usefixtures("talk")
def test_events_as_json(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[str] = []

    def second(text: str) -> None:
        lines.append(text)
        if len(lines) == 2:
            press_ctrl_c(text)

    when_said(monkeypatch, verbs, "say", second)
    assert main(["service", "echo", "/lab/arm", "--json"]) == 130
    assert [json.loads(each)["info"]["event_type"] for each in lines] == ["REQUEST_RECEIVED", "RESPONSE_SENT"]
    assert json.loads(lines[1])["response"] == [{"success": True, "message": "was True"}]


def test_who_tells_nothing_is_asked_whether_introspection_is_on(
    talk: Talk, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    talk.introspect(OFF)
    when_said(monkeypatch, verbs, "tell", press_ctrl_c)
    assert main(["service", "echo", "/lab/arm"]) == 130
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(
        "No publishers on topic '/lab/arm/_service_event'; is service introspection on the client or server enabled?"
    )


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["/lab/amr"], 1, "no service named '/lab/amr' in domain 7 (did you mean '/lab/arm'?)"),
        (["/lab/arm", "SetBol"], 1, "no service type named 'SetBol' (did you mean 'SetBool'?)"),
        (
            ["/lab/arm", "--csv", "--json"],
            2,
            "--csv and --json do not go together (see 'robolink service echo --help')",
        ),
    ],
)
@pytest.mark.usefixtures("talk")
def test_what_cannot_be_is_one_line(words: list[str], code: int, said: str, capsys: Captured) -> None:
    assert main(["service", "echo", *words]) == code
    assert capsys.readouterr() == ("", f"robolink: {said}\n")
