"""action echo: the parts of an action as ros2 prints them, and options that are wrong."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from robolink import Node
from robolink.action import ActionClient, ActionServer
from robolink.cli.action import echo
from robolink.cli.main import main
from robolink.graph.action_names import part_name
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.qos import qos_profile_services_default
from robolink.service_introspection import ServiceIntrospectionState
from robolink.wire import EndpointKind
from tests.support.busy_actions import Sums
from tests.support.seen_by_commands import press_ctrl_c, spinning, when_said

Captured = pytest.CaptureFixture[str]
NAME = "/lab/sums"
PARTS = {
    "GOAL_SERVICE": "send_goal/_service_event",
    "CANCEL_SERVICE": "cancel_goal/_service_event",
    "RESULT_SERVICE": "get_result/_service_event",
    "FEEDBACK_TOPIC": "feedback",
    "STATUS_TOPIC": "status",
}


@pytest.fixture
def sending(request: pytest.FixtureRequest, node: Node, sums: Sums) -> Iterator[None]:
    """A goal is sent to /lab/sums, whose introspection is enabled, as soon as the command listens to all it shows."""
    server = ActionServer(node, Fibonacci, "sums", sums)
    server.configure_introspection(node.get_clock(), qos_profile_services_default, ServiceIntrospectionState.CONTENTS)
    client = ActionClient(node, Fibonacci, "sums")
    callspec = getattr(request.node, "callspec", None)
    topics = [part_name(NAME, PARTS[each]) for each in ([callspec.params["interface"].upper()] if callspec else PARTS)]

    def heard() -> list[int]:
        return [len(node.context.graph.endpoints(EndpointKind.SUBSCRIPTION, name=each)) for each in topics]

    before = heard()

    def is_heard() -> bool:
        return all(there > one for there, one in zip(heard(), before, strict=True))

    def send() -> None:
        if node.context.graph.wait_for(is_heard, 10.0):
            client.send_goal_async(Fibonacci.Goal(order=3))

    thread = threading.Thread(target=send)
    with spinning(node, threads=4):
        thread.start()
        yield
        thread.join()


@pytest.mark.parametrize(
    ("interface", "shown"),
    [
        ("feedback_topic", "interface: FEEDBACK_TOPIC\ngoal_id:\n  uuid:\n"),
        ("STATUS_TOPIC", "interface: STATUS_TOPIC\nstatus_list:\n- goal_info:\n"),
        ("GOAL_SERVICE", "interface: GOAL_SERVICE\ninfo:\n  event_type: REQUEST_RECEIVED\n"),
    ],
)
@pytest.mark.usefixtures("sending")
def test_a_part_is_shown_as_ros2_shows_it(
    interface: str, shown: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    when_said(monkeypatch, echo, "say", press_ctrl_c)
    assert main(["action", "echo", NAME, "-i", interface]) == 130
    out, err = capsys.readouterr()
    assert err == ""
    assert out.startswith(shown)
    assert out.endswith("\n---\n")


@pytest.mark.usefixtures("sending")
def test_all_parts_are_shown_by_default_also_as_csv(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    seen: set[str] = set()

    def on_said(said: str) -> None:
        seen.add(said.splitlines()[0])
        if len(seen) == 3:
            press_ctrl_c(said)

    when_said(monkeypatch, echo, "say", on_said)
    assert main(["action", "echo", NAME, "Fibonacci", "--csv"]) == 130
    assert seen == {f"interface: {each}" for each in ("GOAL_SERVICE", "FEEDBACK_TOPIC", "STATUS_TOPIC")}
    assert "---" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "code", "report"),
    [
        ([NAME, "-i", "GOALS"], 2, "--interfaces: expected GOAL_SERVICE, "),
        ([NAME, "-i", ""], 2, "--interfaces: expected GOAL_SERVICE, "),
        ([NAME, "Fibonaci"], 1, "Fibonaci"),
        (["/nobodys"], 1, "/nobodys"),
    ],
)
@pytest.mark.usefixtures("node")
def test_what_cannot_be_shown_is_told(words: list[str], code: int, report: str, capsys: Captured) -> None:
    assert main(["action", "echo", *words]) == code
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert report in err
