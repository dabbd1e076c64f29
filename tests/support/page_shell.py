"""Shell of a page's reader: splits lines into commands, and has the shell's own commands and variables.

Real shells differ between systems. What pages show of them is little: `cd`, `export`, `set -a`, `. FILE`,
`A=B COMMAND`, `;` and `&&`. Nothing is installed: what `pip install` names has to be there.
"""

from __future__ import annotations

import importlib.metadata
import itertools
import re
import shlex
import sys
from pathlib import Path
from string import Template

from tests.support.commands import ROBOLINK

SETTING = re.compile(r"([A-Za-z_]\w*)=(.*)", re.DOTALL)
PROGRAMS = {
    "robolink": ROBOLINK,
    "ros2": ROBOLINK,
    "colcon": (sys.executable, "-c", "import sys; from robolink.cli.shim.colcon import main; sys.exit(main())"),
    "python": (sys.executable,),
    "pytest": (sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "no:xdist"),
}
"""Programs that pages start: those of the test, ros2 and colcon as `robolink shim` makes them."""


class Shell:
    """Folder and variables of a reader, which the shell's own commands change."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.variables = {"LC_ALL": "en_US.UTF-8", "COLORTERM": "truecolor"}

    def commands(self, line: str) -> list[list[str]]:
        """Split a line into commands of words, without comments; variables are replaced by what they are now."""
        words = shlex.shlex(Template(line).safe_substitute({**self.variables, "PWD": str(self.folder)}), posix=True)
        words.whitespace_split, words.commenters = True, "#"
        found: list[list[str]] = [[]]
        for each in words:
            if each == "&&":
                found.append([])
            elif each.endswith(";"):
                found[-1].append(each.removesuffix(";"))
                found.append([])
            else:
                found[-1].append(each)
        return [each for each in found if each]

    def obeys(self, words: list[str]) -> bool:
        """Do what a command of the shell's own asks for; return False if it is a program's."""
        match words:
            case ["cd", folder]:
                self.folder = (self.folder / folder).resolve(strict=True)
            case ["mkdir", *_, folder]:
                (self.folder / folder).mkdir(parents=True)
            case ["source", file]:
                assert (self.folder / file).is_file(), f"no {file}"  # what it sets is known in this folder, anyway
            case ["export", *settings] if settings:
                self.variables.update(_setting(each) for each in settings)
            case [".", file]:
                text = Template((self.folder / file).read_text(encoding="utf-8"))
                lines = text.safe_substitute(PWD=str(self.folder)).splitlines()
                self.variables.update(_setting(each) for each in lines if SETTING.match(each))
            case ["set", "-a" | "+a"]:
                pass  # what is read from a file is exported here, anyway
            case ["pip", "install", *names] if names:
                for each in names:
                    importlib.metadata.distribution(each)
            case _:
                return False
        return True

    def program(self, words: list[str]) -> tuple[tuple[str, ...], dict[str, str]]:
        """Return what runs a command, and the variables that it gets beside those of the test."""
        program = without_settings(words)
        own = dict(_setting(each) for each in words[: len(words) - len(program)])
        words = program
        assert words[0] in PROGRAMS, f"'{words[0]}' is not run by the tests: say <!-- run: not, REASON -->"
        return (*PROGRAMS[words[0]], *words[1:]), {**self.variables, **own}


def lines_of(text: str) -> list[str]:
    """List the lines of a block that have commands; those that a backslash continues are one."""
    lines = text.replace("\\\n", " ").splitlines()
    return [each for each in lines if each.split("#")[0].strip()]


def without_settings(words: list[str]) -> list[str]:
    """Return a command's words without the variables that are set before it."""
    return list(itertools.dropwhile(SETTING.fullmatch, words))


def _setting(text: str) -> tuple[str, str]:
    match = SETTING.fullmatch(text)
    assert match is not None, f"'{text}' sets no variable"
    return match[1], match[2]
