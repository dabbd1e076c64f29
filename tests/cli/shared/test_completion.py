"""Shell completion: what is offered, in the shells' own protocol, and by a real bash; never an error."""

from __future__ import annotations

import os
import select
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli.main import COMPLETION, main
from robolink.cli.shared import complete
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.transport.memory import MemoryTransport
from robolink.wire import NodeToken, format_token
from robolink.workspace import VARIABLE
from tests.support.programs import Program
from tests.support.seen_by_commands import a_node_that_commands_see, made

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    monkeypatch.setattr(complete, "WITHIN", 30.0)
    with a_node_that_commands_see(monkeypatch) as robot:
        robot.create_publisher(String, "/chatter", 10)
        robot.create_subscription(String, "chat", print, 10)
        robot.create_publisher(String, "/_quiet", 10)
        robot.create_service(Trigger, "/reset", lambda request, response: response)
        robot.create_client(Trigger, "/unserved")
        yield robot


@pytest.fixture
def tab(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> Tab:
    return Tab(monkeypatch, capsys)


class Tab:
    """Presses the tab key after a line: gives what is offered, by bash's protocol."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
        self.monkeypatch, self.capsys = monkeypatch, capsys

    def __call__(self, line: str) -> list[str]:
        words = line.split(" ")
        self.ask("complete_bash", COMP_WORDS=line, COMP_CWORD=str(len(words) - 1))
        return self.output().split()  # an empty answer is an empty line

    def ask(self, instruction: str, **environ: str) -> int:
        with self.monkeypatch.context() as patch:
            for name, value in {COMPLETION: instruction, **environ}.items():
                patch.setenv(name, value)
            return main([])

    def output(self) -> str:
        out, err = self.capsys.readouterr()
        assert err == ""
        return out


# --- commands and options -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("robolink to", ["topic", "top"]),
        ("robolink la", ["launch"]),
        ("robolink topic ec", ["echo"]),
        ("robolink service ", ["list", "type", "find", "info", "call", "echo"]),
        ("robolink node in", ["info"]),
        ("robolink --sh", ["--show-completion"]),
        ("robolink service call --ti", ["--timeout"]),
        ("robolink node info --inc", ["--include-hidden"]),
        ("robolink zzz", []),
    ],
)
def test_commands_verbs_and_options_are_completed(line: str, offered: list[str], tab: Tab) -> None:
    assert tab(line) == offered


def test_the_commands_themselves_are_offered_without_importing_them(tab: Tab) -> None:
    before = dict(sys.modules)
    for name in [
        each for each in sys.modules if each in ("robolink.cli.topic.command", "robolink.cli.running_nodes.run")
    ]:
        tab.monkeypatch.delitem(sys.modules, name)
    assert {"run", "launch", "topic", "node", "service"} <= set(tab("robolink "))
    assert "robolink.cli.topic.command" not in sys.modules
    sys.modules.update(before)


@pytest.mark.parametrize(
    "line",
    [
        "robolink nonsense ",
        "robolink nonsense x y",
        "robolink topic nonsense ",
        "robolink run --nonsense ",
        "robolink 'x",
    ],
)
def test_what_is_no_command_is_met_with_silence(line: str, tab: Tab) -> None:
    assert isinstance(tab(line), list)


# --- live names -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("robolink topic echo /ch", ["/chatter"]),
        ("robolink topic echo /lab/", ["/lab/chat"]),
        ("robolink topic echo la", ["lab/chat"]),
        ("robolink topic echo /_", ["/_quiet"]),
        ("robolink topic echo /", ["/chatter", "/lab/chat", "/parameter_events"]),
        ("robolink topic echo /chatter ", ["std_msgs/msg/String"]),
        (
            "robolink topic echo /chatter Twis",
            ["Twist", "TwistStamped", "TwistWithCovariance", "TwistWithCovarianceStamped"],
        ),
        ("robolink node info ", ["/lab/robot"]),
        ("robolink node info lab", ["lab/robot"]),
        ("robolink service call /re", ["/reset"]),
        ("robolink service call /un", []),
        ("robolink service call /reset ", ["std_srvs/srv/Trigger"]),
        ("robolink service call /reset std_srvs/srv/Set", ["std_srvs/srv/SetBool"]),
        ("robolink service find std_srvs/srv/T", ["std_srvs/srv/Trigger"]),
        ("robolink plot odom /ch", ["/chatter"]),
        ("robolink plot topic /chatter lab/", ["lab/chat"]),
        ("robolink plot path --world cor", ["corners"]),
    ],
)
@pytest.mark.usefixtures("node")
def test_live_names_and_types_are_completed(line: str, offered: list[str], tab: Tab) -> None:
    assert tab(line) == offered


@pytest.mark.usefixtures("node")
def test_zsh_and_fish_are_offered_the_same(tab: Tab) -> None:
    assert tab.ask("complete_zsh", _TYPER_COMPLETE_ARGS="robolink topic echo /ch") == 0
    assert tab.output() == "_arguments '*: :((\"/chatter\"))'\n"
    fish = {"_TYPER_COMPLETE_ARGS": "robolink topic echo /ch", "_TYPER_COMPLETE_FISH_ACTION": "get-args"}
    assert tab.ask("complete_fish", **fish) == 0
    assert tab.output() == "/chatter\n"
    assert tab.ask("complete_fish", **{**fish, "_TYPER_COMPLETE_FISH_ACTION": "is-args"}) == 0
    nothing = {**fish, "_TYPER_COMPLETE_ARGS": "robolink topic echo /zzz", "_TYPER_COMPLETE_FISH_ACTION": "is-args"}
    assert tab.ask("complete_fish", **nothing) == 1


def test_what_a_shell_would_run_is_never_offered(tab: Tab) -> None:
    tab.monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://strangers")
    stranger = MemoryTransport("strangers")
    good = format_token(NodeToken(0, "abc", "0", "/", "/", "good"))
    for name in ["good", "$(reboot)", "`reboot`", "a'b", 'a"b', "a;b", "a b", "a\nb", "*"]:
        stranger.announce(good.removesuffix("good") + name)
    assert complete.node_names("") == ["/good"]
    assert tab.ask("complete_zsh", _TYPER_COMPLETE_ARGS="robolink node info /") == 0
    assert tab.output() == "_arguments '*: :((\"/good\"))'\n"
    stranger.close()


MANY_NAMES = st.lists(st.text("/a_1~-:. '\"$`\\\n;&|()<>*?[]{}!#ä", max_size=4), max_size=8)


@given(st.text("/a", max_size=2), MANY_NAMES)
def test_all_that_goes_on_from_what_is_there_is_offered_and_nothing_else(incomplete: str, names: list[str]) -> None:
    plain = {each for each in names if each and not set(each) - set("/a_1~-:.")}
    assert set(complete.offered(names, incomplete)) == {each for each in plain if each.startswith(incomplete)}


def test_hidden_nodes_are_offered_to_whoever_begins_one(node: Node) -> None:
    _hidden = made(node.context, "_shy", "/lab")
    assert complete.node_names("/lab/") == ["/lab/robot"]
    assert complete.node_names("/lab/_") == ["/lab/_shy"]


# --- types and files ------------------------------------------------------------------------------------------


def test_types_are_offered_in_full_or_short() -> None:
    assert complete.message_types("std_msgs/msg/Int6") == ["std_msgs/msg/Int64", "std_msgs/msg/Int64MultiArray"]
    assert complete.message_types("TwistSt") == ["TwistStamped"]
    assert complete.service_types("std_srvs/srv/S") == ["std_srvs/srv/SetBool"]
    assert {"std_msgs/msg/String", "std_srvs/srv/Empty"} <= set(complete.interface_types("std_"))


def test_what_the_workspace_has_is_offered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tab: Tab) -> None:
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    (tmp_path / "nodes" / "my_talker.py").write_text("")
    (tmp_path / "nodes" / "my$(reboot).py").write_text("")
    (tmp_path / "configs" / "my_lab.yaml").write_text("nodes: []")
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert tab("robolink run my") == ["my_talker"]
    assert tab("robolink launch my") == ["my_lab"]
    monkeypatch.delenv(VARIABLE)
    assert tab(f"robolink run --workspace {tmp_path} my") == ["my_talker"]


# --- what goes wrong ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("variable", "value"),
    [
        ("ROBOLINK_TRANSPORT", "carrier-pigeon://"),
        ("ROS_DOMAIN_ID", "many"),
        ("ROBOLINK_NETWORK", "/no/such/file"),
        ("ZENOH_CONFIG_OVERRIDE", "nonsense"),
    ],
)
def test_wrong_settings_are_met_with_silence(variable: str, value: str, tab: Tab) -> None:
    tab.monkeypatch.setenv(variable, value)
    assert tab("robolink node info /") == []
    assert tab("robolink topic echo /x std_msgs/msg/Str") == ["std_msgs/msg/String"]


def test_a_network_that_hangs_is_waited_for_only_a_moment(tab: Tab) -> None:
    answers, ended = threading.Event(), threading.Event()

    def hang(*_: object) -> None:
        answers.wait(60)
        ended.set()

    tab.monkeypatch.setattr(complete, "_look", hang)
    assert tab("robolink node info /") == []
    assert not ended.is_set()
    answers.set()
    assert ended.wait(60)


def test_what_is_known_in_time_is_offered(tab: Tab) -> None:
    token = format_token(NodeToken(7, "abc", "0", "/", "/", "early"))
    tab.monkeypatch.setattr(complete, "_look", lambda texts, finished: texts.update({token: True}))
    tab.monkeypatch.setattr(complete, "WITHIN", 1.0)
    assert tab("robolink node info /") == ["/early"]


# --- the shells themselves ------------------------------------------------------------------------------------

TALKER = """
import robolink as rclpy
from robolink.interfaces.std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("talker", namespace="lab")
node.create_publisher(String, "chatter", 10)
print("up", flush=True)
rclpy.spin(node)
"""
PATIENT = (
    "from robolink.cli.shared import complete; from robolink.cli.main import main; "
    "complete.WITHIN = 30.0; raise SystemExit(main())"
)
"""The command, on a machine that may be busy."""
SHIM = '#!/bin/sh\nif [ -n "$_ROBOLINK_COMPLETE" ]; then exec {python} -c "{code}" "$@"; fi\necho "GOT $*"\n'

bash_only = pytest.mark.skipif(
    sys.platform == "win32" or shutil.which("bash") is None, reason="there is no bash on this machine"
)


@pytest.fixture
def shell(tmp_path: Path) -> dict[str, str]:
    """Give the environment of a shell in which robolink is on the path, and says what it was given."""
    folder = tmp_path / "bin"
    folder.mkdir()
    (folder / "robolink").write_text(SHIM.format(python=sys.executable, code=PATIENT))
    (folder / "robolink").chmod(0o755)
    path = f"{folder}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "HOME": str(tmp_path), "PS1": "$ ", "TERM": "dumb"}


@bash_only
@pytest.mark.processes
def test_a_tab_in_bash_completes_a_live_name(tmp_path: Path, shell: dict[str, str], domain: int) -> None:
    script = tmp_path / "completion.sh"
    asked = {**shell, COMPLETION: "source_bash"}
    script.write_text(subprocess.run(["robolink"], env=asked, check=True, capture_output=True, text=True).stdout)
    (tmp_path / "programs").mkdir()
    with Program(tmp_path / "programs", TALKER, domain) as talker:
        assert talker.line() == "up"
        typed = [f"source {script}", "robolink topic echo /lab/ch\t", "robolink no\tin\t/la\t"]
        typed += ["robolink run world -p world:=cor\t", "exit"]
        said = typed_into_bash(typed, {**shell, "ROS_DOMAIN_ID": str(domain)})
    assert "GOT topic echo /lab/chatter" in said
    assert "GOT node info /lab/talker" in said
    assert "GOT run world -p world:=corners" in said


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("robolink run world -p wor", ["world:="]),
        ("robolink run world -p world:=corn", ["world:=corners"]),
        ("robolink run world -p world\n:=\ncorn", ["corners"]),
        ("robolink launch wander world\n:=\ncorn", ["corners"]),
        ("robolink run talker -p world\n:=\ncorn", []),
        ("robolink run world -p seed\n:=", []),
    ],
)
def test_the_world_of_a_parameter_is_completed(words: str, offered: list[str], tab: Tab) -> None:
    words = words.replace(" ", "\n")
    tab.ask("complete_bash", COMP_WORDS=words, COMP_CWORD=str(words.count("\n")))
    assert tab.output().split() == offered


def typed_into_bash(lines: list[str], environ: dict[str, str]) -> str:
    """Type lines into a bash on a terminal; what it showed."""
    if sys.platform == "win32":
        pytest.skip("there are no pseudo-terminals")
    import pty

    ours, theirs = pty.openpty()
    with subprocess.Popen(
        ["bash", "--noprofile", "--norc", "-i"], stdin=theirs, stdout=theirs, stderr=theirs, env=environ, close_fds=True
    ) as bash:
        os.close(theirs)
        said = ""
        for line in lines:
            os.write(ours, f"{line}\n".encode())
        deadline = time.monotonic() + 60
        while bash.poll() is None and time.monotonic() < deadline:
            if select.select([ours], [], [], 0.1)[0]:
                try:
                    said += os.read(ours, 65536).decode(errors="replace")
                except OSError:  # Linux's way to say that the other side is closed
                    break
        bash.kill()
    os.close(ours)
    return said


@bash_only
@pytest.mark.processes
def test_completion_is_shown_and_installed_for_the_shell_that_asks(tmp_path: Path, shell: dict[str, str]) -> None:
    robolink = f"{sys.executable} -m robolink"
    shown = subprocess.run(
        ["bash", "--norc", "-c", f"{robolink} --show-completion; true"],
        env=shell,
        capture_output=True,
        text=True,
        check=True,
    )
    assert (shown.stderr, "complete -o default -F _robolink_completion robolink" in shown.stdout) == ("", True)
    installed = subprocess.run(
        ["bash", "--norc", "-c", f"{robolink} --install-completion; true"],
        env=shell,
        capture_output=True,
        text=True,
        check=True,
    )
    assert (installed.stderr, "completion installed in" in installed.stdout) == ("", True)
    assert shown.stdout.strip() in (tmp_path / ".bash_completions" / "robolink.sh").read_text()
    assert "robolink.sh" in (tmp_path / ".bashrc").read_text()


@pytest.mark.processes
def test_a_completion_is_answered_by_a_process_of_its_own(domain: int) -> None:
    environ = {**os.environ, "ROS_DOMAIN_ID": str(domain), COMPLETION: "complete_bash"}
    environ |= {"COMP_WORDS": "robolink topic echo /", "COMP_CWORD": "3"}
    done = subprocess.run([sys.executable, "-m", "robolink"], env=environ, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
