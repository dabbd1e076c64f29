"""Text of others on the terminal: no command that shows any lets a control character through. Each is tried."""

from __future__ import annotations

import ast
import json
import math
import os
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.action import ActionServer
from robolink.cli.main import main
from robolink.cli.root import command
from robolink.cli.shared.commands import NOUNS
from robolink.cli.tf import watch
from robolink.cli.topic import meters
from robolink.exceptions import nearest
from robolink.extensions.optional import is_here
from robolink.impl.log_output import Console
from robolink.impl.logging_severity import LoggingSeverity
from robolink.interfaces.geometry_msgs.msg import PointStamped
from robolink.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription
from robolink.interfaces.lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from robolink.interfaces.rcl_interfaces.msg import ListParametersResult, ParameterDescriptor, SetParametersResult
from robolink.interfaces.rcl_interfaces.msg import ParameterValue as Value
from robolink.interfaces.rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
)
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import Header, String
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.logging import Record
from robolink.message import Action, Message, string
from robolink.message.show import Style, as_yaml
from robolink.system.terminal import escaped, fit, is_fit, quoted, shown
from robolink.tf2 import StaticTransformBroadcaster
from robolink.transport import connect
from robolink.world_node.robot_topics import joint_refusal
from tests.support.excused_commands import EXCUSED
from tests.support.seen_by_commands import a_node_that_commands_see, spinning, when_said
from tests.support.transforms import transform

EVIL = "evil\x1b[2J\x1b]0;title\x07 \x08\x7f\x9b2J\x85 \u061c\u200e\u202e\u2028\u2069\r\t\nforged"
"""Moves the cursor, empties the screen, gives the window a title, rings, turns letters round and forges a line."""

ALLOWED = re.compile(r"[^\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]*")

STRING = 4
"""What parameters call the type of a text."""


class Whisper(Action):
    """An action whose every part is a text, and which only its node describes."""

    class Goal(Message):
        text: string

    class Result(Message):
        text: string

    class Feedback(Message):
        text: string


class Tried(NamedTuple):
    """A command line, and whether only Ctrl-C ends it. `refused` tells that it shows names, which must be plain."""

    words: list[str]
    endless: bool = False
    refused: bool = False


def tried(text: str, *, endless: bool = False, refused: bool = False) -> Tried:
    return Tried(text.split(), endless, refused)


def refused(*texts: str) -> list[Tried]:
    return [tried(each, refused=True) for each in texts]


CHILD = EVIL.replace("evil", "evil child")

