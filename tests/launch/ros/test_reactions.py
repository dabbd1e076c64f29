"""Timers, event handlers and events of ROS 2's launch files: what is asked of the launcher, and when."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import main
from robolink.exceptions import NotFoundError
from robolink.interfaces.std_msgs.msg import String
from robolink.launch.entry import Entry
from robolink.launch.ros import visit
from robolink.launch.ros.reactions import Reactions
from robolink.launch.system import read_system
from robolink.node import Node
from robolink.supervisor.director import Add, Director, End, Request, Signal, Stop, Tell
from robolink.testing import System
from robolink.testing.expectations import NodeFailure
from tests.support.ros_launch import FIRST, write
from tests.support.ros_launch import TALKER as TALKER_CODE

TALKER = 'Node(package="bot", executable="talker", name="{}")'


class Names:
    """Stage whose processes are names, without a node."""

    def plan(self, entries: list[Entry]) -> Sequence[str]:
        return [each.name for each in entries]

    def with_node(self, act: Callable[[Node], object]) -> None:
        raise AssertionError("no node was expected")

    def post(self, act: Callable[[float], Sequence[Request[str]]]) -> None:
        raise AssertionError("nothing was expected")


def directed(package: Path, body: str) -> Director[str]:
    """Director of a launch file whose processes are names."""
    system = read_system(write(package, body))
    assert system.direct is not None
    return system.direct(Names())


def test_a_file_without_any_has_no_director(package: Path) -> None:
    assert read_system(write(package, TALKER.format("a") + ", LogInfo(msg='x')")).direct is None


def test_a_timer_starts_processes_when_its_time_has_come(package: Path) -> None:
    director = directed(
        package,
        f"""
        SetLaunchConfiguration("period", "2"),
        GroupAction([PushRosNamespace("g"), TimerAction(period=LaunchConfiguration("period"), actions=[
            {TALKER.format("a")}, TimerAction(period=1.5, actions=[LogInfo(msg="later")])])]),
        TimerAction(period=1.0, actions=[LogInfo(msg=ThisLaunchFileDir())]),
        """,
    )
    assert director.begin(10.0) == []
    assert director.deadline == 11.0
    assert director.woken(11.0) == [Tell(str(package / "launch"))]
    assert director.deadline == 12.0
    assert director.woken(11.9) == []
    assert director.woken(12.0) == [Add("g/a")]
    assert director.deadline == 13.5
    assert director.woken(14.0) == [Tell("later")]
    assert director.deadline is None


def test_a_timer_can_be_cancelled_and_ends_with_the_launch(package: Path) -> None:
    director = directed(
        package,
        """
        def generate_launch_description():
            timer = TimerAction(period=5.0, actions=[LogInfo(msg="never")])
            cancel = OpaqueFunction(function=lambda context: timer.cancel())
            return LaunchDescription([timer, TimerAction(period=1.0, actions=[cancel]),
                                      TimerAction(period=9.0, actions=[LogInfo(msg="never")])])
        """,
    )
    director.begin(0.0)
    assert (director.woken(1.0), director.deadline) == ([], 9.0)
    assert (director.stopping(2.0), director.deadline) == ([], None)


HANDLERS = """
def generate_launch_description():
    first, second = (Node(package="bot", executable="talker", name=name) for name in "ab")
    return LaunchDescription([first, second,
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[
            LogInfo(msg=["pid ", LocalSubstitution("event.pid")])])),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=lambda event, context: [
            LogInfo(msg=f"{event.process_name} {event.returncode}"), Node(package="bot", executable="once")])),
        RegisterEventHandler(OnProcessExit(on_exit=[LogInfo(msg="any")], handle_once=True)),
        RegisterEventHandler(OnProcessIO(
            target_action=second, on_stdout=lambda event: LogInfo(msg=event.text.decode()))),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg="over")])),
    ])
