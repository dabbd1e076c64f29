"""action list, type, find, info and send_goal: ros2's output, Ctrl-C, why nobody answers, and completion."""

from __future__ import annotations

import io
import json
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from robolink import Context, Node
from robolink.action import ActionServer, CancelResponse
from robolink.action.server import ServerGoalHandle
from robolink.cli.action import action_names, type_of_action, verbs
from robolink.cli.main import main
from robolink.cli.shared import complete
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.busy_actions import POLISH, TYPE, Polish, Sums
from tests.support.commands import BUSY_ROBOLINK, Command
from tests.support.programs import Program
from tests.support.seen_by_commands import made, press_ctrl_c, spinning, when_said

Captured = pytest.CaptureFixture[str]

PATIENCE = 30.0
WAITING = "Waiting for an action server to become available...\n"
SENDING = "Sending goal:\n     order: 3\n\n"
ID = "Goal accepted with ID: " + "07" * 16 + "\n\n"
FEEDBACK = "Feedback:\n    sequence:\n- 0\n- 1\n\n"
RESULT = "Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\nGoal finished with status: SUCCEEDED\n"


@pytest.fixture
def served(node: Node, sums: Sums, monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """The node /lab/robot serves /lab/sums; goals have the id 0707..."""
    monkeypatch.setattr("uuid.uuid4", lambda: SimpleNamespace(bytes=b"\7" * 16))
    ActionServer(node, Fibonacci, "sums", sums, goal_callback=sums.accept, cancel_callback=sums.cancel)
    with spinning(node, threads=4):
        yield node
        sums.canceled.set()


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reasons are given at once."""
    monkeypatch.setattr(verbs, "PATIENCE", 0.01)
    monkeypatch.setattr(verbs, "_SLICE", 0.01)


# --- send_goal ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("words", [["Fibonacci", "{order: 3}"], [TYPE, "order: 3"], ["{order: 3}"]])
@pytest.mark.usefixtures("served")
def test_a_goal_is_sent_and_shown_as_ros2_does(words: list[str], capsys: Captured) -> None:
    assert main(["action", "send_goal", "/lab/sums", *words]) == 0
    assert capsys.readouterr() == (WAITING + SENDING + ID + RESULT, "")


@pytest.mark.usefixtures("served")
def test_feedback_is_shown_if_asked_for(capsys: Captured) -> None:
    assert main(["action", "send_goal", "lab/sums", "{order: 3}", "-f"]) == 0
    out = capsys.readouterr().out
    assert out.replace(FEEDBACK, "") == WAITING + SENDING + ID + RESULT
    assert out.count(FEEDBACK) == 1


@pytest.mark.usefixtures("served")
def test_a_goal_comes_from_standard_input(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("order: 3\n"))
    assert main(["action", "send_goal", "/lab/sums", "--stdin"]) == 0
    assert SENDING in capsys.readouterr().out


@pytest.mark.usefixtures("served")
def test_programs_read_a_line_for_each_thing(capsys: Captured) -> None:
    assert main(["action", "send_goal", "/lab/sums", "{order: 3}", "-f", "--json"]) == 0
    lines = [json.loads(each) for each in capsys.readouterr().out.splitlines()]
    assert {"feedback": {"sequence": [0, 1]}} in lines
    assert [each for each in lines if "feedback" not in each] == [
        {"goal_id": "07" * 16, "accepted": True},
        {"status": "SUCCEEDED", "result": {"sequence": [0, 1, 1, 2]}},
    ]


@pytest.mark.parametrize(("order", "end"), [(10, "Goal was rejected.\n"), (0, "Goal finished with status: ABORTED\n")])
@pytest.mark.usefixtures("served")
def test_a_goal_that_does_not_succeed_is_exit_code_1(order: int, end: str, capsys: Captured) -> None:
    assert main(["action", "send_goal", "/lab/sums", f"order: {order}"]) == 1
    out, err = capsys.readouterr()
    assert out.endswith(end)
    assert err == ""


@pytest.mark.usefixtures("served")
def test_ctrl_c_cancels_the_goal(sums: Sums, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    when_said(monkeypatch, verbs, "say", lambda text: press_ctrl_c(text) if text.startswith("Goal acc") else None)
    before = signal.getsignal(signal.SIGTERM)
    assert main(["action", "send_goal", "/lab/sums", "order: -1"]) == 130
    assert capsys.readouterr().out.endswith(f"{ID}Canceling goal...\nGoal canceled.\n")
    assert sums.canceled.wait(PATIENCE)
    assert signal.getsignal(signal.SIGTERM) is before


@pytest.mark.usefixtures("served")
def test_ctrl_c_with_a_server_that_goes_on(sums: Sums, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    sums.cancel_response = CancelResponse.REJECT
    when_said(monkeypatch, verbs, "say", lambda text: press_ctrl_c(text) if text.startswith("Goal acc") else None)
    assert main(["action", "send_goal", "/lab/sums", "order: -1"]) == 130
    assert capsys.readouterr().err == "robolink: the goal is not cancelled: the server goes on\n"


@pytest.mark.usefixtures("served")
def test_a_reader_that_goes_away_cancels_the_goal_too(sums: Sums, monkeypatch: pytest.MonkeyPatch) -> None:
    def vanish(text: str) -> None:
        if not text.startswith(("Waiting", "Sending")):
            raise BrokenPipeError

    when_said(monkeypatch, verbs, "say", vanish)
    with pytest.raises(BrokenPipeError):
        verbs.run("/lab/sums", "", "order: -1", verbs.Mode())
    assert sums.canceled.wait(PATIENCE)


@pytest.mark.usefixtures("served")
def test_so_does_one_of_the_feedback(sums: Sums, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    def vanish(text: str) -> None:
        if text.startswith("Feedback"):
            raise BrokenPipeError

    when_said(monkeypatch, verbs, "say", vanish)
    assert main(["action", "send_goal", "/lab/sums", "order: -1", "--feedback"]) == 141
    assert sums.canceled.wait(PATIENCE)
    assert capsys.readouterr().err == "", "it is no fault of a callback"


def test_a_type_that_is_not_installed_is_asked_of_the_server(node: Node, capsys: Captured) -> None:
    def polish(handle: ServerGoalHandle) -> Polish.Result:
        handle.succeed()
        return Polish.Result(shine=2 * handle.request.pressure)

    ActionServer(node, Polish, "/polish", polish)
    with spinning(node, threads=4):
        assert main(["action", "send_goal", "/polish", "{pressure: 1.5}"]) == 0
        assert "Result:\n    shine: 3.0\n" in capsys.readouterr().out
        assert main(["action", "send_goal", "/polish", POLISH, "{force: 1}"]) == 1
    assert capsys.readouterr().err == "robolink: Polish_Goal: no field 'force'; it has pressure\n"


def test_what_only_looks_like_an_action_is_told(node: Node, capsys: Captured) -> None:
    node.create_service(Polish.Impl.SendGoalService, "/odd/_action/send_goal", print)
    node.create_service(Polish.Impl.CancelGoalService, "/odd/_action/cancel_goal", print)
    node.create_service(Fibonacci.Impl.GetResultService, "/odd/_action/get_result", print)
    node.create_publisher(Fibonacci.Impl.FeedbackMessage, "/odd/_action/feedback", 10)
    node.create_publisher(Fibonacci.Impl.GoalStatusMessage, "/odd/_action/status", 10)
    with spinning(node, threads=4):
        assert main(["action", "send_goal", "/odd", "{}"]) == 1
    assert (
        "action Polish: Result must be a class inside it, got example_interfaces/action/Fib" in capsys.readouterr().err
    )


# --- send_goal: what is wrong with it -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([TYPE, "{order:3}"], "Fibonacci_Goal: no field 'order:3'; a space is missing behind the colon: 'order: 3'"),
        (
            [TYPE, "order:3"],
            (
                "Fibonacci_Goal: expected a mapping of order, got 'order:3'; "
                "a space is missing behind the colon: 'order: 3'"
            ),
        ),
        ([TYPE, "{ordr: 3}"], "Fibonacci_Goal: no field 'ordr' (did you mean 'order'?); it has order"),
        ([TYPE, "{order: x}"], "Fibonacci_Goal.order: expected int32, got 'x'"),
        ([TYPE, "[1]"], "Fibonacci_Goal: expected a mapping of order, got [1]"),
        (["std_msgs/msg/String"], "'std_msgs/msg/String' is the name of a message type; an action type is asked for"),
    ],
)
@pytest.mark.usefixtures("node")
def test_a_wrong_goal_is_told_before_anybody_waits(words: list[str], said: str, capsys: Captured) -> None:
    assert main(["action", "send_goal", "/nobody", *words]) == 1
    assert capsys.readouterr() == ("", f"robolink: {said}\n")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--timeout", "0"], "--timeout: expected a number of seconds above 0, got 0"),
        (["--timeout", "nan"], "--timeout: expected a number of seconds above 0, got nan"),
        (["Fibonacci", "{}", "--stdin"], "either VALUES or --stdin, not both"),
    ],
)
@pytest.mark.usefixtures("node")
def test_wrong_usage_is_exit_code_2(options: list[str], said: str, capsys: Captured) -> None:
    assert main(["action", "send_goal", "/x", *options]) == 2
    assert capsys.readouterr() == ("", f"robolink: {said} (see 'robolink action send_goal --help')\n")


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["/lab/sum"], "nobody serves the action /lab/sum on domain 7 (did you mean '/lab/sums'?)"),
        (["/lab/sums", "Polish"], f"/lab/sums is served as {TYPE}, not as Polish"),
    ],
)
@pytest.mark.usefixtures("served", "impatient")
def test_who_waits_for_a_server_is_told_why_and_gives_up(words: list[str], reason: str, capsys: Captured) -> None:
    assert main(["action", "send_goal", *words, "--timeout", "0.5"]) == 1
    assert capsys.readouterr() == (WAITING, f"waiting: {reason}\nrobolink: gave up after 0.5 s: {reason}\n")


@pytest.mark.usefixtures("impatient")
def test_a_server_on_another_domain_is_told(node: Node, capsys: Captured) -> None:
    other = Context(transport=node.context.transport.url)
    other.init([], domain_id=5)
    with other:
        ActionServer(made(other, "far"), Fibonacci, "/sums", print)
        assert main(["action", "send_goal", "/sums", "--timeout", "0.5", "--json"]) == 1
    reason = "nobody serves the action /sums on domain 7; it is on domain 5: set ROS_DOMAIN_ID=5"
    assert capsys.readouterr() == ("", f"waiting: {reason}\nrobolink: gave up after 0.5 s: {reason}\n")


def test_a_server_that_never_answers(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(verbs, "CANCELED_WITHIN", 0.05)
    ActionServer(node, Fibonacci, "/sums", print)  # and nobody spins
    assert main(["action", "send_goal", "/sums", "order: 3", "--timeout", "0.1"]) == 1
    out, err = capsys.readouterr()
    assert out == f"{WAITING}{SENDING}Canceling goal...\n"
    assert err.splitlines() == [
        "robolink: the goal is not cancelled: no answer within 0.05 s",
        "robolink: /sums did not answer within 0.1 s whether it accepts the goal",
    ]


@pytest.mark.usefixtures("served")
def test_a_server_that_goes_away(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    def leave(text: str) -> None:
        if text.startswith("Goal accepted"):
            next(node.waitables).destroy()

    when_said(monkeypatch, verbs, "say", leave)
    assert main(["action", "send_goal", "/lab/sums", "order: -1"]) == 1
    assert "robolink: action /lab/sums, goal " + "07" * 16 + ": no result: " in capsys.readouterr().err


# --- completion ---------------------------------------------------------------------------------------------------


def test_names_and_types_are_completed(busy: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(complete, "WITHIN", PATIENCE)
    assert action_names("") == ["/lab/sums", "/polish"]
    assert action_names("pol") == ["polish"]
    asked: Any = SimpleNamespace(params={"action": "polish"})
    assert type_of_action(asked, "") == [POLISH]
    asked.params["action"] = "/nobody"
    assert type_of_action(asked, "example_interfaces/action/F") == [TYPE]
    assert complete.action_types("Fibo") == ["Fibonacci"]


# --- real processes -----------------------------------------------------------------------------------------------


SERVER = """
    import time

    import robolink as rclpy
    from robolink.action import ActionServer, CancelResponse
    from robolink.callback_groups import ReentrantCallbackGroup
    from robolink.executors import ExternalShutdownException, MultiThreadedExecutor
    from robolink.interfaces.example_interfaces.action import Fibonacci


    def execute(goal_handle):
        feedback = Fibonacci.Feedback(sequence=[0, 1])
        while not goal_handle.is_cancel_requested:
            if len(feedback.sequence) > goal_handle.request.order > 0:
                goal_handle.succeed()
                return Fibonacci.Result(sequence=feedback.sequence)
            if len(feedback.sequence) < 40:
                feedback.sequence.append(feedback.sequence[-1] + feedback.sequence[-2])
            goal_handle.publish_feedback(feedback)
            time.sleep(0.02)
        goal_handle.canceled()
        print("canceled")
        return Fibonacci.Result(sequence=feedback.sequence)


    rclpy.init()
    node = rclpy.create_node("server")
    server = ActionServer(
        node,
        Fibonacci,
        "fibonacci",
        execute,
        callback_group=ReentrantCallbackGroup(),
        cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
    )
    print("ready")
    try:
        rclpy.spin(node, executor=MultiThreadedExecutor(4))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""


@pytest.mark.processes
def test_goals_cross_from_process_to_process(domain: int, tmp_path: Path) -> None:
    with Program(tmp_path, SERVER, domain) as server:
        assert server.line() == "ready"
        send = "action", "send_goal", "/fibonacci", "--timeout", "30", "-f"
        with Command(domain, *send, "Fibonacci", "{order: 3}", program=BUSY_ROBOLINK) as sender:
            assert sender.end() == 0
        text = "\n".join(each.text for each in sender.lines)
        assert "Feedback:\n    sequence:\n- 0\n- 1\n- 1\n" in text
        assert text.endswith("Goal finished with status: SUCCEEDED")
        with Command(domain, *send, "{order: -1}", program=BUSY_ROBOLINK) as sender:
            sender.wait_for("Feedback:")
            sender.interrupt()
            assert server.line() == "canceled"
            assert sender.end() == 130
        assert sender.lines[-1].text == "Goal canceled."
        assert not sender.errors
        with Command(domain, *send, "{order: -1}", program=BUSY_ROBOLINK) as sender:
            sender.wait_for("Feedback:")
            server.kill()
            assert sender.end() == 1
        assert "no result" in sender.errors[-1].text