TRIED: dict[str, list[Tried]] = {
    "topic list": refused("topic list -t", "topic list -v", "topic list --json"),
    "topic info": refused("topic info /chatter -v", "topic info /chatter --json"),
    "topic type": refused("topic type /chatter", "topic type /chatter --json"),
    "topic find": refused("topic find std_msgs/msg/String"),
    "topic hz": [tried("topic hz /chatter", endless=True)],
    "topic bw": [tried("topic bw /chatter", endless=True)],
    "topic delay": [tried("topic delay /stamped", endless=True)],
    "topic echo": [
        tried(f"topic echo /chatter --once {flags}")
        for flags in ("", "--csv", "--json", "--raw", "--flow-style", "--field data", "-i", "-f")
    ],
    "topic pub": [Tried(["topic", "pub", "-1", "-w", "0", "/chatter", "String", yaml.dump({"data": EVIL})])],
    "pub": [Tried(["pub", "-1", "-w", "0", "/chatter", "String", yaml.dump({"data": EVIL})])],
    "node list": refused("node list", "node list --json"),
    "node graph": refused("node graph", "node graph --format dot"),
    "node info": refused("node info /lab/robot", "node info /lab/robot --json"),
    "service list": refused("service list -t", "service list --json"),
    "service type": refused("service type /lab/ask"),
    "service find": refused("service find std_srvs/srv/Trigger"),
    "service info": refused("service info /lab/ask -v", "service info /lab/ask --json"),
    "service call": [tried("service call /lab/ask std_srvs/srv/Trigger"), tried("service call /lab/ask --json")],
    "service echo": [tried(f"service echo /lab/ask --once {flags}") for flags in ("", "--csv", "--json")],
    "param list": [
        tried(f"param list {words}") for words in ("", "/lab/robot", "/lab/robot --param-type", "/lab/robot --json")
    ],
    "param get": [
        Tried(["param", "get", "/lab/robot", EVIL]),
        tried("param get /lab/robot x --json"),
        tried("param get /lab/robot x --hide-type"),
    ],
    "param describe": [tried("param describe /lab/robot x"), tried("param describe /lab/robot x --json")],
    "param dump": [tried("param dump /lab/robot"), tried("param dump /lab/robot --json")],
    "param set": [tried("param set /lab/robot x y"), tried("param set /lab/robot x y --json")],
    "param load": [tried("param load /lab/robot params.yaml"), tried("param load /lab/robot params.yaml --json")],
    "param delete": [tried("param delete /lab/robot x"), tried("param delete /lab/robot x --json")],
    "lifecycle nodes": [tried("lifecycle nodes"), tried("lifecycle nodes --json")],
    "lifecycle get": [tried("lifecycle get"), tried("lifecycle get /lab/robot"), tried("lifecycle get --json")],
    "lifecycle list": [tried("lifecycle list /lab/robot"), tried("lifecycle list /lab/robot --json")],
    "lifecycle set": [tried("lifecycle set /lab/robot on"), Tried(["lifecycle", "set", "/lab/robot", EVIL])],
    "action list": refused("action list -t", "action list --json"),
    "action type": refused("action type /lab/whisper"),
    "action find": refused("action find test_foreign_text/action/Whisper"),
    "action info": refused("action info /lab/whisper -t", "action info /lab/whisper --json"),
    "action echo": [Tried(["action", "echo", EVIL]), Tried(["action", "echo", "/lab/whisper", "--interfaces", EVIL])],
    "action send_goal": [
        Tried(
            ["action", "send_goal", "/lab/whisper", Whisper.__ros_type__, yaml.dump({"text": EVIL}), "-f", *json_flag]
        )
        for json_flag in ([], ["--json"])
    ],
    "tf echo": [Tried(["tf", "echo", EVIL, CHILD, "--once", *json_flag]) for json_flag in ([], ["--json"])]
    + [Tried(["tf", "echo", EVIL, "nothing", "--once", "--timeout", "0.1"])],
    "tf monitor": [
        tried("tf monitor --period 0.1", endless=True),
        tried("tf monitor --period 0.1 --json", endless=True),
    ],
    "tf tree": [tried(f"tf tree -t 0.1 {flags}") for flags in ("", "--dot", "--json")],
    "bag info": [tried("bag info evil"), tried("bag info evil --json"), Tried(["bag", "info", EVIL])],
    "bag convert": [tried("bag convert evil out"), Tried(["bag", "convert", EVIL, "out"])],
    "bag reindex": [Tried(["bag", "reindex", EVIL])],
    "bag play": [
        tried("bag play evil"),
        Tried(["bag", "play", EVIL]),
        Tried(["bag", "play", "evil", "--topics", EVIL]),
    ],
    "image save": [Tried(["image", "save", "/image", EVIL])],
    "world check": [tried("world check evil.world.yaml"), tried("world check evil.world.yaml --json")],
    "world draw": [tried("world draw evil.world.yaml out.svg")],
    "launch": [
        tried("launch evil.launch.yaml --validate"),
        tried("launch evil.launch.yaml --validate --json"),
        tried("launch args.launch.yaml -s"),
    ],
    "simulate": [tried("simulate evil.launch.yaml --duration 1")],
    "interface show": [tried("interface show robolink_test/msg/Whisper")],
    "interface proto": [tried("interface proto robolink_test/msg/Whisper")],
    "interface package": [Tried(["interface", "package", EVIL])],
    "component load": [Tried(["component", "load", EVIL, "a", "b"])],
    "pkg create": [Tried(["pkg", "create", EVIL]), Tried(["pkg", "create", "a", "--dependencies", EVIL])],
    "pkg xml": [Tried(["pkg", "xml", EVIL])],
    "security create_enclave": [Tried(["security", "create_enclave", EVIL, "/a"])],
    "security create_permission": [Tried(["security", "create_permission", "keys", "/a", EVIL])],
    "security class": [Tried(["security", "class", EVIL, "--students", "0", "--turn", EVIL])],
    "security list_enclaves": [Tried(["security", "list_enclaves", EVIL])],
    "security withdraw": [Tried(["security", "withdraw", EVIL, "/a"])],
    "security generate_artifacts": [Tried(["security", "generate_artifacts", "-k", "keys", "-p", EVIL])],
    "network limit": [Tried(["network", "limit", EVIL])],
    "router": [Tried(["router", "--listen", EVIL]), Tried(["router", "--connect", EVIL])],
    "run": [Tried(["run", EVIL]), tried("run --list"), tried("run nodes/evil.py"), tried("run nodes/ends.py")],
}


def is_there(noun: str) -> bool:
    """Whether this copy has a command: an annex may have been deleted."""
    return is_here(NOUNS[noun].module)


