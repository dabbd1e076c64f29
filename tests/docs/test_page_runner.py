"""The runner of pages finds what is wrong on a page: outputs, exit codes, unknown blocks and commands."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.console import fits
from tests.support.page_runner import Shells, goes_on, shlex_lines
from tools.docs_site.markdown import blocks
from tools.docs_site.same_code import with_code_of


@pytest.mark.parametrize(
    ("shown", "lines", "exact", "fit"),
    [
        (["a", "b"], ["a", "b", ""], True, True),
        (["a", "b"], ["a"], True, False),
        (["a", "..."], ["a", "b", "c"], True, True),
        (["...", "c"], ["a", "b", "c"], True, True),
        (["a", "...", "c"], ["a", "c"], True, True),
        (["...", "c"], ["c", "d"], True, False),
        (["x is ... m"], ["x is 1.25 m"], True, True),
        (["x is 1.50 m"], ["x is 1.25 m"], True, False),
        (["x is 1.50 m"], ["x is 1.25 m"], False, True),
        (["x is 1.50 m"], ["x is far m"], False, False),
        (["[INFO] [1.5] [a]: b"], ["[INFO] [17.25] [a]: b"], True, True),
        (["[INFO] [1.5] [a]: b"], ["[INFO] [17.25] [a]: c"], True, False),
    ],
)
def test_outputs_fit_by_their_wildcards(shown: list[str], lines: list[str], exact: bool, fit: bool) -> None:
    assert fits(shown, lines, exact=exact) is fit


def test_while_a_command_runs_more_may_come_before_and_after() -> None:
    assert fits(["b"], ["a", "b", "c"], whole=False)
    assert not fits(["b", "d"], ["a", "b", "c"], whole=False)


@pytest.mark.parametrize(
    ("line", "goes"),
    [
        ("robolink run careful.py", True),
        ("robolink launch wander", True),
        ("robolink launch wander --duration 5", False),
        ("robolink topic echo /scan", True),
        ("robolink topic echo /scan --once", False),
        ("robolink param set /run near 1.5", False),
        ("robolink simulate run --duration 5", False),
        ("pytest run", False),
    ],
)
def test_what_goes_on_is_known_by_its_verb(line: str, goes: bool) -> None:
    assert goes_on(line.split()) is goes


def test_commands_are_lines_without_comments() -> None:
    assert shlex_lines("a 'b c'   # d\n\n# e\nf \\\n  g\n") == ["a 'b c'", "f g"]


PAGES = {
    "another output": ("```python\nprint(1)\n```\n\n```console\n2\n```", "line 5: 'python' says\n1\nand not\n2"),
    "a program that fails": ("```python\n1 / 0\n```", "ZeroDivisionError"),
    "a command that fails": ("```sh\npython -c 'raise SystemExit(3)'\n```", "ended with 3"),
    "one that should": ("<!-- run: fails -->\n```sh\npython -c ''\n```", "ended with 0"),
    "a foreign command": ("```sh\nsudo reboot\n```", "'sudo' is not run by the tests"),
    "an unknown block": ("```perl\nprint 1\n```", "nobody knows how to run 'perl'"),
    "broken YAML": ("```yaml\na: [\n```", "while parsing"),
    "a part that is not there": (
        '```python title="a.py"\nb\n```\n<!-- run: part of a.py -->\n```python\nc\n```',
        "not in a.py",
    ),
    "nothing to stop": ("<!-- run: stop a -->\n```text\n```", "nothing runs"),
    "an output of nothing": ("```console\n1\n```", "no such command"),
}


@pytest.mark.processes
@pytest.mark.parametrize("name", PAGES)
def test_what_is_wrong_on_a_page_is_found(name: str, tmp_path: Path) -> None:
    text, words = PAGES[name]
    with Shells(tmp_path, 0) as shells, pytest.raises(AssertionError) as caught:
        shells.run(text)
    assert words in str(caught.value)


@pytest.mark.processes
def test_a_page_without_mistakes_passes(tmp_path: Path) -> None:
    text = (
        '```python title="a.py"\nx = 1\nprint(x)\n```\n<!-- run: part of a.py -->\n```python\nprint(x)\n```\n'
        "```sh\npython a.py   # says 1\n```\n```console\n1\n```\n<!-- run: not, needs a robot -->\n```sh\nfly\n```"
    )
    with Shells(tmp_path, 0) as shells:
        shells.run(text)


def test_blocks_know_their_title_line_and_directive() -> None:
    [block] = blocks('a\n\n<!-- run: fails -->\n```sh title="x"\ny\n```\n')
    assert block == ("sh", "x", "y\n", 4, "fails")


def test_code_is_copied_from_the_english_page() -> None:
    assert with_code_of("a\n```sh\nb\n```\n", "c\n\n```\n```\nd", "page") == "c\n\n```sh\nb\n```\nd\n"
    with pytest.raises(ValueError, match="page: 1 blocks in English, 0 in Portuguese"):
        with_code_of("```\n```", "c", "page")
