"""Measurement of a newcomer's first minutes: the commands of the first page, in an empty folder, with a wheel alone.

Usage: python -m tools.newcomer DIST [--python PYTHON] [--once]

Prints what each command took: first with packages from the index and no cache of pip, then with packages from a folder.
It ends with 1 if a command fails, or if the robot moves later than a minute after the first command, without the time
that pip waits for packages.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import NamedTuple

from tests.support.commands import Command
from tests.support.domains import free_domain
from tests.support.page_runner import said
from tests.support.page_shell import lines_of
from tests.support.page_words import goes_on
from tools.docs_site.markdown import Block, blocks

PAGE = Path(__file__).resolve().parent.parent / "docs" / "learn" / "first_robot.md"
LIMIT = 60.0
"""Longest time from the first command until the robot moves, in s, without waiting for packages."""
PATIENCE = 600.0
"""Longest time of one command that ends, in s: a slow network."""
MOVES = ("launch", "pub")
"""Verbs of the page after which the robot moves."""
FAR = 0.05
"""Distance in m that counts as moving; a robot that stands is at one place to the last bit."""
LOGGED = re.compile(r"^(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d,\d+) (.*)$", re.MULTILINE)
UNPACKS = "Installing collected packages"

WATCH = f"""
import math, robolink
from robolink.interfaces.nav_msgs.msg import Odometry

robolink.init()
node, begin, moved = robolink.create_node("newcomer"), [], []

def on_odom(odom):
    place = odom.pose.pose.position.x, odom.pose.pose.position.y
    begin.append(place)
    if not moved and math.dist(begin[0], place) > {FAR}:
        moved.append(place)
        print("it moves", flush=True)

node.create_subscription(Odometry, "odom", on_odom, 10)
while not moved:
    robolink.spin_once(node)
"""
"""Program that ends when the robot's odometry, as it comes over the network, shows that it moves."""


class Step(NamedTuple):
    """Time in s that a command took; `waits` if it went by waiting for packages."""

    seconds: float
    words: str
    waits: bool = False
    moves: bool = False
    """True if the robot moved at its end."""


class Newcomer:
    """A person with an empty folder, a wheel and the first page: types its commands, notes what each takes."""

    def __init__(self, folder: Path, wheel: Path, python: str, domain: int, **environ: str) -> None:
        self.home = self.folder = folder
        self.wheel, self.python, self.domain = wheel, python, domain
        self.log = folder.parent / f"{folder.name}.log"
        self.environ = {"PATH": os.environ["PATH"], "PIP_LOG": str(self.log), **environ}
        self.steps: list[Step] = []
        self.running: list[Command] = []

    def read(self, page: str) -> None:
        """Type the commands of a page from its first line to its last."""
        for block in blocks(page):
            self.take(block)
        self.stop()

    def take(self, block: Block) -> None:
        """Type the commands of a block, if it has any."""
        if block.directive == "stop":
            self.stop()
        if block.language == "sh":
            for line in lines_of(block.text):
                self.enter(shlex.split(line, comments=True), fails=block.directive == "fails")

    def enter(self, words: list[str], *, fails: bool) -> None:
        """Type a command; those of the shell itself take no time."""
        if words[0] == "mkdir":
            (self.folder / words[1]).mkdir()
        elif words[0] == "cd":
            self.folder /= words[1]
        elif words[0] == "source":
            self.activate(self.folder / words[1])
        elif words[:2] == ["pip", "install"]:
            self.install()
        elif goes_on(words) and not fails:
            self.begin(words)
        else:
            self.finish(words, fails=fails)

    def activate(self, script: Path) -> None:
        """Have the environment's commands found first, as its script does."""
        programs = script.parent if os.name != "nt" else script.parent.parent / "Scripts"
        assert (programs / script.name).is_file(), f"no {script}"
        self.environ["PATH"] = str(programs) + os.pathsep + self.environ["PATH"]
        self.python = "python"

    def command(self, words: list[str]) -> Command:
        """Start a command in the folder."""
        name = self.python if words[0] == "python" else words[0]
        program = shutil.which(name, path=self.environ["PATH"])
        assert program is not None, f"no command {name}"
        return Command(
            self.domain, program=(program, *words[1:]), merged=True, folder=self.folder, environ=self.environ
        )

    def finish(self, words: list[str], *, fails: bool = False) -> float:
        """Run a command that ends; return its time."""
        with self.command(words) as command:
            code = command.end(PATIENCE)
            assert (code != 0) is fails, f"'{shlex.join(words)}' ended with {code}:\n{said(command)}"
            self.steps.append(Step(command.age(), shlex.join(words)))
        return self.steps[-1].seconds

    def install(self) -> None:
        """Install the wheel, in two steps: until all packages are there, and what comes then."""
        whole = self.finish(["pip", "install", "--quiet", str(self.wheel)])
        waits, size = waiting(self.log.read_text(encoding="utf-8"))
        self.steps[-1:] = [
            Step(waits, f"pip install {self.wheel.name}: waits for packages, {size:.0f} MB", waits=True),
            Step(whole - waits, "pip install: all else"),
        ]

    def begin(self, words: list[str]) -> None:
        """Start a command that goes on; wait until the robot moves, or until it says something."""
        self.running.append(self.command(words))
        moves = words[1] in MOVES
        if moves:
            with self.command(["python", "-c", WATCH]) as watch:
                watch.wait_for("it moves")
        else:
            self.running[-1].wait_for("")
        self.steps.append(Step(self.running[-1].age(), shlex.join(words), moves=moves))

    def stop(self) -> None:
        """Press Ctrl-C in every shell, the youngest first."""
        while self.running:
            with self.running.pop() as command:
                command.interrupt()
                command.end()

    def __enter__(self) -> Newcomer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for command in self.running:
            command.kill()


