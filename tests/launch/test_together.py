"""Nodes that share a process are what each would be alone: names, parameters, remappings, arguments, and the end."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Context
from robolink.cli.running_nodes import container
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import String
from robolink.launch import shared_process
from robolink.launch.shared_process import Member, TogetherError
from robolink.logging import LoggingSeverity, get_logger
from robolink.supervisor import Process, Supervisor
from robolink.utilities import set_default_context
from robolink.workspace import VARIABLE, NodeLoadError, find_node

PATIENCE = 60.0

TALKER = """
import sys

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node

def main():
    pass

class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.argv = list(sys.argv)
        self.declare_parameter('word', 'hi')
        self.heard = []
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.create_subscription(String, 'chatter', lambda message: self.heard.append(message.data), 10)

class Needy(Node):
    def __init__(self, what):
        super().__init__('needy')

class Wrong(Node):
    def __init__(self):
        super().__init__('wrong')
        self.declare_parameter('same', 1)
        self.declare_parameter('same', 2)

class Raising(Node):
    def __init__(self):
        super().__init__('raising')
        raise KeyError('in my own code')
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "talker.py"
    path.write_text(TALKER)
    return path


@pytest.fixture
def make(virtual: Context, file: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Any]]:
    """Makes a node of the file above in virtual time, given its arguments."""
    monkeypatch.setattr(sys, "argv", sys.argv)
    set_default_context(virtual)

    def make(what: str, *args: str, name: str = "r0/it") -> Any:
        source = find_node(f"{file}:{what}")
        return container.make(Member(name, source.spec, [*args]), source, virtual)

    yield make
    set_default_context(None)


def test_each_has_its_own_arguments(make: Callable[..., Any], executor: SingleThreadedExecutor) -> None:
    left = make("Talker", "-v", "--ros-args", "-r", "__ns:=/left", "-p", "word:=one", "-r", "chatter:=/right/chatter")
    right = make("Talker", "--ros-args", "-r", "__ns:=/right", "-r", "__node:=other")
    plain = make("Talker")
    assert [each.get_fully_qualified_name() for each in (left, right, plain)] == [
        "/left/talker",
        "/right/other",
        "/talker",
    ]
    assert [each.get_parameter("word").value for each in (left, right, plain)] == ["one", "hi", "hi"]
    assert left.argv[1:3] == ["-v", "--ros-args"]
    assert len(plain.argv) == 1
    for each in (left, right, plain):
        executor.add_node(each)
    left.publisher.publish(String(data="over"))
    executor.spin_once(timeout_sec=1.0)
    executor.spin_once(timeout_sec=1.0)
    assert (left.heard, right.heard, plain.heard) == (["over"], ["over"], [])


def test_what_one_is_given_is_none_of_the_others(
    make: Callable[..., Any], executor: SingleThreadedExecutor, virtual: Context, log_lines: list[Record]
) -> None:
    for name, parameter in (("a", "word:=x"), ("b", "wrod:=x"), ("c", "colour:=x"), ("d", "colour:=x")):
        executor.add_node(make("Talker", "--ros-args", "-r", f"__node:={name}", "-p", parameter))
    virtual.shutdown()
    assert [(each.name, each.message) for each in log_lines] == [
        ("b", "parameter 'wrod' was given, but no node declared it (did you mean 'word'?)"),
        ("c", "parameter 'colour' was given, but no node declared it"),
        ("d", "parameter 'colour' was given, but no node declared it"),
    ]


def test_a_level_for_all_loggers_is_for_those_of_the_node(make: Callable[..., Any]) -> None:
    quiet = make("Talker", "--ros-args", "-r", "__node:=quiet", "--log-level", "error", "--log-level", "x.y:=debug")
    assert quiet.get_logger().get_effective_level() is LoggingSeverity.ERROR
    assert make("Talker").get_logger().get_effective_level() is LoggingSeverity.INFO
    assert get_logger("x.y").get_effective_level() is LoggingSeverity.DEBUG


@pytest.mark.parametrize(
    ("what", "report"),
    [
        ("Needy", "r0/it: Needy.__init__ needs 'what': give a default value"),
        ("Wrong", "r0/it: "),
        ("main", "r0/it: {file}:main is not a Node class, and needs a process of its own: leave `process` out"),
        ("Talker --ros-args -x", "r0/it: unknown ROS arguments: ['-x']"),
    ],
)
def test_what_cannot_be_made_says_which(make: Callable[..., Any], file: Path, what: str, report: str) -> None:
    name, *args = what.split()
    with pytest.raises(NodeLoadError) as caught:
        make(name, *args)
    assert str(caught.value).startswith(report.format(file=file))


