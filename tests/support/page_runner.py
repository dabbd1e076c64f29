"""Runner of a page: writes the files that it shows, types its commands, and compares what they say.

A block with a title is a file. A block `sh` is typed line by line; what goes on, as nodes do, runs beside the rest
until the page stops it or ends. A block `console` is what the last command says; lines of it that begin with `$ ` are
typed. Other blocks are run or read as what they are: a program, a test, a launch file, a world. A comment before a
block tells more:

    <!-- run: fails -->                the command ends with an error
    <!-- run: each -->                 examples: what goes on is stopped when it has said something
    <!-- run: terminal -->             each command has a terminal of its own, but on Windows; `each terminal`
    <!-- run: of careful.py -->        what an earlier command says, which still runs
    <!-- run: stop --> (or stop X)     Ctrl-C in the other shells (in that of X) first
    <!-- run: part of careful.py -->   these lines stand in that file
    <!-- run: is careful.py -->        a file, whose name the page does not show as a title
    <!-- run: after NAME -->           lines that go on after those of tests/data/pages/NAME, or
    <!-- run: then NAME -->            before them
    <!-- run: not, REASON -->          nothing is run; its commands have to be right, all the same

A comment that stands alone is done at its place, and the reader does not see it:

    <!-- run: type COMMAND -->         a command, such as a world beside the page
    <!-- run: try COMMAND -->          the same for one that ends, with an error or not
    <!-- run: copy NAME -->            the file or folder tests/data/pages/NAME; copy A as B gives it another name
    <!-- run: early NAME -->           the file that the page shows further below
    <!-- run: with A as B -->          in commands from here on, B is typed for A; {port} and {port2} are free
    <!-- run: new shell -->            the folder and the variables of the beginning
    <!-- run: stop -->                 as above
"""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
import time
from collections import defaultdict
from contextlib import ExitStack
from pathlib import Path

from tests.support import page_words
from tests.support.commands import ROBOLINK, TERMINAL, Command
from tests.support.console import fits
from tests.support.page_inside import Ended, is_for_here, run_here
from tests.support.page_kinds import program_for, read
from tests.support.page_shell import Shell, lines_of
from tests.support.ports import free_port
from tools.docs_site.markdown import DIRECTIVE, Block, blocks

PATIENCE = 60.0
FIRST_WORDS = 1.0
"""Seconds that a command which goes on has for its first line, before the next command is typed."""
LOOKS = {"list", "info", "--status", "doctor"}
"""Words of commands that look and change nothing: a reader types them again when what they look at is not there yet."""
STARTING = re.compile(r"^robolink: (no node named|gave up after .* nobody serves)", re.MULTILINE)
"""Errors of a command that asks a node which is still starting, on a busy machine: it is typed again."""
INTERRUPTED = (0, 130, -2, 0xC000013A)
ALONE = ("type", "try", "copy", "early", "with", "new")
"""Orders that are no block's own, even where one follows."""
GIVEN = Path(__file__).parents[1] / "data" / "pages"
"""Files and folders that a page speaks of and does not show."""


