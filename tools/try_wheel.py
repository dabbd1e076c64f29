"""Trial of a wheel and an sdist as users have them: new environments, empty folders, one line for each command.

Usage: python tools/try_wheel.py DIST [--ways every] [--python PYTHON]... [--constraints FILE]

A way is a new environment and what is done in it: `pip` (the wheel with the extra for tests, and most of what a user
does), `sdist`, `uv` and `pipx` (as tools), and a way for each extra. It needs nothing but Python and a package index.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

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
XACRO = """\
<robot name="small" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="side" value="0.5"/>
  <link name="base"><visual><geometry><box size="${side * 2} 1 1"/></geometry></visual></link>
</robot>
"""
DURING = """\
import math
import subprocess
import sys

import rclpy
from nav_msgs.msg import Odometry


def main():
    launch = subprocess.Popen(["robolink", "launch", "wander", "--duration", "60"], stdout=subprocess.DEVNULL)
    try:
        wait_until_it_moves()
        code = subprocess.call(["robolink", *sys.argv[1:]]) if sys.argv[1:] else 0
    finally:
        launch.terminate()
        launch.wait()
    sys.exit(code)


def wait_until_it_moves():
    places = []
    rclpy.init()
    node = rclpy.create_node("watch")
    node.create_subscription(Odometry, "odom", lambda odom: places.append(odom.pose.pose.position), 10)
    while not places or math.dist((places[0].x, places[0].y), (places[-1].x, places[-1].y)) < 0.05:
        rclpy.spin_once(node)


if __name__ == "__main__":
    main()
"""
"""Launches a robot; when its odometry shows, over the network, that it moves, calls robolink with its own arguments."""
FILES = {"mine.py": PROGRAM, "test_mine.py": TEST, "mine.yaml": SYSTEM, "small.xacro": XACRO, "during.py": DURING}


class Step(NamedTuple):
    """A command that is tried: its words, its exit code, the folder where it is typed, and what it should say."""

    words: str
    code: int = 0
    folder: str = "."
    says: str = ""


USED = (
    Step("robolink --version"),
    Step("robolink run during.py"),
    Step("robolink simulate mine.yaml --duration 10"),
    Step("robolink view --help"),
)
LEARNT = (
    Step("robolink learn"),
    Step("robolink learn start"),
    Step("robolink learn check", 1, "learn_robolink", "01_walk.py"),  # as it is given, the first exercise fails
    Step("robolink new project mine"),
    Step("robolink simulate mine --duration 10", 0, "mine"),
    Step("robolink interface show Twist"),
)
EXTRAS = {
    "bag": (
        Step("robolink simulate mine.yaml --duration 10 --record walk"),
        Step("robolink bag convert walk small --compression zstd"),
        Step("robolink bag convert small smaller --compression lz4"),
        Step("robolink bag info smaller", says="/cmd_vel"),
    ),
    "plot": (Step("robolink run during.py plot topic /odom.pose.pose.position.x --duration 1 --out walk.png"),),
    "security": (
        Step("robolink security create_keystore keys"),
        Step("robolink security create_enclave keys /mine"),
        Step("robolink security list_enclaves keys", says="/mine"),
    ),
    "test": (Step("python -m pytest -q test_mine.py", says="1 passed"), Step("python -m pytest -q", 0, "mine")),
    "vision": (Step("robolink simulate track --duration 5"),),
    "xacro": (Step("robolink run xacro xacro small.xacro", says='size="1.0 1 1"'),),
}
"""What each extra is for; the second one of `test` is in a project that `robolink new` makes."""
PROJECT = Step("robolink new project mine")


class Try(NamedTuple):
    """One trial: its way, the files that it installs, a Python, constraints for pip, and its own folder."""

    way: str
    wheel: Path
    sdist: Path
    python: str
    constraints: str
    folder: Path

    @property
    def programs(self) -> Path:
        """Folder of the environment's commands."""
        return programs_of(self.folder / "env")


def programs_of(environment: Path) -> Path:
    """Return the folder of an environment's commands."""
    return environment / ("Scripts" if os.name == "nt" else "bin")


def by_pip(what: str) -> Callable[[Try], list[list[str]]]:
    """Return a maker of the commands that install a file, with an extra or none, into a new environment."""

    def commands(trial: Try) -> list[list[str]]:
        file = str(trial.sdist if what == "sdist" else trial.wheel) + (f"[{what}]" if what in (*EXTRAS, "all") else "")
        pinned = ["-c", str(Path(trial.constraints).absolute())] if trial.constraints else []
        return [
            [trial.python, "-m", "venv", str(trial.folder / "env")],
            [str(trial.programs / "python"), "-m", "pip", "install", "--quiet", *pinned, file],
            [str(trial.programs / "python"), "-m", "pip", "check"],
        ]

    return commands