def test_what_the_users_code_raises_stays_what_it_is(
    make: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(KeyError, match="in my own code"):
        make("Raising")
    assert capsys.readouterr().err == "robolink: r0/it raised while it was made:\n"


@given(st.lists(st.builds(Member, st.text(), st.text(), st.lists(st.text()))))
def test_what_is_written_is_read(members: list[Member]) -> None:
    assert shared_process.read(shared_process.written(members)) == members


@given(st.binary())
def test_nonsense_is_refused(text: bytes) -> None:
    with contextlib.suppress(TogetherError):
        assert shared_process.read(text) == []


@pytest.mark.processes
def test_a_process_reads_its_input_whole() -> None:
    """More than a pipe holds; nobody waits for a process that reads none of it."""
    text = b"0123456789" * 50_000
    counts = "import hashlib, sys; print(hashlib.sha256(sys.stdin.buffer.read()).hexdigest())"
    output = io.StringIO()
    assert Supervisor([Process("reader", [sys.executable, "-c", counts], input=text)], output=output).run() == 0
    assert f"[reader] {hashlib.sha256(text).hexdigest()}\n" in output.getvalue()
    assert Supervisor([Process("deaf", [sys.executable, "-c", ""], input=text)], output=output).run() == 0


# --- As a process -----------------------------------------------------------------------------------------------------

SPINNING = """
import rclpy
from rclpy.node import Node

class Spinning(Node):
    def __init__(self):
        super().__init__('spinning')
        self.what = self.declare_parameter('what', 'idle').value
        self.create_timer(0.01, self.tick)

    def tick(self):
        if self.what != 'idle':
            print('ticks', self.get_name(), flush=True)
        if self.what == 'raise':
            raise ValueError('out of order')
        if self.what == 'shutdown':
            rclpy.shutdown()
        self.what = 'idle'

    def destroy_node(self):
        print('end of', self.get_name(), flush=True)
        super().destroy_node()
"""


def members(file: Path, *whats: str) -> bytes:
    return shared_process.written(
        [
            Member(f"n{index}", str(file), ["--ros-args", "-r", f"__node:=n{index}", "-p", f"what:={what}"])
            for index, what in enumerate(whats)
        ]
    )


@pytest.fixture
def spinning(tmp_path: Path) -> Path:
    path = tmp_path / "spinning.py"
    path.write_text(SPINNING)
    return path


def started(folder: Path) -> subprocess.Popen[bytes]:
    environ = {name: value for name, value in os.environ.items() if name != VARIABLE}
    return subprocess.Popen(
        [sys.executable, "-m", "robolink", shared_process.COMMAND],
        env=environ | {"ROBOLINK_TRANSPORT": "memory", "PYTHONUNBUFFERED": "1"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=folder,
    )


def outcome(folder: Path, text: bytes) -> tuple[int, list[str], str]:
    with started(folder) as process:
        out, err = process.communicate(text, timeout=PATIENCE)
        return process.returncode, out.decode().splitlines(), err.decode()


@pytest.mark.processes
def test_they_end_together_with_shutdown(spinning: Path) -> None:
    code, lines, errors = outcome(spinning.parent, members(spinning, "idle", "shutdown", "idle"))
    assert (code, errors) == (0, "")
    assert sorted({*lines}) == ["end of n0", "end of n1", "end of n2", "ticks n1"]


@pytest.mark.processes
def test_a_callback_that_raises_ends_them_all(spinning: Path) -> None:
    code, lines, errors = outcome(spinning.parent, members(spinning, "idle", "raise"))
    assert code == 1
    assert {*lines} >= {"end of n0", "end of n1"}
    told = errors + "\n".join(lines)
    assert told.count("ValueError: out of order") == 1
    assert "n1 raised in a callback:" in told


@pytest.mark.processes
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send")
def test_a_signal_ends_them_in_order(spinning: Path, number: signal.Signals) -> None:
    with started(spinning.parent) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(members(spinning, "idle", "tick"))
        process.stdin.close()
        assert process.stdout.readline() == b"ticks n1\n"
        process.send_signal(number)
        assert process.stdout.read().split() == b"end of n1 end of n0".split()
        assert process.wait(PATIENCE) == 0


@pytest.mark.processes
def test_the_one_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "both.py").write_text(TALKER)
    file = str(tmp_path / "both.py")
    made = Member("fine", f"{file}:Talker", [])
    code, _, errors = outcome(tmp_path, shared_process.written([made, Member("r1/bad", f"{file}:Raising", [])]))
    assert code == 1
    first, *_, last = errors.splitlines()
    assert first == "robolink: r1/bad raised while it was made:"
    assert last == "KeyError: 'in my own code'"
    assert "container.py" not in errors
    code, _, errors = outcome(tmp_path, shared_process.written([made, Member("r1/bad", f"{file}:Wrong", [])]))
    assert code == 1
    assert errors.startswith("robolink: r1/bad: ")
    assert errors.endswith(f"(at {file}:{TALKER[: TALKER.index('2)')].count(chr(10)) + 1})\n")
    assert errors.count("\n") == 1


@pytest.mark.processes
def test_one_alone_is_run_as_a_command_line_would_that_had_room_for_it(tmp_path: Path) -> None:
    """A robot's description is longer than the 131,072 bytes that Linux grants an argument."""
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    text = "<robot/>" * 40_000
    member = Member("script", str(script), ["--fast", "--ros-args", "-p", f"description:='{text}'"])
    assert outcome(tmp_path, shared_process.written([member])) == (3, ["['--fast']", str(len(text))], "")


SCRIPT = """
import sys
import rclpy

def main():
    rclpy.init()
    node = rclpy.create_node('script')
    print(sys.argv[1:2])
    print(len(node.declare_parameter('description', '').value))
    rclpy.shutdown()
    return 3
"""


@pytest.mark.processes
def test_nonsense_on_standard_input_is_one_line(tmp_path: Path) -> None:
    assert outcome(tmp_path, b"[1]") == (
        1,
        [],
        "robolink: standard input: expected a list of nodes in JSON: Expected `object`, got `int` - at `$[0]`\n",
    )