class Shells:
    """The shells of a reader: a folder, commands that run, and what the last one has said."""

    def __init__(self, folder: Path, domain: int) -> None:
        self.folder, self.domain = folder, domain
        self.shell = Shell(folder)
        self.steps: list[Block] = []
        self.instead: dict[str, str] = {}
        self.ports: defaultdict[str, int] = defaultdict(free_port)
        self.all: list[Command] = []
        self.running: list[tuple[str, Command]] = []
        self.last: tuple[str, Command | Ended] | None = None

    def run(self, text: str) -> None:
        """Run the blocks of a page, then stop what still runs."""
        self.steps = steps(text)
        for step in self.steps:
            try:
                self.take(step)
            except Exception as error:
                raise AssertionError(f"line {step.line}: {error}") from error
        self.stop("")

    def take(self, block: Block) -> None:
        """Do what a block asks for, or a comment that stands alone."""
        order, _, rest = block.directive.partition(" ")
        if order == "stop":
            self.stop(rest)
        if block.language == "run":
            self.obey(order, rest)
        elif order == "not," or ("terminal" in block.directive and sys.platform == "win32"):
            page_words.check(block)
        elif block.language == "sh":
            self.type_all(block.text, *block.directive.split())
        elif block.language == "console":
            self.screen(block, rest if order == "of" else "")
        elif order == "part":
            self.find(block, rest.removeprefix("of "))
        elif block.title or order == "is":
            self.write(block, block.title or rest)
        else:
            given = (GIVEN / rest).read_text(encoding="utf-8") if order in ("after", "then") else ""
            self.check(block._replace(text=given + block.text if order == "after" else block.text + given))

    def obey(self, order: str, rest: str) -> None:
        """Do what a comment that stands alone asks for."""
        if order in ("type", "try"):
            self.type_all(rest, order)
        elif order == "copy":
            name, _, own = rest.partition(" as ")
            source, target = GIVEN / name, self.folder / (own or name)
            target.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if source.is_dir() else shutil.copyfile)(source, target)
        elif order == "early":
            names = [(each.title or each.directive.removeprefix("is "), each) for each in self.steps]
            self.write(next(each for name, each in names if name == rest), rest)
        elif order == "with":
            shown, _, typed = rest.partition(" as ")
            self.instead[shown] = re.sub(r"\{(port\d?)\}", lambda match: str(self.ports[match[1]]), typed)
        elif (order, rest) == ("new", "shell"):
            self.shell = Shell(self.folder)
        else:
            assert order == "stop", f"nobody knows what '{order} {rest}' asks for"

    def write(self, block: Block, name: str) -> None:
        """Write a file that the page shows."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text, encoding="utf-8")

    def check(self, block: Block) -> None:
        """Run or read a block that is not a file."""
        if program := program_for(block, self.shell.folder):
            if program[: len(ROBOLINK)] == ROBOLINK:
                self.type(["robolink", *program[len(ROBOLINK) :]], "ends")
                return
            command = self.command(program, {})
            self.last = (block.language, command)
            assert command.end(PATIENCE) == 0, said(command)
        else:
            read(block)

    def find(self, block: Block, name: str) -> None:
        """Find lines in a file, wherever they are indented."""
        lines = [each.strip() for each in (self.folder / name).read_text(encoding="utf-8").splitlines()]
        wanted = [each.strip() for each in block.text.splitlines()]
        starts = range(len(lines) - len(wanted) + 1)
        assert any(lines[at : at + len(wanted)] == wanted for at in starts), f"not in {name}: {wanted}"

    def type_all(self, text: str, *orders: str) -> None:
        """Type the commands of lines: `fails` and `each` are as above; `try` if their exit code says nothing."""
        for line in lines_of(text):
            for shown, typed in self.instead.items():
                line = line.replace(shown, typed)
            for words in self.shell.commands(line):
                running = list(self.running)
                if not self.shell.obeys(words):
                    self.type(words, *orders)
                if "each" in orders and self.running != running:
                    self.stop_talking(*self.running.pop())

    def type(self, words: list[str], *orders: str) -> None:
        """Type a command."""
        line = shlex.join(words)
        program, variables = self.shell.program(words)
        if is_for_here(words[1:]) and "terminal" not in orders:
            ended = run_here(words[1:], self.shell.folder, self.domain, variables)
            end = time.monotonic() + PATIENCE
            while self.running and STARTING.search(said(ended)) and not {"fails", "try"} & set(orders):
                assert time.monotonic() < end, f"'{line}' fails: {said(ended)}"
                ended = run_here(words[1:], self.shell.folder, self.domain, variables)
            self.last = (line, ended)
            assert "try" in orders or (ended.code != 0) is ("fails" in orders), f"'{line}' fails: {said(ended)}"
            return
        command = self.command(program, variables, on_terminal="terminal" in orders)
        self.last = (line, command)
        if page_words.goes_on(words) and not {"fails", "try", "ends"} & set(orders):
            self.running.append((line, command))
            wait(lambda: has_said(command), FIRST_WORDS)
            return
        code = command.end(PATIENCE)
        assert "try" in orders or (code != 0) is ("fails" in orders), f"'{line}' ended with {code}: {said(command)}"

    def command(self, program: tuple[str, ...], variables: dict[str, str], *, on_terminal: bool = False) -> Command:
        """Start a program in the reader's folder."""
        words = (sys.executable, "-c", TERMINAL, *program) if on_terminal else program
        self.all.append(
            Command(
                self.domain,
                program=words,
                has_input=on_terminal,
                merged=True,
                folder=self.shell.folder,
                environ=variables,
            )
        )
        return self.all[-1]

    def screen(self, block: Block, name: str) -> None:
        """Type the commands of a screen, if it has any, and compare what it shows."""
        if not block.text.startswith("$ "):
            self.compare(block.text, name)
            return
        for each in block.text.removeprefix("$ ").split("\n$ "):
            line, _, shown = each.partition("\n")
            self.type_all(line, "try" if shown.strip() else "")
            if shown.strip():
                self.compare(shown, "")

    def compare(self, text: str, name: str) -> None:
        """Compare what a command has said, or says within the patience, with what is shown."""
        found = [self.last] if not name and self.last else [each for each in self.running if name and name in each[0]]
        assert found, "no such command was typed before this output"
        line, command = found[-1]
        shown = text.splitlines()
        goes = (line, command) in self.running
        waits = text.lower().startswith("waiting")
        exact = "simulate" in line or "pytest" in line

        def is_there() -> bool:
            lines = [each for each in said(command).splitlines() if waits or not each.lower().startswith("waiting")]
            return fits(shown, lines, exact=exact, whole=not goes)

        if not goes and self.running and LOOKS & set(shlex.split(line)):
            end = time.monotonic() + PATIENCE
            while not is_there() and time.monotonic() < end:  # what is looked at is still starting: look again
                command = self.command(*self.shell.program(shlex.split(line)))
                command.end(PATIENCE)
        assert wait(is_there, PATIENCE if goes else 0.0), f"'{line}' says\n{said(command)}\nand not\n{text}"

    def stop(self, name: str) -> None:
        """Press Ctrl-C where commands run whose lines have this in them, the youngest first."""
        stopped = [each for each in self.running if name in each[0]]
        assert stopped or not name, f"nothing runs that has '{name}' in it"
        for _, command in reversed(stopped):
            press_ctrl_c(command)
        for each in stopped:
            self.running.remove(each)
            check_end(*each)

    def stop_talking(self, line: str, command: Command) -> None:
        """Press Ctrl-C in a command as soon as it has said something, which shows that it runs."""
        wait(lambda: has_said(command) or command.process.poll() is not None, PATIENCE)
        assert has_said(command), f"'{line}' says nothing"
        if command.lines[0].text.startswith("robolink: "):  # as errors do, after which it ends by itself
            wait(lambda: command.process.poll() is not None, FIRST_WORDS)
        press_ctrl_c(command)
        check_end(line, command)

    def __enter__(self) -> Shells:
        return self

    def __exit__(self, *error: object) -> None:
        """End all that runs, as after a failure."""
        with ExitStack() as stack:
            for command in self.all:
                stack.push(command)


