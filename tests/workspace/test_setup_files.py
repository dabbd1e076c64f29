"""Executables that a package's setup.py and setup.cfg name, read without running them."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.main import main
from robolink.cli.running_nodes.run import part
from robolink.exceptions import RobolinkError
from robolink.workspace import (
    VARIABLE,
    executables,
    find_node,
)
from robolink.workspace.packages import import_roots
from robolink.workspace.setup_files import SCRIPTS, _ini, _pyproject, _setup_py, console_scripts
from tests.support.ros_tree import write_package


@pytest.mark.parametrize(
    "text",
    [
        "from setuptools import setup\nsetup(entry_points={'console_scripts': ['a = m.n:main', 'b=m.o:run']})",
        "import setuptools\nsetuptools.setup(entry_points={'console_scripts': ('a = m.n:main', 'b=m.o:run')})",
        "n = 'm'\nsetup(entry_points={'console_scripts': [f'a = {n}.n:main', 'b=' + n + '.o:run']})",
        "E = {'console_scripts': ['a = m.n:main'] + ['b = m.o:run']}\nsetup(entry_points=E)",
        "setup(entry_points={'console_scripts': 'a = m.n:main\\nb = m.o:run'})",
        "setup(entry_points='[console_scripts]\\na = m.n:main\\nb = m.o:run\\n[other]\\nc = d:e\\n')",
        "setup(entry_points={**more, 'console_scripts': ['a = m.n : main [extra]', 'b = m.o:run', x, 3, 'no']})",
    ],
)
def test_console_scripts_of_a_setup_py(tmp_path: Path, text: str) -> None:
    (tmp_path / "setup.py").write_text(text + "\nraise SystemExit('this is never run')\n")
    assert console_scripts(tmp_path) == {"a": ("m.n", "main"), "b": ("m.o", "run")}


def test_other_places_that_name_them(tmp_path: Path) -> None:
    (tmp_path / "setup.cfg").write_text(
        "[options.entry_points]\nconsole_scripts =\n  a = m.n:main\n  # no\n  b = m.o:run\n"
    )
    (tmp_path / "pyproject.toml").write_text(
        '[project]\nname = "x = y"\n\n[project.scripts]  # here\nc = "m.p:main"\n'
        '"d-e" = \'m.q:main\'\n[tool.x]\nf = "g:h"\n'
    )
    found = {"a": ("m.n", "main"), "b": ("m.o", "run"), "c": ("m.p", "main"), "d-e": ("m.q", "main")}
    assert console_scripts(tmp_path) == found


def test_modules_may_lie_in_src_within_the_package(tmp_path: Path) -> None:
    folder = write_package(tmp_path / "src", "deep", {}, "node = deep.node:main")
    (folder / "src/deep").mkdir(parents=True)
    (folder / "src/deep/node.py").touch()
    source = executables(folder)["node"]
    assert (source.path, source.root) == (folder / "src/deep/node.py", folder / "src")
    assert folder / "src" in import_roots(folder)


PIECES = st.lists(
    st.sampled_from(
        [
            "setup(",
            ")",
            "{",
            "}",
            "[",
            "]",
            "entry_points=",
            "'console_scripts'",
            ":",
            ",",
            "'a=b:c'",
            "import",
            "+",
            "*",
            "\\",
            "#",
            "lambda",
            "%(x)s",
        ]
    )
    | st.sampled_from(["\n", "\t", "[project.scripts]", "[console_scripts]", "f'{x}'", "\0", "options.entry_points"])
    | st.text(max_size=5),
    max_size=30,
)


@given(PIECES)
def test_any_text_gives_scripts_or_none(pieces: list[str]) -> None:
    text = " ".join(pieces)
    for found in (_setup_py(text, SCRIPTS), _ini(text, "options.entry_points", SCRIPTS), _pyproject(text, SCRIPTS)):
        assert all(isinstance(each, str) for each in found)


def test_a_deep_or_endless_setup_py_is_none(tmp_path: Path) -> None:
    for text in (
        "setup(entry_points=" + "(" * 5000,
        "a = a\nsetup(entry_points={'console_scripts': a})",
        "x = " + "[" * 200,
    ):
        (tmp_path / "setup.py").write_text(text)
        assert console_scripts(tmp_path) == {}


KNOWN = {"-p": True, "--param": True, "--name": True, "--list": False, "--help": False}


@pytest.mark.parametrize(
    ("line", "own", "words", "fixed"),
    [
        ("talker -p a:=1 x", "-p a:=1", "talker x", ""),
        ("-p a:=1 --name=n talker", "-p a:=1 --name=n", "talker", ""),
        ("talker --rate 5 -v -p a:=1", "-p a:=1", "talker --rate 5 -v", ""),
        ("pkg exe --flag -pa:=1 -- -p x", "-pa:=1", "pkg exe --flag", "-p x"),
        ("--rate 5 talker", "--rate", "5 talker", ""),
        ("talker --nam x", "--nam", "talker x", ""),
        ("talker --lists", "--lists", "talker", ""),
        ("talker - --list", "--list", "talker -", ""),
    ],
)
def test_options_that_are_not_ours_are_the_programs(line: str, own: str, words: str, fixed: str) -> None:
    assert part(line.split(), KNOWN) == (own.split(), words.split(), fixed.split(), False)


def test_an_option_without_its_value_is_told() -> None:
    assert part(["talker", "--rate", "--name"], KNOWN) == (["--name"], ["talker", "--rate"], [], True)


@given(
    st.lists(
        st.sampled_from(["talker", "-p", "a:=1", "--name", "--name=x", "--list", "--", "-", "--rate", "-v", "", "="])
    )
)
def test_no_word_is_lost(line: list[str]) -> None:
    kept = [each for part_of_it in part(line, KNOWN)[:3] for each in part_of_it]
    assert sorted(line) in (sorted(kept), sorted([*kept, "--"]))


@pytest.mark.usefixtures("top")
def test_unknown_options_reach_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    import signal

    from robolink.cli.running_nodes import runner

    seen: list[list[str]] = []
    monkeypatch.setattr(runner, "_start", lambda source, args: seen.append(sys.argv[1:]))
    monkeypatch.setattr(runner, "take_names", lambda: None)
    monkeypatch.setattr(runner, "_note_termination", list)
    monkeypatch.setattr(sys, "argv", [])
    monkeypatch.setenv(VARIABLE, ".")
    before = signal.getsignal(signal.SIGTERM)
    line = ["run", "pkg_a", "first", "--rate", "5", "-p", "a:=1", "-x", "--", "-p", "--ros-args", "-r", "a:=b"]
    assert main(line) == 0
    assert seen == [["--rate", "5", "-x", "-p", "--ros-args", "-p", "a:=1", "--ros-args", "-r", "a:=b"]]
    assert signal.getsignal(signal.SIGTERM) is before


@pytest.mark.usefixtures("top")
def test_the_shell_completes_packages_and_executables(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from robolink.cli.main import COMPLETION

    monkeypatch.setenv(COMPLETION, "complete_bash")
    for line, offered in (
        ("robolink run pkg", ["pkg_a", "pkg_b"]),
        ("robolink run pkg_a ", ["first"]),
        ("robolink run pkg-a fi", ["first"]),
        ("robolink run -p a:=1 pkg_a fi", ["first"]),
        ("robolink run pkg_a first ", []),
        ("robolink run world ", []),
    ):
        monkeypatch.setenv("COMP_WORDS", line)
        monkeypatch.setenv("COMP_CWORD", str(len(line.split(" ")) - 1))
        main([])
        out, err = capsys.readouterr()
        assert (out.split(), err) == (offered, "")


def test_find_node_knows_no_packages(top: Path) -> None:
    with pytest.raises(RobolinkError):
        find_node("pkg_a")
