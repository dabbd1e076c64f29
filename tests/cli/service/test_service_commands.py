"""service list, type, find, info and call: ros2's output, why nobody answers, and what answers badly."""

from __future__ import annotations

import io
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.cli.main import main
from robolink.cli.service import verbs
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.message import encode, type_hash
from robolink.qos import QoSProfile
from robolink.transport.base import Query
from robolink.wire import DataKey, EndpointKind, EndpointToken, format_key, format_token, pack_attachment
from robolink.workspace import VARIABLE
from tests.support.commands import Command
from tests.support.seen_by_commands import a_node_that_commands_see, made, spinning

Captured = pytest.CaptureFixture[str]
Hook = Callable[[str], object]

ASKED = "requester: making request: std_srvs.srv.SetBool_Request(data={})\n\n"
ANSWERED = "response:\nstd_srvs.srv.SetBool_Response(success=True, message='{}')\n\n"
GIVEN_UP = "robolink: no answer within 0.6 s from /lab/arm of /lab/robot\n"
WAITING = "waiting for service to become available...\n"


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.fixture
def served(node: Node) -> Iterator[Node]:
    """The node /lab/robot serves /lab/arm, and answers with what it was asked."""
    node.create_service(SetBool, "arm", echo)
    with spinning(node):
        yield node