def _leaves(each: Any, path: tuple[str, ...] = ()) -> Iterator[str]:
    """Every command that there is, from the tree that reads the command line."""
    if not hasattr(each, "list_commands"):
        yield " ".join(path)
        return
    for name in each.list_commands(None) if path else filter(is_there, NOUNS):
        yield from _leaves(each.get_command(None, name), (*path, name))


def test_every_command_is_tried_or_excused() -> None:
    there = set(_leaves(command()))
    known = {each for each in (*TRIED, *EXCUSED) if is_there(each.split()[0])}
    assert sorted(there - known) == [], "each needs a row in TRIED; `refused(...)` if all that it shows is names"
    assert sorted(known - there) == [], "there is no such command"
    assert sorted({*TRIED} & {*EXCUSED}) == [], "tried, and excused from it"


def _answer(robot: Node) -> None:
    """Serve what commands ask a node, and put the text into every answer."""
    state, transition = State(id=1, label=EVIL), Transition(id=1, label="on")
    change = TransitionDescription(transition=transition, start_state=state, goal_state=state)
    other = TransitionDescription(transition=Transition(id=2, label=EVIL), start_state=state, goal_state=state)
    descriptor = ParameterDescriptor(name=EVIL, type=STRING, description=EVIL, additional_constraints=EVIL)
    answers: dict[str, tuple[type[Any], dict[str, Any]]] = {
        "ask": (Trigger, {"message": EVIL}),
        "robot/list_parameters": (ListParameters, {"result": ListParametersResult(names=[EVIL], prefixes=[EVIL])}),
        "robot/get_parameters": (GetParameters, {"values": [Value(type=STRING, string_value=EVIL)]}),
        "robot/get_parameter_types": (GetParameterTypes, {"types": bytes([STRING])}),
        "robot/describe_parameters": (DescribeParameters, {"descriptors": [descriptor]}),
        "robot/set_parameters": (SetParameters, {"results": [SetParametersResult(successful=False, reason=EVIL)]}),
        "robot/get_state": (GetState, {"current_state": state}),
        "robot/get_available_transitions": (GetAvailableTransitions, {"available_transitions": [change, other]}),
        "robot/change_state": (ChangeState, {"success": False}),
    }
    for name, (type_, fields) in answers.items():

        def answer(request: Any, response: Any, fields: dict[str, Any] = fields) -> Any:
            for field, value in fields.items():
                setattr(response, field, value)
            return response

        robot.create_service(type_, name, answer)


def _publish(robot: Node) -> None:
    """Send the text on topics, and as events of a service, again and again."""
    StaticTransformBroadcaster(robot).sendTransform([transform(EVIL, CHILD)])
    text = robot.create_publisher(String, "/chatter", 10)
    stamped = robot.create_publisher(PointStamped, "/stamped", 10)
    events = robot.create_publisher(Trigger.Event, "/lab/ask/_service_event", 10)

    def publish() -> None:
        text.publish(String(data=EVIL))
        stamped.publish(PointStamped(header=Header(stamp=robot.get_clock().now().to_msg(), frame_id=EVIL)))
        events.publish(Trigger.Event(response=[Trigger.Response(message=EVIL)]))

    robot.create_timer(0.02, publish)


def _whisper(handle: Any) -> Any:
    handle.publish_feedback(Whisper.Feedback(text=EVIL))
    handle.succeed()
    return Whisper.Result(text=EVIL)