def waiting(log: str) -> tuple[float, float]:
    """Return the time in s in which pip found and downloaded packages, by its log, and how many megabytes came."""
    lines = [(datetime.strptime(stamp, "%Y-%m-%dT%H:%M:%S,%f"), text) for stamp, text in LOGGED.findall(log)]
    end = next((stamp for stamp, text in lines if text.strip().startswith(UNPACKS)), None)
    assert end is not None, f"pip's log has no line '{UNPACKS}'"
    sizes = re.findall(r"Downloading \S+ \(([\d.]+) ([kM])B\)", log)
    return (end - lines[0][0]).total_seconds(), sum(float(size) / (1000 if unit == "k" else 1) for size, unit in sizes)


def until_it_moves(steps: Iterable[Step]) -> tuple[float, float]:
    """Return the time in s until the robot moves, and how much of it was waiting for packages."""
    whole = waits = 0.0
    for step in steps:
        whole += step.seconds
        waits += step.seconds * step.waits
        if step.moves:
            return whole, waits
    raise AssertionError("the page moves no robot")


def reported(title: str, steps: list[Step]) -> str:
    """Return the lines about one reading of the page."""
    whole, waits = until_it_moves(steps)
    rows = [f"{step.seconds:6.1f} s  {step.words}{' (the robot moves)' * step.moves}" for step in steps]
    last = f"{whole:6.1f} s  from the empty folder until the robot moves, {waits:.1f} s of them waiting for packages"
    return "\n".join([title, *rows, last]) + "\n"


def visit(folder: Path, wheel: Path, python: str, **environ: str) -> list[Step]:
    """Have a newcomer read the first page in an empty folder that is made here; return the steps."""
    folder.mkdir()
    with free_domain() as domain, Newcomer(folder, wheel, python, domain, **environ) as newcomer:
        newcomer.read(PAGE.read_text(encoding="utf-8"))
    return newcomer.steps


def visits(folder: Path, wheel: Path, python: str, once: bool) -> Iterator[tuple[str, list[Step]]]:
    """Yield readings with their titles: one as pip is set up here, or one from the index and one from a folder."""
    if once:
        yield "as pip is set up here", visit(folder / "only", wheel, python)
        return
    yield "packages from the index, no cache", visit(folder / "first", wheel, python, PIP_NO_CACHE_DIR="1")
    packages = str(folder / "packages")
    subprocess.run([python, "-m", "pip", "download", "--quiet", "--dest", packages, str(wheel)], check=True)
    there = visit(folder / "second", wheel, python, PIP_NO_INDEX="1", PIP_FIND_LINKS=packages)
    yield "packages from a folder of this machine", there


def main(words: list[str]) -> int:
    """Measure; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dist", type=Path, help="folder with one wheel")
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--once", action="store_true", help="once, as pip is set up here")
    options = parser.parse_args(words)
    [wheel] = options.dist.absolute().glob("*.whl")
    code = 0
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        try:
            for title, steps in visits(Path(name), wheel, options.python, options.once):
                sys.stdout.write(reported(title, steps))
                whole, waits = until_it_moves(steps)
                code |= whole - waits > LIMIT
        except (AssertionError, subprocess.CalledProcessError) as error:
            sys.stderr.write(f"{error}\n")
            return 1
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
