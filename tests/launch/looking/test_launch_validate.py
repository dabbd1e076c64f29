"""`launch --validate` makes every node of a system and finds what its launch file says wrong of them."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import DocumentError
from robolink.launch import read_launch_file
from robolink.launch.looking.look import End, Job, Look, LookError, look_into, read
from robolink.launch.looking.validate import Found, Report, found, judged, validate
from robolink.workspace import VARIABLE

STRING, INT = "std_msgs/msg/String", "std_msgs/msg/Int32"

TALKER = """
from robolink import Node
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import Trigger

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.declare_parameter("word", "hi")
        self.declare_parameter("rate", 2.0)
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_service(Trigger, "~/reset", lambda request, response: response)
"""
LISTENER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(Int32, "chatter", print, 10)
        self.client = self.create_client(Trigger, "talker/reset")
        while not self.client.wait_for_service(timeout_sec=1.0):
            print("waiting")

def main():
    rclpy.init()
    node = Listener()
    rclpy.spin(node)
    print("never")
"""
NODE = "from robolink import Node\nclass Made(Node):\n    def __init__(self):\n        super().__init__('made'"
FILES = {
    "talker": TALKER,
    "listener": LISTENER,
    "raises": f"{NODE})\n        raise ValueError('no\\ncamera')\n",
    "open": f"{NODE}, allow_undeclared_parameters=True)\n",
    "leaves": f"{NODE})\n        import os\n        os._exit(3)\n",
    "threads": f"{NODE})\n        import threading\n        threading.Thread(target=threading.Event().wait).start()\n",
    "hangs": f"{NODE})\n        import threading\n        threading.Event().wait()\n",
    "exits": "import sys\nclass Node: pass\ndef main():\n    sys.exit(4)\n",
    "returns": "class Node: pass\ndef main():\n    print('that was all')\n",
    "script": "import rclpy\nrclpy.init()\nnode = rclpy.create_node('written')\nnode.declare_parameter('a', 1)\n"
    "rclpy.spin(node)\n",
    "timed": "import rclpy\ndef main():\n    with rclpy.init():\n        node = rclpy.create_node('timed')\n"
    "        rclpy.spin_once(node, timeout_sec=100.0)\n        open('x', 'w')\n",
    "async_class": "import asyncio\nfrom rclpy.experimental import AsyncNode\nclass A(AsyncNode):\n"
    "    def __init__(self):\n        super().__init__('async_class')\n"
    "        self.declare_parameter('a', str(asyncio.get_running_loop().time()))\n",
    "async_script": "import asyncio, rclpy\nfrom rclpy.experimental import AsyncNode\nasync def main():\n"
    "    async with AsyncNode('async_script') as node:\n        node.declare_parameter('a', 1)\n"
    "        await node.get_clock().sleep(100.0)\nwith rclpy.init():\n    asyncio.run(main())\n",
    "broken": "class",
}


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    for name, text in FILES.items():
        (tmp_path / "nodes" / f"{name}.py").write_text(text)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path.resolve()


def looked(home: Path, *names: str, args: Sequence[str] = (), patience: float = 60.0) -> list[Look]:
    jobs = [Job(str(home / "nodes" / f"{name}.py"), ["--ros-args", *args], {VARIABLE: str(home)}) for name in names]
    return look_into(jobs, patience)


def ends(look: Look) -> list[tuple[str, str]]:
    return [(each.kind, each.name) for each in look.ends if not each.type.startswith(("rcl_", "type_description_"))]


@pytest.mark.processes
def test_classes_programs_and_scripts_are_looked_into(home: Path) -> None:
    talker, listener, script, timed = looked(home, "talker", "listener", "script", "timed", args=["-r", "chatter:=c"])
    assert [each.nodes for each in (talker, listener, script, timed)] == [
        ["/talker"],
        ["/listener"],
        ["/written"],
        ["/timed"],
    ]
    assert ends(talker) == [("MP", "/c"), ("SS", "/talker/reset")]
    assert ends(listener) == [("MS", "/c"), ("SC", "/talker/reset")]
    assert {"word", "rate", "use_sim_time"} <= set(talker.declared)
    assert "a" in script.declared
    assert [each.error + each.unseen for each in (talker, listener, script, timed)] == [""] * 4


