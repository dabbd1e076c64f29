"""robolink pkg: packages are made, listed and found, in the words of ros2."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import main
from robolink.documents import xmltext
from robolink.workspace import VARIABLE, find_node, load_node
from robolink.workspace.cmake_files import CMakeFile
from robolink.workspace.setup_files import data_files

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def src(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The empty src/ of a workspace, which is the working directory."""
    monkeypatch.delenv(VARIABLE, raising=False)
    (tmp_path / "src").mkdir()
    monkeypatch.chdir(tmp_path / "src")
    monkeypatch.syspath_prepend(str(tmp_path / "nothing"))  # restores sys.path at the end
    return tmp_path / "src"


def ran(name: str) -> None:
    run: Any = load_node(find_node(name))
    run()


def test_a_package_in_python_runs_at_once(src: Path, capsys: Captured) -> None:
    words = "--build-type ament_python --license MIT --node-name my_node pkg_new --dependencies rclpy std_msgs"
    assert main(["pkg", "create", *words.split()]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("going to create a new package\npackage name: pkg_new\ndestination directory: ")
    for line in ("build type: ament_python", "dependencies: ['rclpy', 'std_msgs']", "node_name: my_node"):
        assert f"\n{line}\n" in out
    assert "\ncreating folder ./pkg_new\n" in out
    assert (out.endswith("robolink run pkg_new my_node\n"), err) == (True, "")
    ran("pkg_new my_node")
    assert capsys.readouterr().out == "Hi from pkg_new.\n"
    root = xmltext.read(src / "pkg_new/package.xml")
    assert [each.text for each in root.all("depend")] == ["rclpy", "std_msgs"]
    assert [each.text for each in root.all("export", "build_type")] == ["ament_python"]


def test_a_licence_is_written_and_an_unknown_one_is_told(src: Path, capsys: Captured) -> None:
    assert main(["pkg", "create", "pkg_a", "--license", "BSD-3-Clause", "--maintainer-name", "Ada"]) == 0
    out, err = capsys.readouterr()
    assert ("\ncreating ./pkg_a/LICENSE\n" in out, err) == (True, "")
    assert ", Ada\n" in (src / "pkg_a/LICENSE").read_text()
    assert main(["pkg", "create", "pkg_b", "--license", "BSD-3-Claus"]) == 0
    hint = "(did you mean 'BSD-3-Clause'?)"
    assert capsys.readouterr().err == f"no file LICENSE was made: robolink has no text of 'BSD-3-Claus' {hint}\n"
    assert not (src / "pkg_b/LICENSE").exists()
    assert main(["pkg", "create", "pkg_c", "--license", "?"]) == 0
    assert capsys.readouterr().out.splitlines()[:3] == ["Supported licenses:", "Apache-2.0", "BSD-2-Clause"]
    assert not (src / "pkg_c").exists()


def test_what_setuptools_and_colcon_need_is_in_it(src: Path) -> None:
    awkward = 'it\'s "new" <&> {}'
    main(
        ["pkg", "create", "pkg_new", "--build-type", "ament_python", "--description", awkward, "--library-name", "lib"]
    )
    folder = src / "pkg_new"
    assert data_files(folder) == [
        ("share/ament_index/resource_index/packages", ["resource/pkg_new"]),
        ("share/pkg_new", ["package.xml"]),
    ]
    assert all((folder / each).is_file() for _, files in data_files(folder) for each in files)
    call = next(
        each
        for each in ast.walk(ast.parse((folder / "setup.py").read_text()))
        if isinstance(each, ast.keyword) and each.arg == "description"
    )
    assert ast.literal_eval(call.value) == awkward
    assert [each.text for each in xmltext.read(folder / "package.xml").all("description")] == [awkward]
    assert (folder / "setup.cfg").read_text().count("$base/lib/pkg_new") == 2
    assert (folder / "pkg_new/lib/__init__.py").is_file()


def test_a_package_in_cmake_has_a_program_that_runs_and_a_library(src: Path, capsys: Captured) -> None:
    words = "pkg_cmake --node-name my_node --library-name tools --dependencies rclcpp"
    assert main(["pkg", "create", *words.split()]) == 0
    capsys.readouterr()
    ran("pkg_cmake my_node")
    assert capsys.readouterr().out == "Hi from pkg_cmake.\n"
    folder = src / "pkg_cmake"
    text = (folder / "CMakeLists.txt").read_text()
    assert ("project(pkg_cmake)" in text, "find_package(rclcpp REQUIRED)" in text, "@" in text) == (True, True, False)
    installed = [source for each in CMakeFile(folder).installs if each.kind != "TARGETS" for source in each.sources]
    assert all((folder / each).exists() for each in installed)
    assert '#include "pkg_cmake/tools.hpp"' in (folder / "src/tools.cpp").read_text()


def test_it_is_made_elsewhere(src: Path) -> None:
    assert main(["pkg", "create", "pkg_new", "--destination-directory", "deep/er", "--package-format", "2"]) == 0
    assert xmltext.read(src / "deep/er/pkg_new/package.xml").attributes == {"format": "2"}


@pytest.mark.parametrize(
    ("words", "report"),
    [
        ("my-pkg", "Python imports no '-', take '_'"),
        ("class", "is a word of Python"),
        ("../x", "is not a name for a package"),
        ("pkg_there", "is there already: take another name"),
        ("pkg_x --node-name 1", "'1' is not a name for a node"),
        ("pkg_x --node-name a --library-name a", "cannot both be called 'a'"),
        ("pkg_x --dependencies rclpy <x>", "'<x>' is not a name of a package to depend on"),
        ("std_msgs --build-type ament_python", "a package 'std_msgs' comes with robolink"),
        ("robolink --build-type ament_python", "take another name, such as my_robolink"),
        ("random --build-type ament_python", "'random' is a module of Python: take another name, such as my_random"),
    ],
)
@pytest.mark.usefixtures("src")
def test_what_cannot_be_made_is_one_line(words: str, report: str, capsys: Captured) -> None:
    Path("pkg_there").mkdir()
    assert main(["pkg", "create", *words.split()]) == 1
    err = capsys.readouterr().err
    assert (report in err, err.count("\n")) == (True, 1)
    assert sorted(each.name for each in Path().iterdir()) == ["pkg_there"]


@pytest.mark.parametrize("build_type", ["ament_cmake", "ament_python"])
@pytest.mark.usefixtures("src")
def test_a_package_without_a_name_is_not_made(build_type: str, capsys: Captured) -> None:
    assert main(["pkg", "create", "", "--build-type", build_type]) == 1
    err = capsys.readouterr().err
    assert ("'' is not a name for a package" in err, err.count("\n")) == (True, 1)
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize("option", ["--description", "--license", "--maintainer-name", "--maintainer-email"])
@pytest.mark.parametrize("character", ["\0", "\r", "\x1b", "\x7f", "\x85", "\udc80", "\ufffe"])
@pytest.mark.usefixtures("src")
def test_texts_have_no_control_characters(option: str, character: str, capsys: Captured) -> None:
    assert main(["pkg", "create", "pkg_x", option, f"a{character}b"]) == 1
    err = capsys.readouterr().err
    assert (f"the character {character!a}" in err, err.count("\n")) == (True, 1)
    assert list(Path().iterdir()) == []


def test_texts_have_tabs_and_lines(src: Path) -> None:
    text = "one\n\ttwo \u00e9 \U0001f422"
    assert main(["pkg", "create", "pkg_x", "--description", text]) == 0
    assert [each.text for each in xmltext.read(src / "pkg_x/package.xml").all("description")] == [text]


def test_packages_are_listed_and_found(src: Path, capsys: Captured) -> None:
    main(["pkg", "create", "pkg_new", "--build-type", "ament_python", "--node-name", "my_node", "--license", "MIT"])
    capsys.readouterr()
    assert main(["pkg", "list"]) == 0
    names = capsys.readouterr().out.splitlines()
    assert names == sorted(names)
    assert {"pkg_new", "geometry_msgs", "teleop_twist_keyboard", "robolink"} <= set(names)
    for flags in ([], ["--share"]):
        assert main(["pkg", "prefix", "pkg_new", *flags]) == 0
        assert capsys.readouterr().out == f"{src / 'pkg_new'}\n"
    assert main(["pkg", "xml", "pkg_new", "-t", "license"]) == 0
    assert capsys.readouterr().out == "MIT\n"
    assert main(["pkg", "xml", "pkg_new"]) == 0
    assert capsys.readouterr().out == (src / "pkg_new/package.xml").read_text()


@pytest.mark.usefixtures("src")
def test_executables_are_what_run_runs(capsys: Captured) -> None:
    main(["pkg", "create", "pkg_new", "--build-type", "ament_python", "--node-name", "my_node"])
    capsys.readouterr()
    assert main(["pkg", "executables", "pkg_new"]) == 0
    assert capsys.readouterr().out == "pkg_new my_node\n"
    assert main(["pkg", "executables", "pkg_new", "--full-path"]) == 0
    assert Path(capsys.readouterr().out.strip()).parts[-3:] == ("pkg_new", "pkg_new", "my_node.py")
    assert main(["pkg", "executables"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert {"pkg_new my_node", "robolink world", "teleop_twist_keyboard teleop_twist_keyboard"} <= set(lines)
    for line in lines:
        find_node(line)


@pytest.mark.usefixtures("src")
@pytest.mark.parametrize(
    ("words", "report"),
    [
        ("prefix geometry_msg", "(did you mean 'geometry_msgs'?)"),
        ("executables no_such_pkg", "no package named 'no_such_pkg'"),
        ("xml geometry_msgs", "since the package comes with robolink"),
        ("xml pkg_new --tag licence", "(did you mean 'license'?)"),
        ("prefix cartographer_ros", "no package named 'cartographer_ros'"),
    ],
)
def test_what_is_not_there_is_one_line(words: str, report: str, capsys: Captured) -> None:
    main(["pkg", "create", "pkg_new"])
    capsys.readouterr()
    assert main(["pkg", *words.split()]) == 1
    err = capsys.readouterr().err
    assert (report in err, err.count("\n")) == (True, 1)
