"""Soak test: starts and stops a system of five nodes, kills processes at random, and checks for left-overs.

    python -m tests.support.soak [--rounds 1000] [--seed 1]

Each round starts `robolink launch` and ends it in one way of KINDS, at a moment drawn from the seed: while it starts,
while it runs, or while it stops. Afterwards there must be no process left, no port, no file, no more shared memory
than one round needs, and no more logs than are kept.
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import psutil

from robolink.networks.request import FIRST_PORT
from robolink.supervisor.reporting.logs import MOST_RUNS
from robolink.transport.port_sharing import is_free
from tests.support.domains import free_domain

NODES = 5
PATIENCE = 30.0
"""Seconds within which all has gone, however slow the machine is; more than a stop may take with all its steps."""
MARK = "ROBOLINK_SOAK"
_NODE = '''
"""Publishes, hears, serves its parameters; says once that it spins."""
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class Member(Node):
    def __init__(self):
        super().__init__("member")
        self.publisher = self.create_publisher(String, "said", 10)
        self.create_subscription(String, "said", self.hear, 10)
        self.create_timer(0.05, self.tell)
        self.has_told = False

    def hear(self, message):
        pass

    def tell(self):
        self.publisher.publish(String(data="hello"))
        if not self.has_told:
            self.has_told = True
            print("spins")
'''
_SHARED_MEMORY = Path("/dev/shm")
_MAPPED = re.compile(r"/dev/shm/(\S+)")
_OF_FAST_DDS = "fastdds_", "fastrtps_", "sem.fast"


class Soak:
    """Runs rounds in a folder of its own, on one domain; a round raises AssertionError that says what is left."""

    def __init__(self, folder: Path, domain: int, seed: int) -> None:
        self.folder, self.domain, self._random = folder, domain, random.Random(seed)
        self._mark = f"{os.getpid()}-{seed}-{time.time_ns()}"
        for name in ("nodes", "configs", "tmp", "home", "logs"):
            (folder / name).mkdir()
        (folder / "run").mkdir(mode=0o700)
        (folder / "nodes" / "member.py").write_text(_NODE)
        entry = f'{{node: member, name: "member_{{i}}", count: {NODES}}}'
        (folder / "configs" / "five.yaml").write_text(f"nodes:\n  - {entry}\n")
        self._shared_memory = len(forgotten_memory())

    def round(self, kind: str) -> None:
        """Start the system and end it in this way."""
        with (self.folder / "output").open("w+b") as output:
            launcher = subprocess.Popen(
                [sys.executable, "-m", "robolink", "launch", "five"],
                cwd=self.folder,
                env=self._environment(),
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
            try:
                KINDS[kind](self, launcher)
                self._wait(lambda: launcher.poll() is not None, "the launcher has not ended")
                self._wait(lambda: not self.processes(), "processes are left")
                self._check_files(launcher)
                self._check_code(kind, launcher.returncode)
            except AssertionError as error:
                said = (self.folder / "output").read_text(errors="replace")
                raise AssertionError(f"{kind}: {error}\nthe launcher printed:\n{said}") from None
            finally:
                self._end_all(launcher)

    # Ways to end it

    def stop(self, launcher: subprocess.Popen[bytes]) -> None:
        """Ctrl-C when all nodes spin."""
        self._wait_until_up(launcher)
        launcher.send_signal(signal.SIGINT)

    def stop_early(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGTERM at any moment of the start."""
        self._pass(1.5)
        launcher.send_signal(signal.SIGTERM)

    def kill_launcher(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGKILL of the launcher, at any moment."""
        self._pass(2.0)
        launcher.kill()

    def kill_launcher_as_it_stops(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGKILL of the launcher a moment after Ctrl-C."""
        self._wait_until_up(launcher)
        launcher.send_signal(signal.SIGINT)
        self._pass(0.5)
        launcher.kill()

    def kill_node(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGKILL of a node, at any moment: its end is the system's."""
        self._wait(lambda: self._of("run") or launcher.poll() is not None, "no node was started")
        self._pass(1.5)
        self._kill(self._of("run"), 1)
        launcher.send_signal(signal.SIGINT)  # if there was none

    def kill_guardian(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGKILL of the guardian, at any moment, and Ctrl-C: the system ends all the same."""
        self._wait_until_up(launcher)
        self._kill(self._of("guardian.py"), 1)
        self._pass(0.3)
        launcher.send_signal(signal.SIGINT)

    def kill_launcher_and_guardian(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGKILL of both that watch: the lifelines are left."""
        self._wait_until_up(launcher)
        self._kill([psutil.Process(launcher.pid), *self._of("guardian.py")], 2)

    def kill_all(self, launcher: subprocess.Popen[bytes]) -> None:
        """SIGKILL of everything at once, at any moment."""
        self._pass(2.0)
        launcher.kill()
        self._kill(self.processes(), 100)

    # What is there

    def processes(self) -> list[psutil.Process]:
        """All processes of this soak, whatever group they are in and whoever is their parent; also its zombies."""
        found = []
        for process in psutil.process_iter():
            with contextlib.suppress(psutil.Error, OSError):
                if process.environ().get(MARK) == self._mark:
                    found.append(process)
        return found

    def words(self) -> list[Path]:
        """The files that launchers have left to be found by."""
        return list((self.folder / "run").glob("robolink/launch-*"))

    def _of(self, word: str) -> list[psutil.Process]:
        found = []
        for process in self.processes():
            with contextlib.suppress(psutil.Error):
                if any(Path(each).name == word for each in process.cmdline()):
                    found.append(process)
        return found

    def _check_files(self, launcher: subprocess.Popen[bytes]) -> None:
        zombies = [each for each in psutil.Process().children() if each.status() == psutil.STATUS_ZOMBIE]
        assert not zombies, f"zombies are left: {zombies}"
        port = FIRST_PORT + self.domain
        # A killed process lets go of its sockets a moment after it is seen no more.
        self._wait(lambda: is_free(port), f"somebody listens at the rendezvous port {port}")
        for name in ("tmp", "home"):
            assert not list((self.folder / name).iterdir()), f"{name}: {list((self.folder / name).iterdir())}"
        # One that is killed cannot take back its word; the next one that lives long enough does.
        word = [each for each in self.words() if each.name.startswith(f"launch-{launcher.pid}-")]
        assert launcher.returncode == -9 or not word, f"a word of the launcher is left: {word}"
        runs = [each for each in (self.folder / "logs").iterdir() if not each.is_symlink()]
        assert launcher.returncode < 0 or len(runs) <= MOST_RUNS, f"logs of {len(runs)} runs"
        # What a session leaves there the next one sweeps; what others on this machine have just made is mapped soon.
        most = self._shared_memory + 4 * NODES
        self._wait(lambda: len(forgotten_memory()) <= most, "shared memory is left")

    def _check_code(self, kind: str, code: int) -> None:
        """A launcher that stops on request says that all went well; one crash at the end would be its exit code."""
        wanted = {"stop": {0}, "kill_guardian": {0}, "kill_node": {0, 130, 137, -2}, "stop_early": {0, 143, -15}}
        assert code in wanted.get(kind, {0, -9}), f"the exit code was {code}"

    def _wait(self, condition: Callable[[], object], otherwise: str) -> None:
        deadline = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"{otherwise}: {[_described(each) for each in self.processes()]}")
            time.sleep(0.02)

    def _wait_until_up(self, launcher: subprocess.Popen[bytes]) -> None:
        output = self.folder / "output"
        self._wait(lambda: output.read_bytes().count(b"] spins") == NODES or launcher.poll() is not None, "not up")

    def _pass(self, most: float) -> None:
        """Let some time pass: when it comes must not matter."""
        time.sleep(self._random.uniform(0.0, most))

    def _kill(self, processes: list[psutil.Process], most: int) -> None:
        for process in self._random.sample(processes, min(most, len(processes))):
            with contextlib.suppress(psutil.Error):
                process.kill()

    def _environment(self) -> dict[str, str]:
        folders = {"TMPDIR": "tmp", "HOME": "home", "ROBOLINK_LOG_DIR": "logs", "XDG_RUNTIME_DIR": "run"}
        own = {name: str(self.folder / folder) for name, folder in folders.items()}
        return os.environ | own | {MARK: self._mark, "ROS_DOMAIN_ID": str(self.domain), "ROBOLINK_WORKSPACE": ""}

    def _end_all(self, launcher: subprocess.Popen[bytes]) -> None:
        for process in self.processes():
            with contextlib.suppress(psutil.Error):
                process.kill()
        launcher.wait()


KINDS: dict[str, Callable[[Soak, subprocess.Popen[bytes]], None]] = {
    each.__name__: each
    for each in (
        Soak.stop,
        Soak.stop_early,
        Soak.kill_launcher,
        Soak.kill_launcher_as_it_stops,
        Soak.kill_node,
        Soak.kill_guardian,
        Soak.kill_launcher_and_guardian,
        Soak.kill_all,
    )
}
"""The ways in which a round ends, by name."""


def forgotten_memory() -> set[str]:
    """The files of shared memory that no process has mapped; none where the system shows no such files.

    Those of a real ROS 2 do not count: it leaves two for each participant that is killed, thousands in a day.
    """
    if not _SHARED_MEMORY.is_dir():
        return set()
    files = {each.name for each in _SHARED_MEMORY.iterdir() if not each.name.startswith(_OF_FAST_DDS)}
    for path in Path("/proc").glob("[0-9]*/maps"):
        with contextlib.suppress(OSError):
            files -= set(_MAPPED.findall(path.read_text(errors="replace")))
    return {each for each in files if (_SHARED_MEMORY / each).exists()}


def _described(process: psutil.Process) -> str:
    try:
        return f"{process.pid} {process.status()} {' '.join(process.cmdline())[:200]}"
    except psutil.Error:
        return f"{process.pid} gone"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    from rich.progress import track

    chosen = random.Random(arguments.seed)
    kinds: collections.Counter[str] = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="soak") as name, free_domain() as domain:
        soak = Soak(Path(name), domain, arguments.seed)
        for _ in track(range(arguments.rounds), f"seed {arguments.seed}"):
            kind = chosen.choice(list(KINDS))
            kinds[kind] += 1
            soak.round(kind)
        soak.round("stop")
        assert not soak.words(), f"what killed launchers had left was not cleared: {soak.words()}"
        memory = len(forgotten_memory())
    counts = ", ".join(f"{kind} {count}" for kind, count in kinds.items())
    print(f"nothing is left after {arguments.rounds} rounds ({counts}); {memory} files in shared memory")  # noqa: T201


if __name__ == "__main__":
    main()