def by_tool(*words: str) -> Callable[[Try], list[list[str]]]:
    """Return a maker of the commands that get an installer of tools, and have it install the wheel."""

    def commands(trial: Try) -> list[list[str]]:
        installer = programs_of(trial.folder / "installer")
        return [
            [trial.python, "-m", "venv", str(trial.folder / "installer")],
            [str(installer / "python"), "-m", "pip", "install", "--quiet", words[0]],
            [str(installer / words[0]), *words[1:], "--python", trial.python, str(trial.wheel)],
        ]

    return commands


class Way(NamedTuple):
    """How robolink is installed, and what is then done with it."""

    install: Callable[[Try], list[list[str]]]
    steps: tuple[Step, ...]


ALL_EXTRAS = tuple(step for name in EXTRAS for step in EXTRAS[name])
WAYS: dict[str, Way] = {
    "pip": Way(by_pip("test"), (*USED, *LEARNT, *EXTRAS["test"])),
    "sdist": Way(by_pip("sdist"), USED),
    "uv": Way(by_tool("uv", "tool", "install"), (*USED, *LEARNT)),
    "pipx": Way(by_tool("pipx", "install"), (*USED, *LEARNT)),
    **{name: Way(by_pip(name), (PROJECT, *steps)) for name, steps in EXTRAS.items()},
    "all": Way(by_pip("all"), (PROJECT, *ALL_EXTRAS)),
}


def environ(trial: Try) -> dict[str, str]:
    """Return the environment variables of a trial: its own commands first, and nothing of it outside of its folder."""
    tools = {
        "UV_TOOL_DIR": "tools",
        "UV_CACHE_DIR": "cache",
        "UV_TOOL_BIN_DIR": "env",
        "PIPX_HOME": "tools",
        "PIPX_BIN_DIR": "env",
    }
    own = {name: str(trial.folder / place) for name, place in tools.items()}
    own["UV_TOOL_BIN_DIR"] = own["PIPX_BIN_DIR"] = str(trial.programs)
    domain = os.environ.get("ROS_DOMAIN_ID", str(100 + os.getpid() % 100))
    path = str(trial.programs) + os.pathsep + os.environ["PATH"]
    return {**os.environ, **own, "PATH": path, "ROS_DOMAIN_ID": domain, "MPLBACKEND": "agg"}


def tried(trial: Try) -> int:
    """Carry out a trial; return 0, or 1 at the first command that does not end as it should."""
    home = trial.folder / "home"
    home.mkdir(parents=True)
    for file, text in FILES.items():
        (home / file).write_text(text, encoding="utf-8")
    way = WAYS[trial.way]
    steps = [(command, Step("")) for command in way.install(trial)]
    steps += [(_command(trial, step), step) for step in way.steps]
    return next((1 for command, step in steps if not _ends_well(command, home, step, trial)), 0)


def _command(trial: Try, step: Step) -> list[str]:
    program, *words = step.words.split()
    return [str(trial.programs / program), *words]


def _ends_well(command: Sequence[str], home: Path, step: Step, trial: Try) -> bool:
    """Run a command and tell its time and its end; tell all that it said if it ends otherwise than it should."""
    started = time.monotonic()
    done = subprocess.run(
        command,
        cwd=home / step.folder,
        env=environ(trial),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    words = " ".join([Path(command[0]).name, *command[1:]])
    tell(f"{trial.way:8} {time.monotonic() - started:6.1f} s  exit {done.returncode}  {words}")
    said = done.stdout.decode(errors="replace")
    ends_well = done.returncode == step.code and step.says in said
    if not ends_well:
        tell(f"it should have been exit {step.code}, with '{step.says}' in what it says:\n{said}")
    return ends_well


def tell(line: str) -> None:
    """Print a line at once, on any terminal."""
    coding = sys.stdout.encoding or "ascii"
    sys.stdout.write(line.encode(coding, "replace").decode(coding) + "\n")
    sys.stdout.flush()


def main(words: list[str]) -> int:
    """Try all that is asked for; return 1 if anything fails."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dist", type=Path, help="folder with one wheel, and one sdist if it is tried")
    parser.add_argument("--ways", default="pip", help=f"separated by commas, or `every`: {', '.join(WAYS)}")
    parser.add_argument("--python", action="append", help="as often as needed; this one by default")
    parser.add_argument("--constraints", default="", help="file for pip's -c")
    options = parser.parse_args(words)
    ways = list(WAYS) if options.ways == "every" else options.ways.split(",")
    [wheel] = options.dist.absolute().glob("*.whl")
    sdist = next(options.dist.absolute().glob("*.tar.gz"), wheel)
    failed = []
    for python in options.python or [sys.executable]:
        for way in ways:
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
                if tried(Try(way, wheel, sdist, python, options.constraints, Path(name))):
                    failed.append(f"{way} with {python}")
    tell(f"failed: {', '.join(failed)}" if failed else "all went well")
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