@pytest.mark.processes
def test_asynchronous_classes_and_scripts_are_looked_into(home: Path) -> None:
    looks = looked(home, "async_class", "async_script")
    assert [each.nodes for each in looks] == [["/async_class"], ["/async_script"]]
    assert all("a" in each.declared for each in looks)
    assert [each.error + each.unseen for each in looks] == ["", ""]


@pytest.mark.processes
def test_what_a_node_does_not_take_is_told_and_the_rest_is_seen_nevertheless(home: Path) -> None:
    [look] = looked(home, "talker", args=["-p", "word:=1", "-p", "rate:=fast", "-p", "use_sim_time:=true"])
    assert look.error == ""
    assert list(look.refused) == ["word", "rate"]
    assert "Trying to set parameter 'rate' to 'fast' of type 'STRING', expecting type 'DOUBLE'" in look.refused["rate"]
    assert ("MP", "/chatter") in ends(look)


@pytest.mark.processes
def test_nodes_that_cannot_be_made_are_told_of_and_hold_nobody_up(home: Path) -> None:
    names = ["raises", "leaves", "exits", "returns", "broken", "talker", "threads"]
    looks = dict(zip(names, looked(home, *names), strict=True))
    assert looks["raises"].error == f"ValueError: no camera (at {home}/nodes/raises.py:5)"
    assert looks["leaves"].error == "its process ended with exit code 3 while it was made"
    assert looks["exits"].error == "it ends its process with exit code 4"
    assert looks["returns"].unseen == "its program ends by itself, without ever waiting"
    assert looks["broken"].error.startswith(f"{home}/nodes/broken.py:1:")
    assert ends(looks["talker"]) == [("MP", "/chatter"), ("SS", "/talker/reset")]
    assert looks["threads"].nodes == ["/made"]


