"""Packages and their executables are found in a source tree, without a build and without running their setup.py."""

from __future__ import annotations

import itertools
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from robolink import interfaces
from robolink.cli.main import main
from robolink.cli.running_nodes.runner import NodeCommand, found
from robolink.exceptions import NotFoundError
from robolink.workspace import (
    VARIABLE,
    NodeLoadError,
    NodeSource,
    built_in_workspace,
    executable,
    find_package,
    list_executables,
    list_packages,
    load_node,
    workspace_of,
)
from robolink.workspace.packages import source_packages
from tests.support.ros_tree import write_package


def ran(*words: str, before: int | None = None) -> Any:
    """What the function returns that `robolink run WORDS` finds."""
    source, _ = found(NodeCommand(words[0], list(words[1:]), len(words) - 1 if before is None else before), None)
    runnable: Any = load_node(source)
    return runnable()


def test_packages_are_found_from_anywhere_in_the_tree(top: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in (".", "src", "src/pkg_a", "src/pkg_a/pkg_a", "src/repo"):
        monkeypatch.chdir(top / folder)
        assert workspace_of(Path()) == top
        assert list(list_packages()) == ["pkg_a", "pkg_interfaces", "pkg_b", "ros2_ws", "robolink"]
    assert find_package("pkg-a") == top / "src/pkg_a"
    assert find_package("pkg_off") is None
    assert find_package("robolink") == built_in_workspace()


@pytest.mark.usefixtures("top")
def test_a_console_script_is_imported_as_a_module_of_its_package() -> None:
    assert ran("pkg_a", "first") == "aa"
    assert ran("pkg-a", "first", "and", "more") == "aa"
    assert sys.modules["pkg_a.first"].__package__ == "pkg_a"


@pytest.mark.usefixtures("top")
def test_a_module_that_setup_py_does_not_name_runs_too() -> None:
    assert ran("pkg_a", "second") == 2


@pytest.mark.usefixtures("top")
def test_packages_import_each_other() -> None:
    assert ran("pkg_b", "run") == "a"


def test_the_types_of_the_tree_are_importable(top: Path) -> None:
    (top / "src/pkg_a/pkg_a/third.py").write_text(
        "from pkg_interfaces.msg import Count\ndef main(): return Count(n=4)\n"
    )
    assert ran("pkg_a", "third").n == 4
    assert "pkg_interfaces/msg/Count" in interfaces.names()


def test_a_copy_that_was_installed_before_is_not_run(top: Path, tmp_path: Path) -> None:
    write_package(tmp_path / "site", "pkg_a", {"first.py": "def main(): return 'old'\n"})
    sys.path.insert(0, str(tmp_path / "site/pkg_a"))
    assert ran("pkg_a", "first") == "aa"


@pytest.mark.parametrize("path", ["src/pkg_a/pkg_a/by_path.py", "src/repo/deeper/pkg_b/pkg_b/by_path.py"])
def test_a_file_of_a_package_that_is_run_by_its_path_finds_its_package(top: Path, path: str) -> None:
    (top / path).write_text(
        "from pkg_a.helpers import WORD\nfrom pkg_b import run\ndef main(): return WORD, run.main()\n"
    )
    assert ran(path) == ("a", "a")


def test_a_script_in_a_package_runs_as_python_m_does(top: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (
        "import sys\nfrom .helpers import WORD\nif __name__ == '__main__':\n    print(WORD, sys.argv[0] == __file__)\n"
    )
    (top / "src/pkg_a/pkg_a/script.py").write_text(text)
    ran("pkg_a", "script")
    assert capsys.readouterr().out == "a True\n"


def test_executables_of_ros_2s_own_packages_that_robolink_has(top: Path) -> None:
    def asked(*words: str) -> tuple[NodeSource, list[str]]:
        return found(NodeCommand(words[0], list(words[1:]), len(words) - 1), None)

    source, args = asked("tf2_ros", "static_transform_publisher", "--x", "1")
    assert source.path == built_in_workspace() / "nodes/static_transform_publisher.py"
    assert args == ["--x", "1"]
    assert asked("teleop-twist-keyboard", "teleop_twist_keyboard")[0].attribute == "main"
    with pytest.raises(NotFoundError, match="robolink needs no router"):
        asked("rmw_zenoh_cpp", "rmw_zenohd")
    own = write_package(top / "src", "tf2_ros", {"static_transform_publisher.py": ""})
    assert asked("tf2_ros", "static_transform_publisher")[0].path == own / "tf2_ros/static_transform_publisher.py"


# --- which of the two is meant ----------------------------------------------------------------------------------


def test_two_words_are_a_package_and_its_executable_only_if_both_are_there(top: Path) -> None:
    (top / "nodes").mkdir()
    for name in ("talker", "pkg_a", "ros2_ws"):
        (top / f"nodes/{name}.py").write_text("def main(): pass\n")

    def asked(*words: str, before: int | None = None) -> tuple[str, list[str]]:
        count = len(words) - 1 if before is None else before
        source, args = found(NodeCommand(words[0], list(words[1:]), count), None)
        return source.name, args

    assert asked("talker", "first") == ("talker", ["first"])
    assert asked("pkg_a", "first", "x") == ("first", ["x"])
    assert asked("pkg_a", "frist", "x") == ("pkg_a", ["frist", "x"])  # the node of that name; the words are its own
    assert asked("pkg_a", "first", before=0) == ("pkg_a", ["first"])  # robolink run pkg_a -- first
    assert asked("pkg_a") == ("pkg_a", [])
    assert asked("ros2_ws", "talker") == ("talker", [])
    assert asked("robolink", "world", "--", "x") == ("world", ["--", "x"])


@pytest.mark.usefixtures("top")
@pytest.mark.parametrize(
    ("words", "report"),
    [
        (["pkg_a", "frist"], "no executable named 'frist' in package pkg_a (did you mean 'first'?)"),
        (["pkg_a"], "pkg_a is a package: say which of its executables, first"),
        (["robolink", "wrold"], "no executable named 'wrold' in package robolink (did you mean 'world'?)"),
        (["pkg_a", "x"], "no executable named 'x' in package pkg_a, which has first"),
        (["pkg_b", "--", "run"], "pkg_b is a package: say which of its executables, run"),
        (["pkg_interfaces", "x"], "no node named 'pkg_interfaces' in {top} or robolink itself"),
        (["pkg_c", "first"], "no node or package named 'pkg_c' in {top} (did you mean 'pkg_b'?)"),
        (["wrold", "first"], "no node or package named 'wrold' in {top} (did you mean 'world'?)"),
        (["follow"], "'follow' is a launch file, and no node: robolink launch follow"),
        (["system.yaml", "x"], "'system.yaml' is a launch file, and no node: robolink launch system.yaml"),
        (["corners"], "'corners' is a world, and no node: robolink run world -p world:=corners"),
        (["room.wbt"], "'room.wbt' is a world, and no node: robolink run world -p world:=room.wbt"),
        (["wrold"], "no node named 'wrold' in {top} or robolink itself (did you mean 'world'?)"),
        (
            ["first"],
            (
                "no node named 'first' in {top} or robolink itself (did you mean 'first_node'?); "
                "package pkg_a has one: 'pkg_a first'"
            ),
        ),
    ],
)
def test_what_is_not_there_is_one_line(
    words: list[str], report: str, capsys: pytest.CaptureFixture[str], top: Path
) -> None:
    for name in ("system.yaml", "room.wbt"):
        (top / name).touch()
    assert main(["run", *words]) == 1
    assert capsys.readouterr().err == f"robolink: {report.format(top=top)}\n"


def test_a_package_outside_of_a_workspace_is_told_where_it_would_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    assert main(["run", "pkg_a", "first"]) == 1
    assert capsys.readouterr().err == (
        "robolink: no node or package named 'pkg_a': this folder is in no workspace; go to the one with its src/, "
        "or name it with --workspace\n"
    )


@pytest.mark.parametrize(("here", "place"), [("", "src/pkg_a"), ("src", "pkg_a"), ("src/pkg_a", "{top}/src/pkg_a")])
def test_a_folder_without_a_package_xml_is_told_so(
    here: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    top = tmp_path.resolve()
    (top / "src/pkg_a").mkdir(parents=True)
    (top / "src/pkg_a/first.py").touch()
    monkeypatch.chdir(top / here)
    assert main(["run", "pkg_a", "first"]) == 1
    assert capsys.readouterr().err == (
        f"robolink: no node or package named 'pkg_a': the folder {Path(place.format(top=top))} has no package.xml, "
        "by which a package is known: add one, or run a file of it\n"
    )


def test_a_console_script_without_its_file_is_told_so(top: Path) -> None:
    write_package(top / "src", "pkg_bad", {"firts.py": ""}, "first = pkg_bad.first:main", "odd = pkg_bad.firts:mian")
    missing = top / "src/pkg_bad/pkg_bad/first.py"
    with pytest.raises(NodeLoadError) as caught:
        ran("pkg_bad", "first")
    said = f"first is pkg_bad.first, says its package, but there is no {missing} (did you mean 'firts.py'?)"
    assert str(caught.value) == said
    with pytest.raises(NotFoundError, match="no class or function named 'mian'"):
        ran("pkg_bad", "odd")


def test_a_lone_package_is_a_workspace_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = write_package(tmp_path, "alone", {"node.py": ""}, "node = alone.node:main")
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(folder / "alone")
    assert workspace_of(Path()) == folder
    assert find_package("alone") == folder
    source = executable(folder, "node")
    assert source is not None
    assert (source.module, source.attribute, source.root) == ("alone.node", "main", folder)


def test_packages_may_lie_as_deep_as_ros_2s_own(tmp_path: Path) -> None:
    folder = write_package(tmp_path / "src/ros2/examples/rclpy/topics", "minimal_publisher", {})
    assert source_packages(tmp_path) == {"minimal_publisher": folder}


def test_a_package_that_is_added_or_renamed_later_is_seen(tmp_path: Path) -> None:
    seconds = itertools.count(2 * 10**9)

    def later(changed: Path) -> None:  # since a file system's clock ticks slowly
        os.utime(changed, (0, next(seconds)))

    first = write_package(tmp_path / "src/group", "first", {})
    assert source_packages(tmp_path) == {"first": first}
    second = write_package(tmp_path / "src/group", "second", {})
    later(tmp_path / "src/group")
    assert source_packages(tmp_path) == {"first": first, "second": second}
    (second / "package.xml").write_text("<package><name>third</name></package>")
    later(second / "package.xml")
    assert source_packages(tmp_path) == {"first": first, "third": second}
    (first / "COLCON_IGNORE").touch()
    later(first)
    assert source_packages(tmp_path) == {"third": second}
    (first / "COLCON_IGNORE").unlink()
    later(first)
    assert source_packages(tmp_path) == {"first": first, "third": second}


def test_any_python_project_is_no_workspace(tmp_path: Path) -> None:
    (tmp_path / "src/thing").mkdir(parents=True)
    (tmp_path / "src/thing/setup.py").touch()
    assert workspace_of(tmp_path) is None
    assert list(source_packages(tmp_path)) == ["thing"]


def test_the_workspace_is_a_package_by_the_name_of_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = tmp_path / "meu_robo_py"
    for folder in ("nodes", "configs"):
        (home / folder).mkdir(parents=True)
    (home / "nodes/primeiro_node.py").write_text("def main(args=None): return 1\n")
    monkeypatch.chdir(home)
    monkeypatch.delenv(VARIABLE, raising=False)
    assert ran("meu_robo_py", "primeiro_node") == 1
    assert ran("primeiro_node") == 1


@pytest.mark.usefixtures("top")
def test_they_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "--list"]) == 0
    rows = [line.split("  ")[0] for line in capsys.readouterr().out.splitlines()]
    assert rows[-2:] == ["pkg_a first", "pkg_b run"]  # a package without a list of its own has its modules
    assert "world" in rows
    assert {name: [each.name for each in nodes] for name, nodes in list_executables().items()} == {
        "pkg_a": ["first"],
        "pkg_b": ["run"],
    }


# --- repositories -----------------------------------------------------------------------------------------------


def packages_of(here: Path) -> tuple[Path | None, list[str]]:
    found = workspace_of(here)
    return found, [] if found is None else list(source_packages(found))


def test_a_clone_of_packages_without_src_works_from_its_own_folder(tmp_path: Path) -> None:
    clone = tmp_path.resolve() / "robot_ros2"
    for place, name in (("", "robot_bringup"), ("", "robot_description"), ("drivers/deep", "robot_driver")):
        write_package(clone / place, name, {"a.py": ""})
    (clone / "drivers/off").mkdir()
    (clone / "drivers/off/AMENT_IGNORE").touch()
    write_package(clone / "drivers/off", "robot_off", {})
    (clone / ".git").mkdir()
    names = ["robot_bringup", "robot_description", "robot_driver"]
    for here in ("", "drivers", "drivers/deep", "robot_bringup", "robot_bringup/robot_bringup"):
        assert packages_of(clone / here) == (clone, names)


def test_a_copy_for_each_lesson_is_the_one_where_one_stands(tmp_path: Path) -> None:
    clone = tmp_path.resolve()
    (clone / ".git").mkdir()
    for lesson in ("01-first", "02-second"):
        write_package(clone / lesson, "robot_lesson", {"a.py": ""})
    write_package(clone, "robot_other", {"a.py": ""})
    assert packages_of(clone) == (clone, ["robot_other", "robot_lesson"])
    assert packages_of(clone / "01-first") == packages_of(clone)
    for here in ("02-second", "02-second/robot_lesson/robot_lesson"):
        top, names = packages_of(clone / here)
        assert top is not None
        assert (names, source_packages(top)["robot_lesson"]) == (["robot_lesson"], clone / "02-second/robot_lesson")


def test_a_clone_that_is_one_package_works_from_its_own_folder(tmp_path: Path) -> None:
    clone = write_package(tmp_path.resolve(), "robot_one", {"a.py": ""})
    (clone / ".git").mkdir()
    assert packages_of(clone / "robot_one") == (clone, ["robot_one"])


def test_a_folder_of_packages_is_a_workspace_where_one_stands_in_it(tmp_path: Path) -> None:
    folder = tmp_path.resolve()
    write_package(folder / "a", "robot_two", {"a.py": ""})
    assert packages_of(folder) == (folder, ["robot_two"])
    assert packages_of(folder / "a") == (folder / "a", ["robot_two"])
    (folder / "other/project").mkdir(parents=True)
    assert packages_of(folder / "other/project") == (None, [])


def test_packages_beside_a_package_are_found_without_a_clone(tmp_path: Path) -> None:
    folder = tmp_path.resolve()
    for name in ("robot_a", "robot_b"):
        write_package(folder / "unpacked", name, {"a.py": ""})
    assert packages_of(folder / "unpacked/robot_a/robot_a") == (folder / "unpacked", ["robot_a", "robot_b"])
    write_package(folder / "unpacked/copy", "robot_a", {"a.py": ""}).rename(folder / "unpacked/robot_a_old")
    assert packages_of(folder / "unpacked/robot_a") == (folder / "unpacked/robot_a", ["robot_a"])


def test_a_clone_of_any_python_project_is_no_workspace(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    (tmp_path / "setup.py").touch()
    (tmp_path / "docs").mkdir()
    assert packages_of(tmp_path) == (None, [])


def test_packages_beside_src_count_as_for_colcon(tmp_path: Path) -> None:
    top = tmp_path.resolve()
    for place, name in (("src", "robot_a"), ("", "robot_b"), ("install", "robot_c")):
        write_package(top / place, name, {"a.py": ""})
    assert packages_of(top / "robot_b") == (top, ["robot_a", "robot_b"])