def _write(folder: Path) -> None:
    """Write files that are evil where they can be: a parameter file, a world, a launch file, a type and a bag."""
    quoted = json.dumps(EVIL)
    (folder / "evil").mkdir()
    bag = f"rosbag2_bagfile_information: {{version: {quoted}, {quoted}: 1}}\n"
    (folder / "evil" / "metadata.yaml").write_text(bag, encoding="utf-8")
    (folder / "params.yaml").write_text(f"/lab/robot:\n  ros__parameters:\n    {quoted}: {quoted}\n", encoding="utf-8")
    (folder / "evil.world.yaml").write_text(f"{quoted}: {quoted}\n", encoding="utf-8")
    (folder / "nodes").mkdir()
    (folder / "configs").mkdir()
    (folder / "nodes" / "evil.py").write_text(f'"""\u202eevil"""\nraise ValueError({EVIL!a})\n', encoding="utf-8")
    (folder / "nodes" / "ends.py").write_text(f"def main():\n    raise SystemExit({EVIL!a})\n", encoding="utf-8")
    arguments = f"arguments:\n  a: {{default: {quoted}, description: {quoted}}}\n"
    (folder / "args.launch.yaml").write_text(f"{arguments}nodes:\n  - run: nothing\n", encoding="utf-8")
    (folder / "evil.launch.yaml").write_text(f"nodes:\n  - run: {quoted}\n    {quoted}: 1\n", encoding="utf-8")


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Node]:
    """/lab/robot, whose every answer is evil, in a folder whose files are too, beside one that announces nonsense."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(meters, "PERIOD", 0.1)
    _write(tmp_path)
    with a_node_that_commands_see(monkeypatch) as node:
        _answer(node)
        _publish(node)
        ActionServer(node, Whisper, "/lab/whisper", _whisper)
        transport = connect(os.environ["ROBOLINK_TRANSPORT"])
        transport.announce(f"@ros2_lv/7/1f/0/0/NN/%/%/{EVIL}")
        with spinning(node, threads=2):
            yield node
        transport.close()


def _end_after_a_look(monkeypatch: pytest.MonkeyPatch) -> None:
    def press(text: object) -> None:
        if not str(text).startswith(("Subscribed", "Gathering")):
            raise KeyboardInterrupt

    for module in (meters, watch):
        when_said(monkeypatch, module, "say", press)
    when_said(monkeypatch, watch, "say_json", press)


@pytest.mark.slow
@pytest.mark.parametrize(
    "each", [pytest.param(each, id=" ".join(each.words)[:60]) for tries in TRIED.values() for each in tries]
)
@pytest.mark.usefixtures("robot")
def test_no_command_lets_a_control_character_through(
    each: Tried, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    if each.endless:
        _end_after_a_look(monkeypatch)
    main(each.words)
    out, err = capsys.readouterr()
    for text in (out, err):
        assert ALLOWED.fullmatch(text), repr(text)
    came = "1 announcement could not be read" in err if each.refused else "evil" in out + err
    assert came, "nothing of the text came: this tries nothing"
    assert "Traceback" not in err or each.words[:1] == ["run"]
    if "--json" in each.words and out:
        json.loads(out.splitlines()[0])


@given(st.text())
def test_text_that_is_fit_has_no_control_characters_and_stays_as_it_is(text: str) -> None:
    made = fit(text)
    assert ALLOWED.fullmatch(made)
    assert is_fit(made)
    assert fit(made) == made
    assert (made == text) == is_fit(text)
    assert "\n" not in fit(text, lines=False)
    assert shown(text, 20).isprintable()
    assert json.loads(fit(json.dumps(text, ensure_ascii=False))) == text


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_yaml_that_is_fit_is_the_same_text(text: str) -> None:
    made = as_yaml(String(data=text), Style(longest=None))
    assert ALLOWED.fullmatch(made)
    assert yaml.safe_load(made) == {"data": text}


def test_colours_pass_where_they_may_and_nothing_else() -> None:
    text = "\x1b[1;31mred\x1b[0m \x1b[2J \x1b[31"
    assert fit(text, colours=True) == "\x1b[1;31mred\x1b[0m \\x1b[2J \\x1b[31"
    assert fit(text) == "\\x1b[1;31mred\\x1b[0m \\x1b[2J \\x1b[31"


def test_log_lines_obey_nothing_but_colours(capsys: pytest.CaptureFixture[str]) -> None:
    Console({"RCUTILS_CONSOLE_OUTPUT_FORMAT": "{name}|{message}"})(
        Record(0, LoggingSeverity.INFO, EVIL, f"\x1b[31m{EVIL}", "", "", 0)
    )
    err = capsys.readouterr().err
    assert ALLOWED.fullmatch(err.replace("\x1b[31m", "", 1))
    assert err.startswith("evil\\x1b[2J")


def test_escapes_are_read_back() -> None:
    for char in EVIL:
        assert ast.literal_eval(f"'{escaped(char)}'") == char


def test_quoted_text_is_read_back_by_python_and_yaml() -> None:
    text = f'{EVIL} "quoted" \\ # = ä'
    assert ast.literal_eval(quoted(text)) == yaml.safe_load(quoted(text)) == text
    assert quoted("a#b=c", also="#=") == '"a\\x23b\\x3dc"'


def test_a_motor_of_any_name_is_one_short_line() -> None:
    command = JointState(name=[EVIL * 100_000], velocity=[math.nan])
    assert len(joint_refusal(command)) < 1000
    assert ALLOWED.fullmatch(joint_refusal(command))
    begin = time.process_time()
    assert nearest(EVIL * 100_000, ["left", "right"]) == ""
    assert time.process_time() - begin < 0.1