"""


def test_handlers_react_to_processes(package: Path) -> None:
    director = directed(package, HANDLERS)
    assert (director.begin(0.0), director.deadline, director.hears_lines) == ([], None, True)
    assert director.started("a", 77, 0.1) == [Tell("pid 77")]
    assert director.started("b", 78, 0.1) == []
    assert director.line("a", b"no\n", 0.2) == []
    assert director.line("b", b"yes\n", 0.2) == [Tell("yes\n")]
    assert director.exited("a", 3, 0.3) == [Tell("any"), Tell("a 3"), Add("once")]
    assert director.exited("b", 0, 0.3) == []
    assert director.exited("unknown", 0, 0.3) == []
    assert director.stopping(0.4) == [Tell("over")]


def test_events_end_processes_and_the_launch(package: Path) -> None:
    director = directed(
        package,
        """
        def generate_launch_description():
            node = Node(package="bot", executable="talker", name="a")
            is_node = events.matches_action(node)
            def after(period, event):
                return TimerAction(period=period, actions=[EmitEvent(event=event)])
            return LaunchDescription([node,
                after(1.0, events.process.SignalProcess(signal_number="SIGINT", process_matcher=is_node)),
                after(2.0, events.process.ShutdownProcess(process_matcher=is_node)),
                after(3.0, events.Shutdown(reason="enough"))])
        """,
    )
    director.begin(0.0)
    assert director.woken(1.0) == [Signal("a", 2)]
    assert director.woken(2.0) == [Stop("a")]
    assert director.woken(3.0) == [End("the launch file ends the system: enough")]


def test_what_waits_for_something_left_out_goes_on(package: Path) -> None:
    director = directed(
        package,
        f"""
        def generate_launch_description():
            gone = Node(package="gazebo_ros", executable="spawn_entity.py")
            return LaunchDescription([gone,
                RegisterEventHandler(OnProcessExit(target_action=gone, on_exit=[{TALKER.format("a")}])),
                RegisterEventHandler(OnProcessStart(target_action=gone, on_start=[{TALKER.format("b")}])),
                RegisterEventHandler(OnProcessExit(target_action=gone, on_exit=[Shutdown()]))])
        """,
    )
    assert director.begin(0.0) == [Add("a"), Add("b")]


def test_an_action_is_complete(package: Path) -> None:
    director = directed(
        package,
        """
        def generate_launch_description():
            said = LogInfo(msg="said")
            timer = TimerAction(period=1.0, actions=[])
            return LaunchDescription([
                RegisterEventHandler(OnExecutionComplete(target_action=said, on_completion=[LogInfo(msg="done")])),
                RegisterEventHandler(OnExecutionComplete(target_action=timer, on_completion=[LogInfo(msg="rang")])),
                said, timer])
        """,
    )
    assert director.begin(0.0) == [Tell("done")]
    assert director.woken(1.0) == [Tell("rang")]


@pytest.mark.parametrize(
    ("reaction", "line", "text"),
    [
        ("lambda event, context: 1 / 0", 3, "ZeroDivisionError: division by zero"),
        ("[LogInfo(msg=LaunchConfiguration('none'))]", 3, "no launch argument is called 'none'"),
        ("lambda event, context: ['x']", 3, "an action is expected, got str"),
    ],
)
def test_a_mistake_in_a_handler_ends_the_launch(package: Path, reaction: str, line: int, text: str) -> None:
    director = directed(package, f"{TALKER.format('a')},\nRegisterEventHandler(OnProcessStart(on_start={reaction})),")
    (end,) = director.started("a", 1, 0.0)
    assert end == End(f"{package}/launch/bot.launch.py:{FIRST + line}: {text}", 1)


@pytest.mark.slow
def test_events_that_follow_from_each_other_without_end(package: Path) -> None:
    director = directed(
        package,
        """
        def again(event, context):
            return [EmitEvent(event=events.ExecutionComplete(action=None))]

        def generate_launch_description():
            return LaunchDescription([
                RegisterEventHandler(OnExecutionComplete(on_completion=again)), LogInfo(msg="begin")])
        """,
    )
    end = director.begin(0.0)[-1]
    assert isinstance(end, End)
    assert "it never ends" in end.reason


# In virtual time

SYSTEM = """
def generate_launch_description():
    once = Node(package="bot", executable="once", parameters=[{"after": 3.0, "code": 0}])
    command = ExecuteProcess(cmd=["python3", "-c", "1"], name="command")
    return LaunchDescription([once, command,
        RegisterEventHandler(OnProcessExit(target_action=once, on_exit=[
            Node(package="bot", executable="talker", name="second")])),
        RegisterEventHandler(OnProcessExit(target_action=command, on_exit=[
            Node(package="bot", executable="talker", name="first")])),
        TimerAction(period=20.0, actions=[Shutdown(reason="enough")])])