@pytest.fixture
def when_told(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, Hook], None]:
    """Do something whenever the call has said ("say") or told ("tell") something."""

    def install(function: str, action: Hook) -> None:
        original = getattr(verbs, function)

        def speak(text: str) -> None:
            original(text)
            action(text)

        monkeypatch.setattr(verbs, function, speak)

    return install


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reasons are given at once."""
    monkeypatch.setattr(verbs, "PATIENCE", 0.01)
    monkeypatch.setattr(verbs, "_SLICE", 0.01)


def press_ctrl_c(text: str) -> None:
    raise KeyboardInterrupt


def echo(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success, response.message = True, f"was {request.data}"
    return response


# --- call: what is asked and answered -------------------------------------------------------------------------


@pytest.mark.parametrize(
    "words",
    [
        ["/lab/arm", "std_srvs/srv/SetBool", "{data: true}"],
        ["lab/arm", "SetBool", "data: true"],
        ["/lab/arm", "std_srvs/SetBool", "{data: true}", "--timeout", "30"],
        ["/lab/arm", "{data: true}"],
        ["/lab/arm", "data: true", "-n", "asker"],
    ],
)
@pytest.mark.usefixtures("served")
def test_a_call_prints_what_ros2_prints(words: list[str], capsys: Captured) -> None:
    assert main(["service", "call", *words]) == 0
    assert capsys.readouterr() == (ASKED.format("True") + ANSWERED.format("was True"), "")


@pytest.mark.parametrize("words", [[], ["SetBool"], ["{}"], ["SetBool", ""]])
@pytest.mark.usefixtures("served")
def test_what_is_not_given_is_default(words: list[str], capsys: Captured) -> None:
    assert main(["service", "call", "/lab/arm", *words]) == 0
    assert capsys.readouterr().out == ASKED.format("False") + ANSWERED.format("was False")


@pytest.mark.usefixtures("served")
def test_a_call_as_json_is_one_object(capsys: Captured) -> None:
    assert main(["service", "call", "/lab/arm", "{data: true}", "--json"]) == 0
    told = '{"request":{"data":true},"response":{"success":true,"message":"was True"}}\n'
    assert capsys.readouterr() == (told, "")


@pytest.mark.usefixtures("served")
def test_the_request_is_read_from_a_pipe(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("data: true\n"))
    assert main(["service", "call", "/lab/arm", "SetBool", "--stdin"]) == 0
    assert capsys.readouterr().out == ASKED.format("True") + ANSWERED.format("was True")


@pytest.mark.usefixtures("node")
def test_a_pipe_of_no_text_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"data: \xff"), encoding="utf-8"))
    assert main(["service", "call", "/x", "SetBool", "--stdin"]) == 1
    assert capsys.readouterr() == ("", "robolink: --stdin: expected text in UTF-8: invalid start byte at byte 6\n")


@pytest.mark.usefixtures("served")
def test_calls_at_a_rate_go_on_until_ctrl_c(when_told: Callable[[str, Hook], None], capsys: Captured) -> None:
    answers: list[str] = []

    def count(text: str) -> None:
        answers.append(text)
        if len(answers) == 6:
            raise KeyboardInterrupt

    when_told("say", count)
    assert main(["service", "call", "/lab/arm", "-r", "200"]) == 130
    assert capsys.readouterr().out == (ASKED.format("False") + ANSWERED.format("was False")) * 3


# --- call: what is wrong with it ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["SetBool", "{dta: true}"], "SetBool_Request: no field 'dta' (did you mean 'data'?); it has data"),
        (["SetBool", "{data: maybe}"], "SetBool_Request.data: expected bool, got 'maybe'"),
        (["SetBool", "[1]"], "SetBool_Request: expected a mapping of data, got [1]"),
        (["std_msgs/msg/String"], "'std_msgs/msg/String' is the name of a message type; a service type is asked for"),
    ],
)
@pytest.mark.usefixtures("node")
def test_a_wrong_request_is_told_before_anybody_waits(words: list[str], said: str, capsys: Captured) -> None:
    assert main(["service", "call", "/nobody", *words]) == 1
    assert capsys.readouterr() == ("", f"robolink: {said}\n")


@pytest.mark.usefixtures("served")
def test_a_wrong_request_for_a_type_that_was_found_out(capsys: Captured) -> None:
    assert main(["service", "call", "/lab/arm", "{data: maybe}"]) == 1
    assert capsys.readouterr() == ("", "robolink: SetBool_Request.data: expected bool, got 'maybe'\n")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["-r", "0"], "--rate: expected a number of Hz above 0, got 0"),
        (["-r", "nan"], "--rate: expected a number of Hz above 0, got nan"),
        (["--timeout", "-1"], "--timeout: expected a number of seconds above 0, got -1"),
        (["--timeout", "inf"], "--timeout: expected a number of seconds above 0, got inf"),
        (["SetBool", "{}", "--stdin"], "either VALUES or --stdin, not both"),
    ],
)
@pytest.mark.usefixtures("node")
def test_wrong_usage_is_exit_code_2(options: list[str], said: str, capsys: Captured) -> None:
    assert main(["service", "call", "/x", *options]) == 2
    assert capsys.readouterr() == ("", f"robolink: {said} (see 'robolink service call --help')\n")


@pytest.mark.parametrize("name", ["//x", "../..", "a*b", "a\0b", "/x" * 500_000, "", "/"])
@pytest.mark.usefixtures("node")
def test_a_name_that_cannot_be_is_one_short_line(name: str, capsys: Captured) -> None:
    assert main(["service", "call", name, "Trigger", "--timeout", "0.01"]) == 1
    out, err = capsys.readouterr()
    assert err.startswith("robolink: invalid service name")
    assert (out, err.count("\n"), len(err) < 500) == ("", 1, True)


@pytest.mark.processes
def test_a_type_of_the_workspace_is_known(tmp_path: Path, domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("nodes", "configs", "interfaces/toys/srv"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "interfaces/toys/srv/Add.srv").write_text("int64 a\n---\nint64 sum\n")
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    with Command(domain, "service", "call", "/nobody", "toys/srv/Add", "{c: 2}") as caller:
        assert caller.end() == 1
    assert [each.text for each in caller.errors] == ["robolink: Add_Request: no field 'c'; it has a"]


# --- call: why nobody answers ---------------------------------------------------------------------------------


def test_reasons_are_given_after_a_second_and_the_end_comes_after_five() -> None:
    assert (verbs.PATIENCE, verbs.Mode().timeout) == (1.0, 5.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["/lab/am"], "nobody serves /lab/am on domain 7 (did you mean '/lab/arm'?)"),
        (["/zzz", "Trigger"], "nobody serves /zzz on domain 7"),
        (["/lab/arm", "Trigger"], "/lab/arm is served as std_srvs/srv/SetBool, not as Trigger"),
        (["/lab/arm", "my/srv/Own"], "/lab/arm is served as std_srvs/srv/SetBool, not as my/srv/Own"),
    ],
)
@pytest.mark.usefixtures("served", "impatient")
def test_who_waits_for_a_service_is_told_why_and_gives_up(words: list[str], reason: str, capsys: Captured) -> None:
    assert main(["service", "call", *words, "--timeout", "0.6"]) == 1
    assert capsys.readouterr() == (WAITING, f"waiting: {reason}\nrobolink: gave up after 0.6 s: {reason}\n")


@pytest.mark.usefixtures("impatient")
def test_a_service_of_another_domain_is_told(node: Node, capsys: Captured) -> None:
    other = Context(transport=node.context.transport.url)
    other.init([], domain_id=5)
    with other:
        made(other, "far").create_service(Trigger, "/reset", echo)
        assert main(["service", "call", "/reset", "--timeout", "0.6", "--json"]) == 1
    reason = "nobody serves /reset on domain 7; it is on domain 5: set ROS_DOMAIN_ID=5"
    assert capsys.readouterr() == ("", f"waiting: {reason}\nrobolink: gave up after 0.6 s: {reason}\n")


@pytest.mark.usefixtures("impatient")
def test_a_service_that_comes_late_is_called(
    served: Node, when_told: Callable[[str, Hook], None], capsys: Captured
) -> None:
    when_told("tell", lambda text: served.create_service(SetBool, "/late", echo))
    assert main(["service", "call", "/late"]) == 0
    assert capsys.readouterr().out == WAITING + ASKED.format("False") + ANSWERED.format("was False")


@pytest.mark.usefixtures("impatient")
def test_a_server_that_never_answers(node: Node, capsys: Captured) -> None:
    node.create_service(SetBool, "arm", echo)  # and nobody spins
    assert main(["service", "call", "/lab/arm", "--timeout", "0.6"]) == 1
    assert capsys.readouterr() == (
        ASKED.format("False"),
        "waiting: /lab/arm of /lab/robot has not answered yet\n" + GIVEN_UP,
    )


@pytest.mark.usefixtures("impatient")
def test_a_server_that_goes_away(node: Node, when_told: Callable[[str, Hook], None], capsys: Captured) -> None:
    node.create_service(SetBool, "arm", echo)
    when_told("tell", lambda text: node.context.shutdown())
    assert main(["service", "call", "/lab/arm"]) == 1
    assert capsys.readouterr().err.splitlines()[1:] == [
        "robolink: service /lab/arm: nobody serves it, or the server went away"
    ]


def test_a_server_whose_callback_fails(node: Node, log_lines: list[Any], capsys: Captured) -> None:
    def fail(request: Any, response: Any) -> Any:
        raise ValueError("no arm")

    def spin_in_vain() -> None:
        with pytest.raises(ValueError, match="no arm"):
            executor.spin()

    node.create_service(SetBool, "arm", fail)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    thread = threading.Thread(target=spin_in_vain)
    thread.start()
    assert main(["service", "call", "/lab/arm"]) == 1
    thread.join()
    executor.shutdown()
    assert capsys.readouterr().err == "robolink: service /lab/arm: nobody serves it, or the server went away\n"
    assert log_lines == []  # who catches the exception has not lost it


@pytest.mark.parametrize(
    ("payload", "attachment", "reason"),
    [
        (b"", pack_attachment(1, 2, bytes(16)), "the answer cannot be read"),
        (b"\0\1\0\0\1\xff\xff\xff\xff", pack_attachment(1, 2, bytes(16)), "the answer cannot be read"),
        (encode(SetBool.Response()), b"", "the answer cannot be read: an attachment has 33 bytes, got 0"),
        (encode(SetBool.Response()), b"x" * 33, "the answer cannot be read: an attachment's gid has 16 bytes"),
    ],
)
def test_an_answer_that_is_none(node: Node, payload: bytes, attachment: bytes, reason: str, capsys: Captured) -> None:
    def answer(query: Query) -> None:
        query.reply(payload, attachment)
        query.close()

    transport, key = node.context.transport, DataKey(7, "/bad", "std_srvs/srv/SetBool", type_hash(SetBool))
    _server = transport.serve(format_key(key), lambda arrived: answer(transport.accept(arrived)))
    owner = (7, "abc", "0", "1", EndpointKind.SERVICE, "/", "/", "bad")
    _token = transport.announce(format_token(EndpointToken(*owner, *key[1:], QoSProfile(depth=10))))
    assert main(["service", "call", "/bad", "SetBool"]) == 1
    assert f"robolink: service /bad: {reason}" in capsys.readouterr().err


@pytest.mark.parametrize(("words", "text"), [(["/nobody"], "waiting for service"), (["/lab/arm"], "requester")])
@pytest.mark.usefixtures("served")
def test_ctrl_c_ends_it_in_every_phase(
    words: list[str], text: str, when_told: Callable[[str, Hook], None], capsys: Captured
) -> None:
    when_told("say", press_ctrl_c)
    assert main(["service", "call", *words]) == 130
    out, err = capsys.readouterr()
    assert (out.startswith(text), err) == (True, "")
