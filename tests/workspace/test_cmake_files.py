"""A package's CMakeLists.txt is read for what it installs, and never run."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import NotFoundError
from robolink.workspace import NodeSource, RosProgramError, executable, find_executable
from robolink.workspace.cmake_files import LONGEST_WORD, CMakeFile

SCRIPTS = {"drive.py": "", "turn.py": "", "tool.sh": "#!/bin/sh\n", "look": "#!/usr/bin/env python3\n", "data": "x"}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package in CMake with some files in `scripts/`."""
    (tmp_path / "scripts").mkdir()
    for name, text in SCRIPTS.items():
        (tmp_path / "scripts" / name).write_text(text)
    (tmp_path / "package.xml").write_text("<package><name>mixed</name></package>")
    return tmp_path


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("install(PROGRAMS\n  scripts/drive.py scripts/tool.sh scripts/gone.py\n DESTINATION lib/mixed)", "drive.py"),
        (
            "# install(PROGRAMS scripts/drive.py DESTINATION lib/x)\nINSTALL(PROGRAMS scripts/look DESTINATION lib/x)",
            "look",
        ),
        ('project(m)\ninstall(PROGRAMS "scripts/drive.py" DESTINATION "lib/${PROJECT_NAME}" RENAME drive)', "drive"),
        ("set(ALL scripts/drive.py scripts/turn.py)\ninstall(PROGRAMS ${ALL} DESTINATION lib/m)", "drive.py turn.py"),
        ("file(GLOB ALL scripts/*.py)\ninstall(PROGRAMS ${ALL} DESTINATION lib/m)", "drive.py turn.py"),
        (
            "set(A)\nlist(APPEND A ${CMAKE_SOURCE_DIR}/scripts/turn.py)\ninstall(PROGRAMS ${A} DESTINATION lib/m)",
            "turn.py",
        ),
        ("install(DIRECTORY scripts/ DESTINATION lib/m USE_SOURCE_PERMISSIONS)", "drive.py look turn.py"),
        ("install(PROGRAMS scripts/drive.py DESTINATION share/m)", ""),
        ("file(GLOB_RECURSE ALL ./*.py)\ninstall(PROGRAMS ${ALL} DESTINATION lib/m)", "drive.py turn.py"),
        ("file(GLOB_RECURSE ALL scripts/t*.py)\ninstall(PROGRAMS ${ALL} DESTINATION lib/m)", "turn.py"),
        ("file(GLOB ALL */[dt]*.py *.py)\ninstall(PROGRAMS ${ALL} DESTINATION lib/m)", "drive.py turn.py"),
        ("file(GLOB ALL s*)\ninstall(DIRECTORY ${ALL} DESTINATION lib/m)", "drive.py look turn.py"),
        ("install(PROGRAMS ${unknown} DESTINATION lib/m)\ninstall(\n", ""),
        ('#[=[ 3" of\n]] 2 ]=]install(PROGRAMS "scripts/drive.py" DESTINATION lib/m)\n#[[ open', "drive.py"),
        ('message("install(PROGRAMS scripts/drive.py DESTINATION lib/m)")', ""),
    ],
)
def test_python_programs_that_are_installed(package: Path, text: str, names: str) -> None:
    (package / "CMakeLists.txt").write_text(text)
    found = CMakeFile(package).scripts()
    assert sorted(found) == names.split()
    assert all(each.is_file() for each in found.values())


def test_they_are_executables_with_and_without_their_suffix(package: Path) -> None:
    (package / "CMakeLists.txt").write_text("install(PROGRAMS scripts/drive.py DESTINATION lib/${PROJECT_NAME})")
    assert executable(package, "drive.py") is None  # project() is missing: nobody knows where it goes
    (package / "CMakeLists.txt").write_text(
        "project(mixed)\ninstall(PROGRAMS scripts/drive.py DESTINATION lib/${PROJECT_NAME})"
    )
    source = NodeSource("drive.py", package / "scripts/drive.py")
    assert executable(package, "drive.py") == executable(package, "drive") == source