"""


def test_a_system_in_virtual_time_goes_on(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(package, SYSTEM)
    result: Any
    assert main(["simulate", "bot", "bot", "--duration", "60", "--set", "second.word:=set"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("bot.launch: 20 s in")
    assert "/chatter" in out
    assert "the launch file ends the system: enough" in err
    assert main(["simulate", "bot", "bot", "--set", "secnd.word:=set"]) == 1
    result = capsys.readouterr().err
    assert "no node named 'secnd' in the launch file (did you mean 'second'?)" in result


def test_a_system_under_test_goes_on(package: Path, system: System) -> None:
    said = system.messages("chatter", type=String)
    system.launch(write(package, SYSTEM), set={"second.word": "two", "first.word": "one"})
    system.run(2.5)
    assert {each.data for each in said} == {"one"}
    system.run(3.0)
    assert {each.data for each in said} == {"one", "two"}
    system.run(16.0)
    before = len(said)
    system.run(5.0)
    assert len(said) == before
    with pytest.raises(NotFoundError, match="no node named 'third'"):
        system.launch(write(package, SYSTEM), set={"third.word": "x"})


def test_a_line_of_the_log_in_virtual_time(package: Path, system: System) -> None:
    logs = "def tell(self):\n        self.get_logger().info('ready')"
    (package / "bot" / "talker.py").write_text(TALKER_CODE.replace("def tell(self):", logs))
    write(
        package,
        """
        def heard(event):
            return Node(package="bot", executable="talker", name="b") if b"ready" in event.text else None

        def generate_launch_description():
            a = Node(package="bot", executable="talker", name="a", remappings=[("chatter", "other")])
            return LaunchDescription([a, RegisterEventHandler(OnProcessIO(target_action=a, on_stderr=heard))])
        """,
    )
    system.launch(package / "launch" / "bot.launch.py")
    system.expect("chatter", type=String, within=5.0)


@pytest.mark.processes
def test_a_system_of_processes_goes_on(package: Path) -> None:
    write(
        package,
        """
        def generate_launch_description():
            first = ExecuteProcess(cmd=["python3", "-c", "print('one')"], name="first")
            second = ExecuteProcess(name="second", cmd=[
                "python3", "-c", "import signal as s; s.signal(2, s.SIG_DFL); print('two', flush=True); s.pause()"])
            return LaunchDescription([first,
                RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[second])),
                RegisterEventHandler(OnProcessIO(target_action=first, on_stdout=lambda event: LogInfo(msg="heard"))),
                RegisterEventHandler(OnProcessIO(target_action=second, on_stdout=lambda event: TimerAction(
                    period=0.1, actions=[Shutdown(reason="enough")]) if b"two" in event.text else None)),
                RegisterEventHandler(OnShutdown(on_shutdown=[
                    LogInfo(msg=["over: ", LocalSubstitution("event.reason")])])),
            ])
        """,
    )
    command = [sys.executable, "-m", "robolink", "launch", "bot", "bot.launch.py"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert [each for each in lines if each != "[launch] heard"] == [
        "[first] one",
        "[launch] first has ended",
        "[second] two",
        "[launch] the launch file ends the system: enough",
        "[launch] over: enough",
    ]
    assert lines.index("[first] one") < lines.index("[launch] heard")


LATER = """
        Node(package="bot", executable="talker"),
        TimerAction(period=1.0, actions=[OpaqueFunction(function=lambda context: 1 / 0)]),
"""


def test_a_mistake_that_comes_later_is_a_failure_in_virtual_time(
    package: Path, system: System, capsys: pytest.CaptureFixture[str]
) -> None:
    file = write(package, LATER)
    assert main(["simulate", str(file), "--duration", "3"]) == 1
    assert "ZeroDivisionError: division by zero" in capsys.readouterr().err
    system.launch(str(file))
    with pytest.raises(NodeFailure, match="ZeroDivisionError"):
        system.run(3.0)


AGAIN = """
def again(context):
    return [TimerAction(period=PERIOD, actions=[LogInfo(msg="x"), OpaqueFunction(function=again)])]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=again)])
"""


def test_a_long_life_is_no_endless_one(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(visit, "MOST_VISITED", 20)
    director = directed(package, AGAIN.replace("PERIOD", "0.1"))
    director.begin(0.0)
    for _ in range(40):
        assert director.deadline is not None
        assert director.woken(director.deadline) == [Tell("x")]


def test_a_timer_without_a_period_does_not_stop_virtual_time(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(visit, "MOST_VISITED", 100)
    file = write(package, TALKER_AND_AGAIN.replace("PERIOD", "0.0"))
    assert main(["simulate", str(file), "--duration", "3"]) == 1
    assert "it never ends" in capsys.readouterr().err


TALKER_AND_AGAIN = AGAIN.replace("LaunchDescription([", 'LaunchDescription([Node(package="bot", executable="talker"), ')


def test_wake_ups_of_a_long_run_do_not_pile_up(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[float] = []
    woken = Reactions.woken

    def count(self: Reactions[Any], now: float) -> list[Request[Any]]:
        asked.append(now)
        return woken(self, now)

    monkeypatch.setattr(Reactions, "woken", count)
    on_io = "LaunchDescription([RegisterEventHandler(OnProcessIO(on_stdout=lambda event: None)), "
    body = TALKER_AND_AGAIN.replace("PERIOD", "0.1").replace("LaunchDescription([", on_io)
    file = write(package, body)
    assert main(["simulate", str(file), "--duration", "20"]) == 0
    assert 190 <= len(asked) <= 210


def test_the_end_of_the_last_process_is_a_shutdown(package: Path) -> None:
    director = directed(
        package,
        f"""
        {TALKER.format("a")},
        RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: [
            LogInfo(msg=f"{{event.reason}} {{event.due_to_sigint}}")])),
        """,
    )
    director.begin(0.0)
    director.started("a", 7, 0.0)
    director.exited("a", 0, 1.0)
    assert director.stopping(1.0) == [Tell("idle False")]


def test_sigterm_ends_a_node_in_order_in_virtual_time(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(
        package,
        """
        from launch.events.process import SignalProcess

        def generate_launch_description():
            end = EmitEvent(event=SignalProcess(signal_number=15, process_matcher=lambda action: True))
            return LaunchDescription([
                Node(package="bot", executable="talker"),
                RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg="bye")])),
                TimerAction(period=1.0, actions=[end]),
            ])
        """,
    )
    assert main(["simulate", str(file), "--duration", "3"]) == 0
    assert "bye" in capsys.readouterr().err
