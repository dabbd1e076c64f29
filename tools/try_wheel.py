"""Trial of a wheel as a newcomer has it: installed in a new environment, used from an empty folder, one line a step.

Usage: python tools/try_wheel.py DIST [--python PYTHON] [--constraints FILE]
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

PROGRAM = """\
from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist


class Mine(Node):
    def __init__(self):
        super().__init__("mine")
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        twist = Twist()
        twist.linear.x = 0.3
        self.cmd_vel.publish(twist)
"""
TEST = """\
def test_it_drives(system):
    system.start("world", parameters={"world": "empty_room"})
    system.start("mine.py")
    system.run(5.0)
    assert system.robot().driven > 1.0
"""
SYSTEM = "nodes:\n  - {node: world}\n  - {node: mine.py}\n"
STEPS: tuple[tuple[str, ...], ...] = (
    ("robolink", "--version"),
    ("robolink", "launch", "wander", "--duration", "3"),
    ("robolink", "simulate", "mine.yaml", "--duration", "10"),
    ("robolink", "view", "--help"),
    ("robolink", "learn", "--help"),
    ("robolink", "interface", "show", "Twist"),
    ("python", "-m", "pytest", "-q", "test_mine.py"),
)
"""Commands tried with the installed wheel; each must end with exit code 0."""


def steps(wheel: Path, python: str, constraints: str, folder: Path) -> Iterator[list[str]]:
    """Yield the commands: an environment, the wheel with the extra for tests, and its use."""
    scripts = folder / "env" / ("Scripts" if os.name == "nt" else "bin")
    yield [python, "-m", "venv", str(folder / "env")]
    pinned = ["-c", str(Path(constraints).absolute())] if constraints else []
    yield [str(scripts / "python"), "-m", "pip", "install", "--quiet", *pinned, f"{wheel}[test]"]
    for program, *words in STEPS:
        yield [str(scripts / program), *words]


def main() -> int:
    """Try the wheel; return the exit code of the first step that fails, or 0."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dist", type=Path, help="folder with one wheel")
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--constraints", default="", help="file for pip's -c")
    options = parser.parse_args()
    [wheel] = options.dist.absolute().glob("*.whl")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        home = folder / "home"
        home.mkdir()
        for file, text in {"mine.py": PROGRAM, "test_mine.py": TEST, "mine.yaml": SYSTEM}.items():
            (home / file).write_text(text, encoding="utf-8")
        for command in steps(wheel, options.python, options.constraints, folder):
            started = time.monotonic()
            done = subprocess.run(command, cwd=home, stdout=subprocess.DEVNULL, check=False)
            words = " ".join([Path(command[0]).name, *command[1:]])
            sys.stdout.write(f"{time.monotonic() - started:6.1f} s  exit {done.returncode}  {words}\n")
            if done.returncode:
                return done.returncode
    return 0


if __name__ == "__main__":
    sys.exit(main())