def test_what_is_compiled_is_named(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(package)
    (package / "CMakeLists.txt").write_text(
        "project(mixed)\nadd_executable(talker src/talker.cpp)\nadd_library(a src/a.cpp)\n"
        'rclcpp_components_register_node(a PLUGIN "m::A" EXECUTABLE listener)\n'
        "ament_auto_add_executable(hearer src/hearer.cpp)\ninstall(TARGETS ${x} built a DESTINATION lib/mixed)\n"
    )
    assert CMakeFile(package).compiled == ["talker", "listener", "hearer", "built", "a"]
    with pytest.raises(RosProgramError, match=r"mixed talker is a C\+\+ program"):
        find_executable("mixed", "talker")
    with pytest.raises(NotFoundError, match="no executable named 'speaker' in package mixed"):
        find_executable("mixed", "speaker")


def test_files_of_subdirectories_count_from_their_own_place(package: Path) -> None:
    (package / "CMakeLists.txt").write_text(
        "project(m)\nadd_subdirectory(scripts)\nadd_subdirectory(../x)\nadd_subdirectory(.)"
    )
    (package / "scripts/CMakeLists.txt").write_text(
        "file(GLOB found *.py)\ninstall(PROGRAMS ${found} DESTINATION lib/${PROJECT_NAME})\nadd_executable(deep a.cpp)"
    )
    read = CMakeFile(package)
    assert (sorted(read.scripts()), set(read.compiled)) == (["drive.py", "turn.py"], {"deep"})


PIECES = [
    "install(",
    "PROGRAMS ",
    "file(GLOB x ",
    "*",
    "**",
    "../",
    "/",
    ")",
    '"',
    "#",
    "\n",
    "${x}",
    "set(x ",
    "\\",
    "[",
]


@given(st.lists(st.sampled_from(PIECES) | st.text(max_size=4), max_size=40))
def test_any_text_is_read(tmp_path_factory: pytest.TempPathFactory, pieces: list[str]) -> None:
    folder = tmp_path_factory.getbasetemp() / "any_cmake"
    folder.mkdir(exist_ok=True)
    (folder / "CMakeLists.txt").write_text("".join(pieces), encoding="utf-8")
    read = CMakeFile(folder)
    assert all(path.is_relative_to(folder) for path in read.scripts().values())


LIST = "set(x " + "a " * 1990 + ")\n"
HOSTILE = {
    "commands": "a(" * 90_000,
    "quoted commands": 'a("' * 60_000,
    "escapes": '"' + "\\" * 150_000,
    "growing lists": "set(x ${x} ${x})\n" * 12_000,
    "escaped quotes": '\\"' * 90_000,
    "escaped quotes in a command": "a(" + '\\"' * 90_000 + ")",
    "commands of escaped quotes": 'a(\\"' * 45_000,
    "comments": "#[[" * 60_000 + "#[=[]" * 2_000,
    "a long name": "a" * 190_000,
    "a long name in a command": "a(" + "x" * 190_000,
    "growing words": "set(a xx)\n" + 'set(a "${a}${a}")\n' * 60 + 'set(b "${a}' + "${b}" * 9000 + '")',
    "long joins": LIST + ("b(" + '"${x}"' * 1990 + ")\n") * 12,
    "long lists": LIST + ("b(" + "${x} " * 1990 + ")\n") * 12,
}


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_file_takes_no_time(package: Path, what: str) -> None:
    (package / "CMakeLists.txt").write_text(HOSTILE[what])
    begin = time.process_time()
    assert CMakeFile(package).installs == []
    assert time.process_time() - begin < 5  # each takes less than half a second, and took minutes


MANY_FILES = {
    "folders": "install(DIRECTORY " + ". " * 1900 + "DESTINATION lib/m)",
    "different folders": "install(DIRECTORY " + " ".join("./" * n + "many" for n in range(60)) + " DESTINATION lib/m)",
    "installs": "install(DIRECTORY many DESTINATION lib/m)\n" * 1900,
    "patterns": "".join(
        f"file(GLOB_RECURSE x *{n}.py)\ninstall(PROGRAMS ${{x}} DESTINATION lib/m)" for n in range(900)
    ),
    "deep patterns": "file(GLOB x " + "".join(f"*/*{n} " for n in range(1900)) + ")\n",
    "files": ("install(FILES " + "a " * 1900 + "DESTINATION lib/m)\n") * 45,
}


@pytest.mark.slow
@pytest.mark.parametrize("what", MANY_FILES)
def test_a_file_that_asks_for_all_files_again_and_again_takes_no_time(package: Path, what: str) -> None:
    (package / "many").mkdir()
    for number in range(400):
        (package / "many" / f"f{number}").touch()
    (package / "CMakeLists.txt").write_text(MANY_FILES[what])
    begin = time.process_time()
    assert "f1" not in CMakeFile(package).scripts()
    assert time.process_time() - begin < 5  # less than half a second each, and some took a minute


def test_words_end_where_they_are_too_long(package: Path) -> None:
    doubled = 'set(a "xx")\n' + 'set(a "${a}${a}")\n' * 14
    (package / "CMakeLists.txt").write_text(f"{doubled}add_executable(${{a}}y a.cpp)")
    assert CMakeFile(package).compiled == ["x" * LONGEST_WORD]


def test_an_open_quote_ends_with_the_text_and_an_escaped_one_is_none(package: Path) -> None:
    (package / "CMakeLists.txt").write_text(
        'a(\\" # no comment of "x\n)\nadd_executable(x\\"y z)\nadd_executable(b)\na(" # add_executable(c)\n'
    )
    assert CMakeFile(package).compiled == ['x\\"y', "b"]


@pytest.mark.parametrize("source", ["/", "/etc/", "..", "scripts/../../", "${unknown}/scripts", "C:/x", "..\\\\x"])
@pytest.mark.parametrize("kind", ["DIRECTORY", "PROGRAMS"])
def test_nothing_outside_the_package_is_installed(package: Path, kind: str, source: str) -> None:
    (package / "CMakeLists.txt").write_text(f"install({kind} {source} scripts/drive.py DESTINATION lib/m)")
    assert [each.sources for each in CMakeFile(package).installs] == [["scripts/drive.py"]]


@pytest.mark.parametrize(
    "line", ["install(PROGRAMS {} DESTINATION lib/m)", "file(GLOB x {}/a)", "add_subdirectory({})"]
)
def test_a_name_too_long_for_a_file_is_no_file(package: Path, line: str) -> None:
    (package / "CMakeLists.txt").write_text(line.format("a" * 5000))
    assert CMakeFile(package).scripts() == {}