def steps(text: str) -> list[Block]:
    """List what is done with a page: its blocks, and the comments between them as blocks in the language `run`."""
    fenced = [each._replace(directive="") if is_alone(each.directive) else each for each in blocks(text)]
    taken = {number for each in fenced for number in range(each.line, each.line + each.text.count("\n") + 2)}
    taken |= {each.line - 1 for each in fenced if each.directive}
    alone = [
        Block("run", "", "", number, match[1])
        for number, line in enumerate(text.splitlines(), 1)
        if number not in taken and (match := DIRECTIVE.match(line))
    ]
    return sorted(fenced + alone, key=lambda each: each.line)


def is_alone(directive: str) -> bool:
    """Return True if a comment is done by itself, and says nothing about the block below."""
    return directive.partition(" ")[0] in ALONE


def press_ctrl_c(command: Command) -> None:
    """Press Ctrl-C in a command, on its terminal if it has one."""
    if command.process.stdin is not None and command.process.poll() is None:
        command.press("\x03")
    else:
        command.interrupt()


def check_end(line: str, command: Command) -> None:
    """Fail if a command does not end after Ctrl-C, or not well."""
    try:
        code = command.end(PATIENCE)
    except subprocess.TimeoutExpired:
        raise AssertionError(f"Ctrl-C does not end '{line}': {said(command)}") from None
    assert code in INTERRUPTED, f"'{line}' ended with {code}: {said(command)}"


def said(command: Command | Ended) -> str:
    """Output of a command so far."""
    return "\n".join(each.text for each in command.lines)


def has_said(command: Command) -> bool:
    """Return True if a command has said something but that it waits."""
    return any(not each.text.startswith("waiting") for each in command.lines)


def wait(condition: object, seconds: float) -> bool:
    """Wait until a condition holds, at most so long; return whether it does."""
    assert callable(condition)
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
