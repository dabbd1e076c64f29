"""What somebody types who knows ros2: commands, programs and flags that robolink has under another name, or not."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.shared.commands import NOUNS
from robolink.launch.reading.entries import read_launch_file
from robolink.workspace.ros_programs import PACKAGES, PROGRAMS, instead_of

Captured = pytest.CaptureFixture[str]
ADVICE = [*PROGRAMS.values(), *PACKAGES.values()]
DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace of ROS 2's kind, with a package, which is the working directory."""
    package = tmp_path / "src" / "turtles"
    (package / "turtles").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='3'><name>turtles</name></package>")
    (package / "turtles" / "swim.py").write_text("import sys\n\nprint(sys.argv[1:])\n")
    monkeypatch.delenv("ROBOLINK_WORKSPACE", raising=False)
    monkeypatch.chdir(tmp_path)
    return package


@pytest.mark.parametrize(
    ("words", "instead"),
    [
        (["gazebo_ros", "spawn_entity.py"], "'robolink run world' simulates a robot"),
        (["gazebo_ros"], "'robolink run world' simulates a robot"),
        (["controller_manager", "spawner"], "which are C++; 'robolink run world'"),
        (["nav2-velocity-smoother", "velocity_smoother"], "'robolink launch navigate'"),
        (["cartographer_ros", "cartographer_node"], "on a machine with ROS 2"),
        (["moveit_ros_move_group", "move_group"], "on a machine with ROS 2"),
    ],
)
def test_a_program_that_is_not_here_says_what_serves_instead(words: list[str], instead: str, capsys: Captured) -> None:
    assert main(["run", *words]) == 1
    err = capsys.readouterr().err
    assert err.startswith(f"robolink: {' '.join(words[:2])} is not here: ")
    assert (instead in err, err.count("\n"), "/src" in err) == (True, 1, False)


def test_a_launch_file_is_told_the_same(tmp_path: Path) -> None:
    file = tmp_path / "view.yaml"
    file.write_text("nodes:\n  - node: usb_cam usb_cam_node_exe\n")
    with pytest.raises(Exception, match=r"view\.yaml:2:11.*usb_cam usb_cam_node_exe is not here: driver of a camera"):
        read_launch_file(file)


def test_a_package_of_ones_own_goes_first(elsewhere: Path, capsys: Captured) -> None:
    elsewhere.joinpath("package.xml").write_text("<package format='3'><name>turtlesim</name></package>")
    elsewhere.joinpath("turtles").rename(elsewhere / "turtlesim")
    assert main(["run", "turtlesim", "swm"]) == 1
    assert capsys.readouterr().err == (
        "robolink: no executable named 'swm' in package turtlesim (did you mean 'swim'?)\n"
    )


def test_what_nobody_knows_has_nothing_instead() -> None:
    assert instead_of("pkg_a", "talker") is None
    assert instead_of("octomap_server", "x") == PACKAGES["octomap_server"]
    assert instead_of("ros_gz_sim", "create") == PROGRAMS["ros_gz_sim", "create"]
    assert instead_of("ros-gz-sim") == instead_of("ros_gz_bridge", "bridge_node") == PACKAGES["ros_gz*"]


@pytest.mark.parametrize(
    "advice",
    [
        pytest.param(each, marks=pytest.mark.annex("view") if "robolink view" in each else ())
        for each in ADVICE
        if "'robolink " in each or "docs/" in each
    ],
)
def test_what_is_advised_is_there(advice: str, capsys: Captured) -> None:
    commands, pages = re.findall(r"'robolink ([^']+)'", advice), re.findall(r"docs/[\w/]+\.md", advice)
    assert commands or pages, "it advises nothing that can be looked for"
    for command in commands:
        words = [each for each in shlex.split(command) if each.isalpha() and each.islower()]
        verbs = 2 if words[0] in {"plot", "tf", "topic", "world"} else 1
        assert main([*words[:verbs], "--help"]) == 0
        if words[:1] == ["run"] and words[1:] and words[1] != "--list":
            main(["run", "--list"])
            assert re.search(rf"^{words[1]} ", capsys.readouterr().out, re.MULTILINE)
        for flag in re.findall(r"--\w+", command):
            main([*words[:verbs], "--help"])
            assert flag in capsys.readouterr().out
    for page in pages:
        assert (DOCS.parent / page).is_file()


# --- -h ---------------------------------------------------------------------------------------------------------------


def verbs() -> list[list[str]]:
    """Every command, and every noun's verbs."""
    import typer.main

    from robolink.cli.root import Root, app

    root = typer.main.get_command(app)
    assert isinstance(root, Root)
    found: list[list[str]] = [[]]
    for name in NOUNS:
        if not NOUNS[name].hidden:
            command = root.get_command(None, name)
            found += [[name], *([name, verb] for verb in getattr(command, "commands", {}))]
    return found


@pytest.mark.parametrize("words", verbs(), ids=" ".join)
def test_h_is_help_everywhere(words: list[str], capsys: Captured) -> None:
    assert main([*words, "--help"]) == 0
    long = capsys.readouterr().out
    assert main([*words, "-h"]) == 0
    assert capsys.readouterr() == (long, "")
    assert "-h, --help" in long


@pytest.mark.processes
def test_h_behind_a_program_is_the_programs(capsys: Captured) -> None:
    from tests.support.commands import Command

    with Command(0, "run", "src/turtles/turtles/swim.py", "-h", "more") as program:
        program.wait_for("['-h', 'more']")
        assert program.end() == 0


# --- launch -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("verb", ["launch", "simulate"])
@pytest.mark.parametrize(
    ("files", "report"),
    [
        (["a.launch.yaml", "b.yaml", "c.launch.py"], "say which of its launch files, a.launch.yaml or b.yaml or c."),
        (["c.launch.py", "README.md"], "say which of its launch files, c.launch.py"),
        ([], "is a package and has no launch file"),
    ],
)
def test_a_package_alone_is_told_which_launch_files_it_has(
    verb: str, files: list[str], report: str, elsewhere: Path, capsys: Captured
) -> None:
    (elsewhere / "launch").mkdir()
    for each in files:
        (elsewhere / "launch" / each).touch()
    assert main([verb, "turtles"]) == 1
    err = capsys.readouterr().err
    assert (err.count("\n"), report in err) == (1, True)
    assert err.startswith("robolink: turtles is a package")
