"""Runner of a page: writes the files that it shows, types its commands, and compares what they say.

A block with a title is a file. A block `sh` is typed line by line; what goes on, as nodes do, runs beside the rest
until the page stops it or ends. A block `console` is what the last command says. A comment before a block tells more:

    <!-- run: fails -->                the command ends with an error
    <!-- run: of careful.py -->        what an earlier command says, which still runs
    <!-- run: stop --> (or stop X)     Ctrl-C in the other shells (in that of X) first
    <!-- run: part of careful.py -->   these lines stand in that file
    <!-- run: not, REASON -->          nothing is run
"""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import yaml

from tests.support.commands import ROBOLINK, Command
from tests.support.console import fits
from tools.docs_site.markdown import Block, blocks

PATIENCE = 60.0
FIRST_WORDS = 1.5
"""Seconds that a command which goes on has for its first line, before the next command is typed."""
ENDS = {
    "launch": ("--duration", "--validate", "--status", "--list", "--stop", "stop", "restart"),
    "echo": ("--once", "--timeout"),
    "pub": ("-1", "--once", "--times", "-t"),
}
"""Verbs that go on, and what ends them; others end by themselves."""
GO_ON = ("run", "launch", "view", "router", "top", "pub")
GO_ON_OF_A_NOUN = ("echo", "hz", "record", "pub", "monitor")
LOOKS = {"list", "info", "--status", "doctor"}
"""Words of commands that look and change nothing: a reader types them again when what they look at is not there yet."""
INTERRUPTED = (0, 130, -2, 0xC000013A)


class Shells:
    """The shells of a reader: a folder, commands that run, and what the last one has said."""

    def __init__(self, folder: Path, domain: int) -> None:
        self.folder, self.domain = folder, domain
        self.all: list[Command] = []
        self.running: list[tuple[str, Command]] = []
        self.last: tuple[str, Command] | None = None

    def run(self, text: str) -> None:
        """Run the blocks of a page, then stop what still runs."""
        for block in blocks(text):
            try:
                self.take(block)
            except Exception as error:
                raise AssertionError(f"line {block.line}: {error}") from error
        self.stop("")

    def take(self, block: Block) -> None:
        """Do what a block asks for."""
        order, _, rest = block.directive.partition(" ")
        if order == "stop":
            self.stop(rest)
        if order == "not,":
            return
        if block.language == "sh":
            for line in shlex_lines(block.text):
                self.type(line, fails=order == "fails")
        elif block.language == "console":
            self.compare(block, rest if order == "of" else "")
        elif order == "part":
            self.find(block, rest.removeprefix("of "))
        elif block.title:
            self.write(block)
        else:
            self.check(block)

    def write(self, block: Block) -> None:
        """Write a file that the page shows."""
        path = self.folder / block.title
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text, encoding="utf-8")

    def check(self, block: Block) -> None:
        """Run or read a block that is no file."""
        if block.language == "python":
            self.last = ("python", self.command((sys.executable, "-c", block.text)))
            assert self.last[1].end(PATIENCE) == 0, said(self.last[1])
        elif block.language == "yaml":
            yaml.safe_load(block.text)
        elif block.language == "json":
            json.loads(block.text)
        else:
            assert block.language == "text", f"nobody knows how to run '{block.language}'"

    def find(self, block: Block, name: str) -> None:
        """Find lines in a file, wherever they are indented."""
        lines = [each.strip() for each in (self.folder / name).read_text(encoding="utf-8").splitlines()]
        wanted = [each.strip() for each in block.text.splitlines()]
        starts = range(len(lines) - len(wanted) + 1)
        assert any(lines[at : at + len(wanted)] == wanted for at in starts), f"not in {name}: {wanted}"

    def type(self, line: str, *, fails: bool) -> None:
        """Type a command."""
        words = shlex.split(line)
        command = self.command(program_of(words))
        self.last = (line, command)
        if goes_on(words) and not fails:
            self.running.append(self.last)
            wait(lambda: bool(command.lines), FIRST_WORDS)
            return
        code = command.end(PATIENCE)
        assert (code != 0) is fails, f"'{line}' ended with {code}: {said(command)}"

    def command(self, program: tuple[str, ...]) -> Command:
        """Start a program in the reader's folder."""
        self.all.append(Command(self.domain, program=program, merged=True, folder=self.folder))
        return self.all[-1]

    def compare(self, block: Block, name: str) -> None:
        """Compare what a command has said, or says within the patience, with what is shown."""
        found = [each for each in self.running if name in each[0]] if name else [self.last]
        if not found or (last := found[-1]) is None:
            raise AssertionError("no such command was typed before this output")
        line, command = last
        shown = block.text.splitlines()
        goes = (line, command) in self.running
        waits = block.text.lower().startswith("waiting")
        exact = "simulate" in line or "pytest" in line

        def is_there() -> bool:
            lines = [each for each in said(command).splitlines() if waits or not each.lower().startswith("waiting")]
            return fits(shown, lines, exact=exact, whole=not goes)

        if not goes and self.running and LOOKS & set(shlex.split(line)):
            end = time.monotonic() + PATIENCE
            while not is_there() and time.monotonic() < end:  # what is looked at is still starting: look again
                command = self.command(program_of(shlex.split(line)))
                command.end(PATIENCE)
        assert wait(is_there, PATIENCE if goes else 0.0), f"'{line}' says\n{said(command)}\nand not\n{block.text}"

    def stop(self, name: str) -> None:
        """Press Ctrl-C where commands run whose lines have this in them, the youngest first."""
        stopped = [each for each in self.running if name in each[0]]
        assert stopped or not name, f"nothing runs that has '{name}' in it"
        for line, command in reversed(stopped):
            self.running.remove((line, command))
            command.interrupt()
            try:
                code = command.end(PATIENCE)
            except subprocess.TimeoutExpired:
                raise AssertionError(f"Ctrl-C does not end '{line}': {said(command)}") from None
            assert code in INTERRUPTED, f"'{line}' ended with {code}: {said(command)}"

    def __enter__(self) -> Shells:
        return self

    def __exit__(self, *error: object) -> None:
        """End all that runs, as after a failure."""
        with ExitStack() as stack:
            for command in self.all:
                stack.push(command)


def shlex_lines(text: str) -> list[str]:
    """List the commands of a block: lines that a backslash continues are one, comments are left out."""
    joined = text.replace("\\\n", " ").splitlines()
    return [each for line in joined if (each := shlex.join(shlex.split(line, comments=True)))]


def program_of(words: list[str]) -> tuple[str, ...]:
    """Return what runs a command: robolink, Python and pytest are those of the test."""
    known = {
        "robolink": ROBOLINK,
        "python": (sys.executable,),
        "pytest": (sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "no:xdist"),
    }
    assert words[0] in known, f"'{words[0]}' is not run by the tests: say <!-- run: not, REASON -->"
    return (*known[words[0]], *words[1:])


def goes_on(words: list[str]) -> bool:
    """Return True if a command runs until Ctrl-C."""
    verb = next((each for each, verbs in zip(words[1:3], (GO_ON, GO_ON_OF_A_NOUN), strict=False) if each in verbs), "")
    return bool(verb) and words[0] == "robolink" and not set(ENDS.get(verb, ())) & set(words) and "--help" not in words


def said(command: Command) -> str:
    """Output of a command so far."""
    return "\n".join(each.text for each in command.lines)


def wait(condition: object, seconds: float) -> bool:
    """Wait until a condition holds, at most so long; return whether it does."""
    assert callable(condition)
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