@pytest.mark.processes
def test_a_node_that_is_never_made_is_seen_as_far_as_it_was(home: Path) -> None:
    [look] = looked(home, "hangs", patience=1.0)
    assert look.unseen == "it is not made after 1 s"
    assert look.nodes == ["/made"]


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="no signal holds a process up there")
def test_a_process_that_is_held_up_is_killed(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.launch.looking.look._GRACE", 0.5)
    stop = f"{NODE})\n        import os, signal\n        os.kill(os.getpid(), signal.SIGSTOP)\n"
    (home / "nodes" / "stops.py").write_text(stop)
    [look] = looked(home, "stops", patience=3.0)  # within which it stops itself
    assert look.error == "it holds up its whole process when it is made"


@given(st.binary())
def test_what_is_no_request_is_refused(text: bytes) -> None:
    with pytest.raises(LookError, match="expected nodes to look into"):
        read(text)


# --- what is wrong --------------------------------------------------------------------------------------------


@pytest.mark.processes
def test_mistakes_are_found_with_their_places(home: Path) -> None:
    report = validate(
        read_launch_file(
            home / "configs" / "lap.yaml",
            text="""
nodes:
- node: talker
  parameters: {wrd: hi, rate: fast}
  remappings: {chatter: c, chater: d}
- node: listener
  remappings: {chatter: c}
  start_after: {topic: /cc}
- node: raises
- node: open
  parameters: {anything: 1}
""",
        )
    )
    refused = "Trying to set parameter 'rate' to 'fast' of type 'STRING', expecting type 'DOUBLE'"
    assert [shortened(each, home) for each in report.mistakes] == [
        f"9:9: nodes[2].node: 'raises' cannot be started: ValueError: no camera (at {home}/nodes/raises.py:5)",
        "4:16: nodes[0].parameters.wrd: 'talker' declares no parameter 'wrd' (did you mean 'word'?)",
        f"4:31: nodes[0].parameters.rate: {refused} (at {home}/nodes/talker.py:10)",
        "5:28: nodes[0].remappings.chater: 'talker' has nothing that is called 'chater' (did you mean 'chatter'?)",
        f"6:9: nodes[1].node: 'listener' subscribes to topic /c as {INT}, but 'talker' publishes {STRING}",
    ]
    assert report.notes == []


def shortened(error: DocumentError, home: Path) -> str:
    return str(error).removeprefix(f"{home}/configs/lap.yaml:")


def judge(home: Path, text: str, **looks: Look) -> Report:
    return judged(read_launch_file(home / "configs" / "lap.yaml", text=text), looks)


def texts(home: Path, report: Report) -> list[str]:
    return [shortened(each, home) for each in report.mistakes]


def test_what_a_group_says_must_be_right_for_one_of_its_nodes(home: Path) -> None:
    text = """
groups:
- parameters: {word: hi, wrod: hi}
  remappings: {chatter: c, nothing: d}
  nodes:
  - {node: talker}
  - {node: talker, name: second}
"""
    first = Look(["/talker"], [End("MP", "/c", STRING, "", "/talker")], ["word"])
    report = judge(home, text, talker=first, second=Look(["/second"]))
    assert texts(home, report) == [
        "3:26: groups[0].parameters.wrod: no node that gets it declares a parameter 'wrod' (did you mean 'word'?)",
        "4:28: groups[0].remappings.nothing: 'second' has nothing that is called 'nothing'",
    ]


def test_what_makes_no_node_is_noted_and_nothing_is_wanted_of_it(home: Path) -> None:
    """A viewer such as rviz2 has the parameters of every node in ROS 2, and is only told of here."""
    text = """
groups:
- parameters: {use_sim_time: true}
  nodes:
  - {node: talker, parameters: {fixed: map}, remappings: {a: b}}
  - {node: talker, name: second}
"""
    report = judge(home, text, talker=Look(), second=Look(["/second"], [], ["use_sim_time"]))
    assert report == ([], ["talker was not looked into: it makes no node"])
    report = judge(home, text.replace("sim", "smi"), talker=Look(), second=Look(["/second"], [], ["use_sim_time"]))
    assert "declares a parameter 'use_smi_time' (did you mean 'use_sim_time'?)" in texts(home, report)[0]


def test_copies_are_wrong_once(home: Path) -> None:
    text = "nodes:\n- {node: talker, count: 3, name: 't{i}', remappings: {no: x}}"
    report = judge(home, text, **{f"t{number}": Look([f"/t{number}"]) for number in range(3)})
    assert len(report.mistakes) == 1


def test_a_remapping_of_an_action_or_of_the_node_itself_renames_something(home: Path) -> None:
    look = Look(["/r/me"], [End("SS", "/r/go/_action/send_goal", "a/action/Go_SendGoal", "", "/r/me")])
    text = "nodes:\n- {node: talker, name: me, namespace: r, remappings: {walk: go, ~/x: y, __node: me}}"
    report = judge(home, text, **{"r/me": look})
    assert [each.partition(": ")[0] for each in texts(home, report)] == ["2:65"]


TYPES = [
    (("MP", STRING, ""), ("MS", STRING, ""), ""),
    (("MS", STRING, ""), ("MS", INT, ""), "'two' subscribes to topic /x as {int}, but 'one' subscribes to {string}"),
    (("MS", STRING, ""), ("MP", INT, ""), "'one' subscribes to topic /x as {string}, but 'two' publishes {int}"),
    (("MP", STRING, "a"), ("MP", STRING, "b"), "'two' publishes topic /x as {string}, but 'one' publishes another"),
    (("SC", "a/srv/A", ""), ("SS", "a/srv/B", ""), "'one' calls service /x as a/srv/A, but 'two' serves a/srv/B"),
    (("MP", STRING, ""), ("SC", "a/srv/B", ""), ""),
]


@pytest.mark.parametrize(("one", "two", "reason"), TYPES)
def test_nodes_agree_about_types(home: Path, one: tuple[str, str, str], two: tuple[str, str, str], reason: str) -> None:
    looks = {
        name: Look([f"/{name}"], [End(kind, "/x", type_name, type_hash, f"/{name}")])
        for name, (kind, type_name, type_hash) in {"one": one, "two": two}.items()
    }
    report = judge(home, "nodes:\n- {node: talker, name: one}\n- {node: talker, name: two}", **looks)
    wanted = reason.format(string=STRING, int=INT)
    assert [wanted in each for each in texts(home, report)] == [True] * bool(reason)


def test_actions_are_one_thing(home: Path) -> None:
    kinds = {"send_goal": "SS", "get_result": "SS", "cancel_goal": "SS", "feedback": "MP"}
    looks = {
        name: Look(
            [f"/{name}"],
            [
                End(kind, f"/go/_action/{part}", f"a/action/{type_name}_{end}", "", f"/{name}")
                for (part, kind), end in zip(kinds.items(), ["SendGoal", "GetResult", "C", "F"], strict=True)
            ],
        )
        for name, type_name in {"one": "Go", "two": "Come"}.items()
    }
    report = judge(home, "nodes:\n- {node: talker, name: one}\n- {node: talker, name: two}", **looks)
    assert texts(home, report) == [
        "3:10: nodes[1].node: 'two' serves action /go as a/action/Come, but 'one' serves a/action/Go"
    ]


WAITS = [
    ("{topic: /chatter}", [], []),
    ("{node: talker}", [], []),
    ("{service: /reset}", [], []),
    ("{topic: /chater}", ["'waits' waits for topic /chater, which no other node of this system has (did you mean"], []),
    ("{topic: /reset}", [], ["'waits' waits for topic /reset, which no other node of this system has"]),
]


@pytest.mark.parametrize(("start_after", "mistakes", "notes"), WAITS)
def test_what_is_waited_for_is_there(home: Path, start_after: str, mistakes: list[str], notes: list[str]) -> None:
    text = f"nodes:\n- node: talker\n- {{node: talker, name: waits, start_after: {start_after}}}"
    has = [End("MP", "/chatter", STRING, "", "/talker"), End("SS", "/reset", "a/srv/B", "", "/talker")]
    known = {"talker": Look(["/talker"], has), "waits": Look(["/waits"])}
    report = judge(home, text, **known)
    assert [
        each.partition(".start_after: ")[2].removesuffix(" '/chatter'?)") for each in texts(home, report)
    ] == mistakes
    assert report.notes == notes
    report = judge(home, text, talker=Look(["/talker"], unseen="it hangs"), waits=Look(["/waits"]))
    assert report == ([], ["talker was not looked into: it hangs"])


def test_a_node_that_is_announced_otherwise_is_never_there(home: Path) -> None:
    text = "nodes:\n- node: talker\n- {node: listener, start_after: talker}"
    report = judge(home, text, talker=Look(["/made", "/up"]), listener=Look(["/listener"]))
    reason = "'listener' waits for node /talker, which is announced as /made and /up: give it a `name`"
    assert texts(home, report) == [f"3:33: nodes[1].start_after: {reason}"]


def test_what_every_node_has_may_be_waited_for_but_not_what_only_the_waiting_one_has(home: Path) -> None:
    text = "nodes:\n- node: talker\n- {node: listener, start_after: [{service: talker/get_parameters}, {topic: a}]}"
    every = End("SS", "/talker/get_parameters", "rcl_interfaces/srv/GetParameters", "", "/talker")
    own = End("MP", "/a", STRING, "", "/listener")
    report = judge(home, text, talker=Look(["/talker"], [every]), listener=Look(["/listener"], [own]))
    assert report == ([], ["'listener' waits for topic /a, which no other node of this system has"])


def test_commands_and_nodes_with_the_keyboard_are_noted(home: Path) -> None:
    text = f"nodes:\n- {{run: [{sys.executable}], name: python}}\n- {{node: talker, interactive: true}}"
    report = judge(home, text, talker=Look(error="no terminal"))
    assert report == ([], ["python was not looked into: it is a command", "talker was not looked into: no terminal"])


def test_a_core_that_is_not_there_is_a_mistake(home: Path) -> None:
    report = judge(home, "nodes:\n- {node: talker, cpu: 4095}", talker=Look(["/talker"]))
    assert texts(home, report)[0].startswith("2:23: nodes[0].cpu: core 4095 is not there")


def test_a_mistake_is_parted_for_programs() -> None:
    error = DocumentError("nodes[0]: no: 1:2: x", "C:\\a b\\lap.yaml", 3, 14)
    assert str(error) == "C:\\a b\\lap.yaml:3:14: nodes[0]: no: 1:2: x"
    assert found(error) == Found("C:\\a b\\lap.yaml", 3, 14, "nodes[0]: no: 1:2: x")
    assert found(DocumentError("no place")) == Found("", 0, 0, "no place")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), found(again)) == (str(error), found(error))
