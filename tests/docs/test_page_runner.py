"""The runner of pages finds what is wrong on a page: outputs, exit codes, unknown blocks and commands."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest

from tests.support.console import fits
from tests.support.domains import free_domain
from tests.support.page_kinds import imports_ros
from tests.support.page_runner import Shells, steps
from tests.support.page_shell import Shell, lines_of
from tests.support.page_words import goes_on, problem
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
        (["600 s in 3.4 s, 180 times as fast"], ["600 s in 12.0 s, 50 times as fast"], True, True),
        (["600 s in 3.4 s, 180 times as fast"], ["60 s in 3.4 s, 180 times as fast"], True, False),
        (["[INFO] [1.5] [a]: b"], ["[INFO] [17.25] [a]: c"], True, False),
        (["  1.2 s  INFO  x/a    b ..."], ["[x/a] [INFO] [17.25] [x.a]: b c"], True, True),
        (["  1.2 s  ERROR a      b"], ["[a] [INFO] [17.25] [a]: b"], True, False),
        ([" 11.2 s        view   b"], ["[view] b"], True, True),
        ([" 11.2 s  ERROR launch  b"], ["[launch] b"], True, True),
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
        ("A=b robolink --network lan run careful.py", True),
        ("robolink bag play walk", False),
        ("robolink bag play walk -r 2 -l", True),
        ("robolink image show /camera", True),
        ("robolink interface show Twist", False),
        ("robolink launch --schema", False),
        ("robolink plot topic /odom --duration 5", False),
    ],
)
def test_what_goes_on_is_known_by_its_verb(line: str, goes: bool) -> None:
    assert goes_on(line.split()) is goes


def test_commands_are_lines_without_comments(tmp_path: Path) -> None:
    lines = lines_of("a 'b c'   # d\n\n# e\nf \\\n  g\n")
    assert [Shell(tmp_path).commands(each) for each in lines] == [[["a", "b c"]], [["f", "g"]]]
    assert Shell(tmp_path).commands("a 'b;c'; d && e # f") == [["a", "b;c"], ["d"], ["e"]]


def test_a_shell_has_a_folder_and_variables(tmp_path: Path) -> None:
    (tmp_path / "inside").mkdir()
    (tmp_path / "inside" / "some.env").write_text("PLACE=$PWD\nNAME=b\n")
    shell = Shell(tmp_path)
    for words in shell.commands("cd inside; set -a; . ./some.env; export COLOUR=red"):
        assert shell.obeys(words)
    place = str(tmp_path / "inside")
    assert shell.variables.items() >= {"PLACE": place, "NAME": "b", "COLOUR": "red"}.items()
    [words] = shell.commands("NAME=c robolink $PLACE $PWD")
    program, variables = shell.program(words)
    assert (program[-2:], variables["NAME"], shell.variables["NAME"]) == ((place, place), "c", "b")
    assert not shell.obeys(words)


def test_what_a_page_installs_is_there(tmp_path: Path) -> None:
    assert Shell(tmp_path).obeys(["pip", "install", "pytest"])
    with pytest.raises(PackageNotFoundError):
        Shell(tmp_path).obeys(["pip", "install", "no-such-package-anywhere"])


def test_wrong_words_of_a_command_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert problem(["topic", "echo", "/scan"]) == ""
    assert "NoSuchOption" in problem(["topic", "echo", "/scan", "--onec"])
    assert "no command named" in problem(["topic", "ecko", "/scan"])


def test_programs_with_names_of_ros_are_known() -> None:
    assert imports_ros("import math\nfrom std_msgs.msg import String")
    assert not imports_ros("import robolink.compat\nfrom std_msgs.msg import String")
    assert not imports_ros("import json, numpy\nfrom robolink.node import Node")


def test_comments_between_blocks_are_steps_of_their_own() -> None:
    text = "<!-- run: type a -->\n<!-- run: each -->\n```sh\nb\n```\n<!-- run: copy c -->\n```text\nd\n```\n"
    found = [(each.language, each.text, each.directive) for each in steps(text)]
    assert found == [("run", "", "type a"), ("sh", "b\n", "each"), ("run", "", "copy c"), ("text", "d\n", "")]


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
    "another output on a screen": ("```console\n$ python -c 'print(1)'\n2\n```", "says\n1\nand not\n2"),
    "a launch file with a mistake": ("```yaml\nnodes: [{node: world, parametres: {}}]\n```", "unknown key"),
    "a world with a mistake": ("```yaml\nrobots: [{name: r1, sensors: [{lidra: scan}]}]\n```", "did you mean 'lidar'"),
    "a test that fails": ("```python\ndef test_it():\n    assert 1 == 2\n```", "assert 1 == 2"),
    "an example that fails": ("<!-- run: each -->\n```sh\nrobolink run no_such_node\n```", "ended with 1"),
    "a wrong command that is not run": ("<!-- run: not, no -->\n```sh\nrobolink topic ecko\n```", "no command named"),
    "a comment that nobody knows": ("<!-- run: tpye a -->", "nobody knows what"),
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


HELPED = """
<!-- run: early a.py -->
<!-- run: with PLACE as {port} {port} {port2} -->
```sh
export COLOUR=red
python a.py PLACE   # another number is typed
```

<!-- run: new shell -->
```console
$ python a.py
...
colour none
```

<!-- run: copy walk.yaml as again.yaml -->
<!-- run: try python -c "raise SystemExit(open('again.yaml').read().count('nodes'))" -->
<!-- run: is a.py -->
```python
import os, sys
print(*sys.argv[1:])
print("colour", os.environ.get("COLOUR", "none"))
```

<!-- run: then shot_check.py -->
```python
import numpy as np
image, depths = np.zeros((240, 320, 3)), np.zeros((240, 320))
```
"""


@pytest.mark.processes
def test_hidden_comments_help_a_page(tmp_path: Path) -> None:
    with Shells(tmp_path, 0) as shells:
        shells.run(HELPED)
        first = shells.all[0].lines
    number, same, other = first[0].text.split()
    assert (number == same, number == other, first[1].text) == (True, False, "colour red")


@pytest.mark.processes
def test_examples_are_stopped_when_they_have_said_something(tmp_path: Path) -> None:
    with free_domain() as domain, Shells(tmp_path, domain) as shells:
        shells.run("<!-- run: each -->\n```sh\nrobolink run world\nrobolink world list\n```")
        assert shells.running == []
        assert "world 'obstacles'" in shells.all[0].lines[0].text


def test_blocks_know_their_title_line_and_directive() -> None:
    [block] = blocks('a\n\n<!-- run: fails -->\n```sh title="x"\ny\n```\n')
    assert block == ("sh", "x", "y\n", 4, "fails")


def test_code_is_copied_from_the_english_page() -> None:
    assert with_code_of("a\n```sh\nb\n```\n", "c\n\n```\n```\nd", "page") == "c\n\n```sh\nb\n```\nd\n"
    with pytest.raises(ValueError, match="page: 1 blocks in English, 0 in Portuguese"):
        with_code_of("```\n```", "c", "page")
