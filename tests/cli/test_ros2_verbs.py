"""Every verb of ros2, as Jazzy has them, works or says in one line what does."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.root import OF_ROS2, VERBS_OF_ROS2
from robolink.cli.shared.noun import arranged
from robolink.interfaces.std_msgs.msg import Int32
from tests.support.seen_by_commands import a_node_that_commands_see

Captured = pytest.CaptureFixture[str]

VERBS = {
    "action": "info list send_goal type find echo",
    "bag": "burst convert info list play record reindex",
    "component": "list load standalone types unload",
    "control": "list_controllers load_controller",
    "daemon": "start status stop",
    "doctor": "hello",
    "extension_points": "",
    "extensions": "",
    "interface": "list package packages proto show",
    "launch": "",
    "lifecycle": "get list nodes set",
    "multicast": "receive send",
    "node": "info list",
    "param": "delete describe dump get list load set",
    "pkg": "create executables list prefix xml",
    "plugin": "list",
    "run": "",
    "security": "create_enclave create_key create_keystore create_permission generate_artifacts generate_policy "
    "list_enclaves list_keys",
    "service": "call echo find info list type",
    "test": "",
    "topic": "bw delay echo find hz info list pub type",
    "trace": "pause resume start stop",
    "wtf": "hello",
}
"""Commands of ros2 and their verbs."""
WORDS = [(noun, verb) for noun, verbs in VERBS.items() for verb in verbs.split() or [""]]


@pytest.mark.parametrize(("noun", "verb"), WORDS)
def test_every_verb_works_or_says_what_does(noun: str, verb: str, capsys: Captured) -> None:
    advice = OF_ROS2.get(noun) or VERBS_OF_ROS2.get((noun, verb))
    if advice is None:
        assert main([word for word in (noun, verb, "-h") if word]) == 0
        assert capsys.readouterr().out.startswith("Usage: robolink")
        return
    assert main([word for word in (noun, verb) if word]) == 2
    out, err = capsys.readouterr()
    named = f"{noun} {verb}" if noun not in OF_ROS2 else noun
    assert (out, err.startswith(f"robolink: ros2's '{named}' is not here: "), err.count("\n")) == ("", True, 1)


def test_no_advice_is_for_what_works() -> None:
    assert OF_ROS2.keys() <= VERBS.keys()
    assert VERBS_OF_ROS2.keys() <= set(WORDS)


@pytest.mark.parametrize("advice", [*OF_ROS2.values(), *VERBS_OF_ROS2.values()])
def test_what_is_advised_is_there(advice: str, capsys: Captured) -> None:
    commands, pages = re.findall(r"'robolink ([^']+)'", advice), re.findall(r"docs/[\w/]+\.md", advice)
    assert commands or pages
    for command in commands:
        words = [each for each in shlex.split(command) if re.fullmatch("[a-z_]+", each)]
        if words[:1] == ["run"]:
            main(["run", "--list"])
            assert re.search(rf"^{words[1]} ", capsys.readouterr().out, re.MULTILINE)
        elif words:
            assert main([*words, "--help"]) == 0
    for page in pages:
        assert Path(__file__).parents[2].joinpath(page).is_file()


# --- flags of ros2 ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "rest"),
    [
        ("--include-hidden-topics list", "list --include-hidden-topics"),
        ("list --include-hidden-topics -t", "list --include-hidden-topics -t"),
        ("--include-hidden-nodes list", "list"),
        ("list --no-daemon --spin-time 3 -t", "list -t"),
        ("list --spin-time=3", "list"),
        ("--bad list --spin-time", "--bad list"),
        ("list -- --no-daemon", "list -- --no-daemon"),
    ],
)
def test_flags_go_to_the_verbs_that_know_them(line: str, rest: str) -> None:
    words = line.split()
    assert arranged(words, words.index("list"), {"--include-hidden-topics", "-t"}) == rest.split()


def test_hidden_topics_are_listed_on_either_side_of_the_verb(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    with a_node_that_commands_see(monkeypatch) as node:
        node.create_publisher(Int32, "/_secret", 1)
        for words in ("--include-hidden-topics list", "list --include-hidden-topics", "list --no-daemon"):
            assert main(["topic", *words.split()]) == 0
            assert ("/_secret" in capsys.readouterr().out) == ("hidden" in words)


@pytest.mark.parametrize("verb", ["status", "start", "stop"])
def test_no_daemon_is_needed(verb: str, capsys: Captured) -> None:
    assert main(["daemon", verb]) == 0
    assert "robolink needs no daemon" in capsys.readouterr().out
